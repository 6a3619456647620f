"""Warped time laws, and the breaks between which their rate is a parabola."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.arrays import Array
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.timing_breaks import SHORTEST, graded_breaks, refined, with_steps
from cobot_lfd.motion.timing_program import fastest_warp
from cobot_lfd.motion.timing_ruckig import rest_to_rest
from cobot_lfd.motion.timing_stretch import local_stretch
from cobot_lfd.motion.timing_warp import DEGREE, Warp, full_knots
from tests.motion_examples import TIGHT, random_path


@pytest.fixture(scope="module")
def base() -> TimeLaw:
    """A law from rest to rest in about two seconds."""
    return rest_to_rest(0.8, 2.0, 20.0)


def breaks_of(base: TimeLaw, n: int) -> Array:
    """Even breaks, finer at the ends, with the base law's steps among them."""
    return with_steps(graded_breaks(base.duration, n, 0.01), base.times)


@pytest.mark.parametrize("rate", [1.0, 2.0])
def test_a_warp_of_constant_rate_is_the_base_law_played_at_that_rate(base: TimeLaw, rate: float) -> None:
    breaks = breaks_of(base, 30)
    law = Warp(base, breaks, np.full(len(breaks) + DEGREE - 1, rate**2)).law()
    times = np.linspace(0, law.duration, 400)
    assert law.duration == pytest.approx(base.duration / rate)
    for order in range(3):
        assert_allclose(law(times, order), rate**order * base(rate * times, order), atol=1e-9)


def test_a_warped_law_moves_at_the_rate_that_the_spline_says(base: TimeLaw) -> None:
    breaks = breaks_of(base, 200)
    middles = np.convolve(full_knots(breaks)[1:-1], [0.5, 0.5], mode="valid")
    warp = Warp(base, breaks, 1 + 0.5 * np.sin(3 * middles))
    law, passed = warp.law(), np.concatenate([[0.0], np.cumsum(warp.durations())])
    assert_allclose(law(passed), base(breaks), atol=1e-9)
    assert_allclose(law(passed, 1), base(breaks, 1) * np.sqrt(warp.squared_rate(breaks)), atol=1e-9)
    h = 1e-6  # [s]
    assert_allclose(
        (law(passed[1:-1] + h) - law(passed[1:-1] - h)) / (2 * h), law(passed[1:-1], 1), atol=1e-7
    )


@pytest.mark.parametrize("pace", [0.05, 0.5, 5.0])
def test_what_a_linear_program_finds_keeps_the_limits_whatever_it_is_linearised_at(pace: float) -> None:
    """The tangent lies below the convex bound everywhere, so that no starting point leads beyond a limit."""
    path = random_path(20)
    base = rest_to_rest(0.3, 0.5, 5.0)
    breaks = breaks_of(base, 100)
    warp = fastest_warp(path, TIGHT, base, breaks, lambda tau: np.full(len(tau), pace), jerk=True, most=3.0)
    law = warp.law()
    stretch = local_stretch(path, law, TIGHT, np.linspace(0, law.duration, 1000))[:1000]
    assert stretch.max() < 1.03  # between the points at which the program looks there may be a little more


def test_graded_breaks_are_even_within_and_fine_at_both_ends() -> None:
    breaks = graded_breaks(2.0, 50, 1e-3)
    assert_allclose(breaks[[0, -1]], [0.0, 2.0])
    assert_allclose(breaks + breaks[::-1], 2.0, atol=1e-12)
    assert breaks[1] == pytest.approx(1e-3)
    assert np.diff(breaks).max() == pytest.approx(0.04)


def test_breaks_give_way_to_steps_that_lie_close() -> None:
    steps = np.array([0.0, 0.3000001, 0.52, 1.0])
    breaks = with_steps(np.linspace(0, 1, 11), steps)
    assert np.isin(steps, breaks).all()
    assert np.diff(breaks).min() > 0.075
    assert len(breaks) == 11


def test_refining_halves_the_chosen_intervals_but_none_that_is_very_short() -> None:
    breaks = np.array([0.0, SHORTEST / 2, 0.5, 1.0])
    assert_allclose(refined(breaks, np.array([True, False, True])), [0.0, SHORTEST / 2, 0.5, 0.75, 1.0])
