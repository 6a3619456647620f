"""Dynamic time warping of demonstrations."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import Scenes, TaskData
from cobot_lfd.learning.warping import BAND, _accumulated, warp, warp_together

TIMES = np.linspace(0, 1, 120)


def curves(powers: list[float]) -> TaskData:
    """One curve, run along with different timing; two frames at rest."""
    clock = np.stack([TIMES**power for power in powers])
    paths = np.stack([clock, 0.4 * np.sin(np.pi * clock)], axis=-1)
    positions = np.tile([[0.0, 0.0], [0.7, 0.1]], (len(powers), 1, 1))
    scenes = Scenes(positions, np.tile(np.eye(2), (len(powers), 2, 1, 1)))
    return TaskData(("a", "b"), TIMES, paths, scenes, 1.0)


def cheapest(cost: Array, i: int, j: int, width: int) -> float:
    """The definition of the accumulated cost, as a recursion."""
    if i < 0 or j < 0 or abs(i - j) > width:
        return float("inf")
    steps = ((i - 1, j), (i, j - 1), (i - 1, j - 1))
    before = 0.0 if i == j == 0 else min(cheapest(cost, *step, width) for step in steps)
    return float(cost[i, j]) + before


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 1000))
def test_the_accumulated_cost_is_that_of_the_cheapest_way(seed: int) -> None:
    """Against the recursion that defines it; the band is two steps wide."""
    cost = np.random.default_rng(seed).uniform(size=(7, 7))
    expected = [[cheapest(cost, i, j, round(BAND * 7)) for j in range(7)] for i in range(7)]
    assert_allclose(_accumulated(cost), expected, atol=1e-12)


def test_a_demonstration_is_not_warped_against_itself() -> None:
    profile = np.log(0.1 + np.random.default_rng(0).uniform(size=(120, 2)))
    assert_allclose(warp(profile, profile), TIMES, atol=0.01)


@settings(max_examples=15, deadline=None)
@given(st.floats(0.6, 1.6), st.floats(0.6, 1.6))
def test_the_same_curve_is_at_the_same_place_at_the_same_time(first: float, second: float) -> None:
    before = curves([1.0, first, second])
    warped = warp_together(before).paths
    apart = np.linalg.norm(warped - warped[:1], axis=-1).mean()
    assert apart < 0.02
    assert_allclose(warped[:, [0, -1]], before.paths[:, [0, -1]], atol=1e-9)


def test_warping_depends_on_no_frames_direction() -> None:
    data = curves([0.7, 1.0, 1.4])
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    turned = TaskData(
        data.names, TIMES, data.paths, Scenes(data.scenes.positions, turn @ data.scenes.rotations), 1.0
    )
    assert_allclose(warp_together(turned).paths, warp_together(data).paths, atol=1e-12)


def test_one_demonstration_is_left_as_it_is() -> None:
    data = curves([1.3])
    assert warp_together(data) is data
