"""Collisions of postures: with what stands around, with the arm itself, and of the part that is held."""

import ctypes
import gc
from collections.abc import Iterator
from typing import ClassVar

import numpy as np
import pytest

from cobot_lfd.arrays import Array
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from cobot_lfd.tool import tool_above
from robots import Kinematics, load_robot, thinned
from robots.kinematics import _MOST_CHECKS

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


class MallInfo(ctypes.Structure):
    """What ``mallinfo2`` returns."""

    _fields_: ClassVar = [(f"before_{i}", ctypes.c_size_t) for i in range(7)] + [
        ("in_use", ctypes.c_size_t),
        ("free", ctypes.c_size_t),
        ("at_top", ctypes.c_size_t),
    ]


def in_use() -> int:
    """Memory of this process that is in use [byte]."""
    library = ctypes.CDLL(None)
    if not hasattr(library, "mallinfo2"):
        pytest.skip("the C library does not tell how much memory is in use")
    gc.collect()
    library.mallinfo2.restype = MallInfo
    return int(library.mallinfo2().in_use)


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


def test_checks_do_not_pile_up_in_memory_and_all_say_the_same(kinematics: Kinematics) -> None:
    """PyBullet keeps the shapes of removed bodies; glibc says how much memory is in use."""
    inside = posture(kinematics, 0.1, 0.1)
    used = []
    for _ in range(4):
        for _ in range(_MOST_CHECKS):
            with kinematics.collisions([TABLE, WALL]) as check:
                assert check.first_hit(inside) == "the arm or its part would hit the wall"
        used.append(in_use())
    assert used[3] - used[1] < 0.2 * _MOST_CHECKS * 20e3  # [byte]


def test_a_thinned_path_keeps_its_end() -> None:
    path = np.arange(11.0)[:, None]
    assert thinned(path, 4).ravel().tolist() == [0.0, 4.0, 8.0, 10.0]
