"""Planning: other choices are tried before a scene is given up, and what cannot be done is refused."""

from collections.abc import Iterator

import numpy as np
import pytest

from cobot_lfd.app.detour import detours
from cobot_lfd.app.plan import Stage, Surroundings, plan_motion
from cobot_lfd.frame import Frame
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from cobot_lfd.tool import ToolTurn
from robots import CollisionError, JointLimitError, Kinematics, load_robot
from scenes import load_scene, object_obstacle, obstacles

pytestmark = pytest.mark.simulator

PANDA, SCENE = load_robot("panda"), load_scene("handover")
PATH = np.column_stack([np.full(60, 0.5), np.linspace(-0.2, 0.15, 60)])
BOARD, HAND = Frame(PATH[0], 0.0), Frame(PATH[-1], np.pi / 2)
STRAIGHT, TURNED = ToolTurn.none(0.0), ToolTurn.none(np.pi / 2)


@pytest.fixture(scope="module")
def kinematics() -> Iterator[Kinematics]:
    with Kinematics(PANDA) as opened:
        yield opened


def around(*more: Obstacle, hand: Frame = HAND) -> Surroundings:
    return Surroundings((*obstacles(SCENE, {"hand": hand}), *more), object_obstacle(SCENE, "board", BOARD))


def heights(kinematics: Kinematics, stages: tuple[Stage, ...]) -> list[float]:
    carry = next(stage for stage in stages if stage.name == "carry")
    joints = carry.trajectory.positions(np.linspace(0.0, carry.trajectory.duration, 9))
    return [float(kinematics.forward(q).position[2]) for q in joints]


def test_an_open_hand_is_entered_at_the_height_of_the_carry(kinematics: Kinematics) -> None:
    stages = plan_motion(kinematics, PANDA, SCENE.task, PATH, [STRAIGHT], around())
    assert [stage.name for stage in stages][:4] == ["approach", "descend", "grasp", "lift"]
    np.testing.assert_allclose(heights(kinematics, stages), SCENE.task.carry_height, atol=1e-3)


def test_a_hand_that_is_closed_towards_the_part_is_entered_from_above(kinematics: Kinematics) -> None:
    closed = Frame(HAND.position, -np.pi / 2)
    stages = plan_motion(kinematics, PANDA, SCENE.task, PATH, [STRAIGHT], around(hand=closed))
    np.testing.assert_allclose(heights(kinematics, stages), SCENE.task.travel_height, atol=1e-3)


def test_a_turn_that_the_wrist_cannot_make_is_left_for_one_that_it_can(kinematics: Kinematics) -> None:
    impossible = ToolTurn.none(-2.4)
    with pytest.raises(JointLimitError, match="joint 7 would be at"):
        plan_motion(kinematics, PANDA, SCENE.task, PATH, [impossible], around())
    assert plan_motion(kinematics, PANDA, SCENE.task, PATH, [impossible, STRAIGHT], around())


def test_a_wall_across_the_way_is_told(kinematics: Kinematics) -> None:
    pose = Pose(np.array([0.5, -0.05, 0.2]), np.eye(3))
    wall = Obstacle("wall", pose, np.zeros((1, 3)), np.array([[0.2, 0.01, 0.2]]))
    with pytest.raises(CollisionError, match="the arm or its part would hit the wall"):
        plan_motion(kinematics, PANDA, SCENE.task, PATH, [STRAIGHT], around(wall))


def test_a_block_on_the_way_is_passed_by_a_detour(kinematics: Kinematics) -> None:
    block = Obstacle(
        "block", Pose(np.array([0.5, -0.03, 0.02]), np.eye(3)), np.zeros((1, 3)), np.full((1, 3), 0.02)
    )
    free = GeneratedPath(PATH, np.tile(1e-4 * np.eye(2), (len(PATH), 1, 1)), np.linspace(0, 1, len(PATH)))
    over = plan_motion(kinematics, PANDA, SCENE.task, PATH, [STRAIGHT], around(block))
    np.testing.assert_allclose(heights(kinematics, over), SCENE.task.travel_height, atol=1e-3)
    beside = plan_motion(
        kinematics, PANDA, SCENE.task, PATH, [STRAIGHT], around(block), detours=detours(free, [block])
    )
    np.testing.assert_allclose(heights(kinematics, beside), SCENE.task.carry_height, atol=1e-3)
