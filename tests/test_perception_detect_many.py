"""Objects are told from one another and from what else is there: alike, without a hue, behind an arm."""

from dataclasses import replace

import numpy as np
import pytest

from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.pose import Pose
from perception import detect
from robots import Arm, Kinematics, load_robot
from scenes import SceneDescription, World, load_scene, object_models
from scenes.placement import draw_placements
from tests.perception_examples import CAMERA, MODELS, SCENE, errors, shot

pytestmark = pytest.mark.simulator


def crowded(**others: dict[str, object]) -> SceneDescription:
    """The scene with further boxes, all with more room to stand."""
    values = SCENE.model_dump()
    for name, changes in others.items():
        values["objects"][name] = values["objects"]["cube"] | changes
    return SceneDescription.model_validate(values | {"centre_distance": 0.16})


def test_objects_of_one_colour_are_told_apart_by_their_size() -> None:
    scene = crowded(plate={"size": (0.09, 0.06, 0.02)})
    for seed in range(3):
        with World(scene, seed) as world:
            picture, truth = world.take_picture(), world.true_frames()
        for found in detect(picture, CAMERA, object_models(scene)):
            assert np.linalg.norm(errors(found, truth[found.name])[:2]) < 1e-3


def test_objects_that_look_the_same_are_named_from_left_to_right() -> None:
    scene = crowded(other={})
    for seed in range(3):
        with World(scene, seed) as world:
            picture, truth = world.take_picture(), world.true_frames()
        left, right = sorted((truth["cube"], truth["other"]), key=lambda frame: -frame.position[1])
        cube, _, other = detect(picture, CAMERA, object_models(scene))
        assert np.linalg.norm(errors(cube, left)[:2]) < 1e-3
        assert np.linalg.norm(errors(other, right)[:2]) < 1e-3


def test_one_thing_is_not_two_objects() -> None:
    twin = replace(MODELS[0], name="twin")
    cube, seen = detect(shot(0).picture, CAMERA, [MODELS[0], twin])
    assert isinstance(cube, Detection)
    assert seen == NotSeen("twin", "what looks like it is another object of the same colour.")


def test_distractors_of_another_colour_or_size_change_nothing() -> None:
    scene = crowded(orange={"colour": "orange"}, crate={"size": (0.1, 0.1, 0.03)})
    models = [model for model in object_models(scene) if model.name in ("cube", "container")]
    for seed in range(3):
        with World(scene, seed) as world:
            picture, truth = world.take_picture(), world.true_frames()
        for found in detect(picture, CAMERA, models):
            assert np.linalg.norm(errors(found, truth[found.name])[:2]) < 1e-3


@pytest.mark.parametrize("angle", [0.2, 1.0, 2.1])
def test_what_lies_across_an_object_does_not_hide_it(angle: float) -> None:
    """A strip leaves two parts of each object, which are told to be one."""
    v, u = np.indices((CAMERA.height, CAMERA.width))
    for seed in range(2):
        picture = shot(seed).picture.copy()
        for model, half_width in zip(MODELS, (4.0, 10.0), strict=True):
            x, y = CAMERA.project([*shot(seed).frames[model.name].position, model.z])
            across = (u - x) * np.cos(angle) + (v - y) * np.sin(angle)
            picture[(np.abs(across) < half_width) & (np.hypot(u - x, v - y) < 90)] = (70, 75, 80)
        for found in detect(picture, CAMERA, MODELS):
            assert np.linalg.norm(errors(found, shot(seed).frames[found.name])[:2]) < 0.5e-3


@pytest.mark.parametrize("colours", [("white", "grey"), ("black", "white"), ("grey", "black")])
def test_objects_without_a_hue_are_found(colours: tuple[str, str]) -> None:
    values = SCENE.model_dump()
    for name, colour in zip(("cube", "container"), colours, strict=True):
        values["objects"][name]["colour"] = colour
    scene = SceneDescription.model_validate(values)
    for seed in range(2):
        with World(scene, seed) as world:
            picture, truth = world.take_picture(), world.true_frames()
        for cast in ((1.0, 1.0, 1.0), (1.0, 0.9, 0.8)):
            lit = np.rint(picture * np.array(cast)).astype(np.uint8)
            for found in detect(lit, CAMERA, object_models(scene)):
                assert np.linalg.norm(errors(found, truth[found.name])[:2]) < 1e-3


def test_the_arm_may_reach_across_the_table() -> None:
    """What it hides is found where it is or not at all; what it does not hide is found."""
    robot = load_robot("panda")
    for seed in range(2):
        with World(SCENE, seed) as world, Kinematics(robot) as kinematics:
            arm, truth = Arm(world.client, robot), world.true_frames()
            above = Pose.from_rpy([*truth["cube"].position, 0.12], [np.pi, 0.0, 0.0])
            arm.body.place(kinematics.inverse(above, np.array(robot.home)))
            found = detect(world.take_picture(), CAMERA, MODELS)
        for item in found:
            if isinstance(item, Detection):
                assert np.linalg.norm(errors(item, truth[item.name])[:2]) < 1e-3


@pytest.mark.parametrize(
    ("name", "thing"), [("handover", "hand"), ("brushing", "dustpan"), ("ball_in_hole", "hole")]
)
def test_walls_that_stand_on_a_floor_do_not_draw_their_object_aside(name: str, thing: str) -> None:
    """Read as if they stood on the table, they would displace the hand by 0.4 mm towards its wrist."""
    scene, off = load_scene(name), []
    camera, generator = scene.camera.camera, np.random.default_rng(0)
    models = [model for model in object_models(scene) if model.name == thing]
    with World(scene, 0) as world:
        for _ in range(10):
            frames = draw_placements(scene, generator)
            for each, frame in frames.items():
                world.place(each, frame)
            (found,) = detect(world.take_picture(), camera, models)
            in_world = errors(found, frames[thing])[:2]
            off.append(frames[thing].rotation.T @ in_world)
    assert (np.abs(np.mean(off, axis=0)) < 0.04e-3).all()


def test_the_angle_of_a_ball_is_said_to_be_unknown() -> None:
    scene = load_scene("ball_in_hole")
    with World(scene, 3) as world:
        found = detect(world.take_picture(), scene.camera.camera, object_models(scene))
    (ball,) = (thing for thing in found if thing.name == "ball")
    assert isinstance(ball, Detection)
    assert ball.covariance[2, 2] == pytest.approx(
        np.var(np.linspace(-np.pi, np.pi, 100001) / ball.symmetry), rel=1e-3
    )
    assert (ball.covariance[2, :2] == 0.0).all()


@pytest.mark.parametrize("seed", [1008, 10018])
def test_a_raised_floor_may_hide_the_foot_of_a_wall(seed: int) -> None:
    """The hole stands at the picture's edge, seen so aslant that its floor hides a tenth of its outline."""
    scene = load_scene("ball_in_hole")
    with World(scene, seed) as world:
        found = detect(world.take_picture(), scene.camera.camera, object_models(scene))
        (hole,) = (thing for thing in found if thing.name == "hole")
        off = errors(hole, world.true_frames()["hole"])
    assert np.linalg.norm(off[:2]) < 0.5e-3
    assert abs(off[2]) < np.deg2rad(0.3)
