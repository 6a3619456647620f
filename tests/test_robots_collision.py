"""Collisions of postures: with what stands around, with the arm itself, and of the part that is held."""

from collections.abc import Iterator

import numpy as np
import pytest

from cobot_lfd.arrays import Array
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from cobot_lfd.tool import tool_above
from robots import Kinematics, load_robot, thinned

pytestmark = pytest.mark.simulator

PANDA = load_robot("panda")


def block(name: str, centre: list[float], size: list[float]) -> Obstacle:
    return Obstacle(name, Pose(np.array(centre), np.eye(3)), np.zeros((1, 3)), 0.5 * np.array([size]))


TABLE = block("table", [0.4, 0.0, -0.02], [1.4, 1.6, 0.04])
WALL = block("wall", [0.5, 0.1, 0.1], [0.3, 0.01, 0.2])


@pytest.fixture(scope="module")
def kinematics() -> Iterator[Kinematics]:
    with Kinematics(PANDA) as opened:
        yield opened


def posture(kinematics: Kinematics, y: float, height: float) -> Array:
    return kinematics.inverse(tool_above([0.5, y], height, 0.0), np.array(PANDA.home))[None]


def test_an_arm_above_the_table_is_free_and_one_in_the_table_is_not(kinematics: Kinematics) -> None:
    above, below = posture(kinematics, 0.0, 0.1), posture(kinematics, 0.0, -0.02)
    with kinematics.collisions([TABLE]) as check:
        assert check.first_hit(np.array([PANDA.home, PANDA.parked])) is None
        assert check.first_hit(above) is None
        assert check.first_hit(np.vstack([above, below])) == "the arm or its part would hit the table"


def test_an_arm_that_folds_onto_itself_is_told(kinematics: Kinematics) -> None:
    folded = np.array([[0.0, -1.7, 0.0, -3.07, 0.0, -0.01, 0.0]])
    with kinematics.collisions([]) as check:
        assert "hit its link" in str(check.first_hit(folded))


def test_a_held_part_hits_what_the_tool_alone_would_miss(kinematics: Kinematics) -> None:
    beside = posture(kinematics, 0.04, 0.25)
    bar = block("bar", [0.0, 0.0, 0.0], [0.02, 0.2, 0.02])
    with kinematics.collisions([TABLE, WALL]) as check:
        assert check.first_hit(beside) is None
        check.hold(bar, Pose(np.array([0.0, 0.0, 0.07]), np.eye(3)))
        assert check.first_hit(beside) == "the arm or its part would hit the wall"
        check.release()
        assert check.first_hit(beside) is None


def test_a_check_leaves_nothing_behind(kinematics: Kinematics) -> None:
    inside = posture(kinematics, 0.1, 0.1)
    with kinematics.collisions([WALL]) as check:
        assert check.first_hit(inside) is not None
    with kinematics.collisions([]) as check:
        assert check.first_hit(inside) is None


def test_a_thinned_path_keeps_its_end() -> None:
    path = np.arange(11.0)[:, None]
    assert thinned(path, 4).ravel().tolist() == [0.0, 4.0, 8.0, 10.0]
