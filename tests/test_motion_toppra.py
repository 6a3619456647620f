"""The near-optimal timing against TOPP-RA: a second implementation, and a bound."""

import pytest

from cobot_lfd.motion import JointLimits, time_path
from tests.motion_examples import DATA_SHEET, TIGHT, random_path
from tools.benchmark_timing import topp_ra_duration


@pytest.mark.parametrize(("limits", "most"), [(DATA_SHEET, 1.03), (TIGHT, 1.15)], ids=["data sheet", "tight"])
@pytest.mark.parametrize("seed", [10, 11])
def test_the_near_optimal_timing_comes_close_to_topp_ra(seed: int, limits: JointLimits, most: float) -> None:
    """TOPP-RA knows no jerk limits and is therefore faster, but for the error of its grid."""
    path = random_path(seed)
    ratio = time_path(path, limits, method="near_optimal").duration / topp_ra_duration(path, limits)
    assert 0.998 < ratio < most


def test_with_hardly_any_jerk_limit_both_take_the_same_time() -> None:
    path, limits = random_path(12), DATA_SHEET.scaled(jerk=100.0)
    duration = time_path(path, limits, method="near_optimal").duration
    assert duration == pytest.approx(topp_ra_duration(path, limits), rel=5e-3)
