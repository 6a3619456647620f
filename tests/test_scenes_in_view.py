"""What is said not to be in a picture is not in it, nor is its shadow."""

import numpy as np
import pytest

from robots import Arm, Kinematics, has_urdf, load_robot, robot_names
from scenes import World, could_be_seen, load_scene
from scenes.rendering import Picture

pytestmark = pytest.mark.simulator

SCENE = load_scene("pick_and_place")
ROBOTS = [n for n in robot_names() if has_urdf(load_robot(n).urdf, load_robot(n).package)]
NO_SHADOW = SCENE.light.model_copy(update={"shadow": False})


def picture(robot: str, *, visible: bool, posture: str = "parked") -> Picture:
    described = load_robot(robot)
    with World(SCENE, seed=3) as world:
        arm = Arm(world.client, described, visible=visible)
        arm.body.place(np.array(getattr(described, posture)))
        return world.take_picture()


@pytest.mark.parametrize("name", ROBOTS)
def test_a_parked_arm_is_not_in_the_picture(name: str) -> None:
    robot = load_robot(name)
    with Kinematics(robot) as kinematics:
        assert not could_be_seen(kinematics.boxes(np.array(robot.parked)), SCENE.camera, SCENE.light)
    assert np.array_equal(picture(name, visible=True), picture(name, visible=False))


def test_an_arm_at_work_is_in_the_picture() -> None:
    robot = load_robot("panda")
    with Kinematics(robot) as kinematics:
        assert could_be_seen(kinematics.boxes(np.array(robot.home)), SCENE.camera, SCENE.light)
    assert not np.array_equal(
        picture("panda", visible=True, posture="home"), picture("panda", visible=False, posture="home")
    )


def test_a_box_whose_shadow_alone_falls_into_the_picture_could_be_seen() -> None:
    """The lamp stands at the right in the picture, so shadows fall to the left."""
    beside = np.array([[[0.4, -0.6, 0.5], [0.5, -0.5, 0.6]]])
    assert could_be_seen(beside, SCENE.camera, SCENE.light)
    assert not could_be_seen(beside, SCENE.camera, NO_SHADOW)


@pytest.mark.parametrize("x", np.linspace(-1.0, 2.0, 13))
def test_a_box_is_seen_where_its_middle_lands_in_the_picture(x: float) -> None:
    camera = SCENE.camera.camera
    middle = np.array([x, 0.0, 0.1])
    u, v = camera.project(middle)
    inside = 0 <= u < camera.width and 0 <= v < camera.height
    box = np.array([[middle - 0.01, middle + 0.01]])
    assert could_be_seen(box, SCENE.camera, NO_SHADOW) == inside
