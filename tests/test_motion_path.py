"""Joint paths: near their waypoints, smooth, and told where the waypoints are unfit."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import BSpline

from cobot_lfd.arrays import Array
from cobot_lfd.motion import JointPath, time_path
from cobot_lfd.motion.splines import spline_matrix
from tests.motion_examples import DATA_SHEET, random_path, random_waypoints

NOISE = 2e-4  # [rad]: the residual of an inverse kinematics that is content with a fifth of a millimetre


def nearest_distance(path: JointPath, point: Array) -> float:
    """Smallest over the path of the largest joint's distance to a point [rad]."""
    s = np.linspace(0, 1, 2001)
    nearest = s[np.abs(path(s) - point).max(axis=1).argmin()]
    return float(np.abs(path(nearest + np.linspace(-5e-4, 5e-4, 2001)) - point).max(axis=1).min())


def test_without_tolerance_the_path_passes_through_every_waypoint() -> None:
    waypoints = random_waypoints(0, n_waypoints=40)
    path = JointPath.through(waypoints, tolerance=0)
    assert max(nearest_distance(path, point) for point in waypoints) < 1e-5  # [rad], the grid's own spacing


@pytest.mark.parametrize("tolerance", [1e-4, 1e-3])
def test_no_waypoint_is_missed_by_more_than_the_tolerance(tolerance: float) -> None:
    waypoints = random_waypoints(1) + np.random.default_rng(1).normal(0, tolerance / 5, (200, 7))
    path = JointPath.through(waypoints, tolerance=tolerance)
    misses = [nearest_distance(path, point) for point in waypoints]
    assert tolerance / 20 < max(misses) <= 1.001 * tolerance


def test_both_ends_are_met_exactly() -> None:
    waypoints = random_waypoints(2) + np.random.default_rng(2).normal(0, NOISE, (200, 7))
    path = JointPath.through(waypoints, tolerance=1e-3)
    assert_allclose(path(np.array([0.0, 1.0])), waypoints[[0, -1]], atol=1e-14)


def test_noise_that_is_smoothed_away_does_not_slow_the_motion() -> None:
    line = np.linspace(0, 1, 200)[:, None] * np.array([1.0, -0.5, 0.3, 0.8, -1.0, 0.4, 0.2])
    noisy = line + np.random.default_rng(3).normal(0, NOISE, line.shape)
    clean = time_path(JointPath.through(line), DATA_SHEET).duration
    assert time_path(JointPath.through(noisy, tolerance=5 * NOISE), DATA_SHEET).duration < 1.02 * clean
    assert time_path(JointPath.through(noisy, tolerance=0), DATA_SHEET).duration > 4 * clean


def test_a_larger_tolerance_gives_a_smoother_path() -> None:
    waypoints = random_waypoints(4) + np.random.default_rng(4).normal(0, NOISE, (200, 7))
    roughness = [
        np.square(JointPath.through(waypoints, tolerance=tolerance)(np.linspace(0, 1, 2001), 3)).mean()
        for tolerance in (0, 3e-4, 1e-3, 1e-2)
    ]
    assert (np.diff(roughness) < 0).all()


@pytest.mark.parametrize("order", [1, 2, 3])
def test_derivatives_agree_with_finite_differences(order: int) -> None:
    path, s, h = random_path(5), np.linspace(0.01, 0.99, 301), 1e-6
    by_differences = (path(s + h, order - 1) - path(s - h, order - 1)) / (2 * h)
    assert_allclose(path(s, order), by_differences, atol=1e-4 * np.abs(by_differences).max())


def test_the_third_derivative_is_continuous() -> None:
    path, h = random_path(6), 1e-9
    knots = np.unique(path.knots)[1:-1]
    steps = path(knots + h, 3) - path(knots - h, 3)
    assert np.abs(steps).max() < 1e-4 * np.ptp(path(knots, 3), axis=0).max()


@pytest.mark.parametrize("n_waypoints", [2, 3, 5, 6, 7, 50])
def test_waypoints_on_a_line_give_a_straight_path_at_even_pace(n_waypoints: int) -> None:
    start, goal = np.array([0.1, -0.4, 1.0]), np.array([0.7, 0.2, 0.9])
    shares = np.linspace(0, 1, n_waypoints)[:, None] ** 1.5
    path = JointPath.through(start + shares * (goal - start))
    s = np.linspace(0, 1, 101)
    assert_allclose(path(s), start + s[:, None] * (goal - start), atol=1e-9)  # [rad]
    assert_allclose(path(s, 1), np.tile(goal - start, (101, 1)), atol=1e-6)


def test_repeated_waypoints_count_once() -> None:
    waypoints = random_waypoints(7, n_waypoints=30)
    stuttering = np.repeat(waypoints, 3, axis=0)
    s = np.linspace(0, 1, 101)
    assert_allclose(JointPath.through(stuttering)(s), JointPath.through(waypoints)(s), atol=1e-12)


@pytest.mark.parametrize("n_waypoints", [1, 2, 100])
def test_a_path_of_identical_waypoints_stays_where_it_is(n_waypoints: int) -> None:
    path = JointPath.through(np.tile([0.3, -0.2], (n_waypoints, 1)))
    assert path.is_constant
    assert_allclose(path(np.array([0.0, 0.5, 1.0])), np.tile([0.3, -0.2], (3, 1)))
    for order in (1, 2, 3):
        assert not path(np.array([0.0, 0.5, 1.0]), order).any()


def test_given_parameters_say_where_on_the_path_each_waypoint_lies() -> None:
    times = np.sort(np.random.default_rng(10).uniform(2.0, 5.0, 30))
    waypoints = np.column_stack([np.sin(times), np.cos(times)])
    path = JointPath.through(waypoints, parameters=times, tolerance=0)
    assert_allclose(path((times - times[0]) / (times[-1] - times[0])), waypoints, atol=1e-12)


def test_a_motion_that_turns_back_by_slowing_down_stays_smooth_if_its_own_time_is_the_parameter() -> None:
    """The joints swing out by a hundredth of a radian and back before they set off."""
    time = np.linspace(0, 1, 200)
    waypoints = ((time - 0.1) ** 2)[:, None] * np.array([1.0, -0.5, 0.8, 0.3, 1.0, 0.2, 0.4])
    by_time = JointPath.through(waypoints, parameters=np.arange(200))
    by_distance = JointPath.through(waypoints)
    durations = [time_path(path, DATA_SHEET).duration for path in (by_time, by_distance)]
    assert durations[0] < 0.2 * durations[1]


def test_the_path_ends_where_its_parameter_does() -> None:
    path = random_path(8)
    assert_allclose(path(np.array([-1.0, 2.0])), path(np.array([0.0, 1.0])), atol=0)


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_spline_matrices_agree_with_scipys_derivatives(order: int) -> None:
    rng = np.random.default_rng(9)
    breaks = np.sort(rng.uniform(0, 1, 8))
    knots = np.concatenate([[breaks[0]] * 3, breaks, [breaks[-1]] * 3])
    coefficients = rng.normal(size=len(knots) - 4)
    at = rng.uniform(breaks[0], breaks[-1], 50)
    expected = BSpline(knots, coefficients, 3)(at, nu=order)
    assert_allclose(spline_matrix(at, knots, 3, order) @ coefficients, expected, rtol=1e-9, atol=1e-9)


def test_unfit_waypoints_are_told() -> None:
    with pytest.raises(ValueError, match="waypoints holds numbers that are not finite"):
        JointPath.through([[0.0, 1.0], [np.nan, 1.0]])
    with pytest.raises(ValueError, match=r"waypoints has shape \(0, 7\); a path needs at least one waypoint"):
        JointPath.through(np.zeros((0, 7)))
    with pytest.raises(ValueError, match=r"waypoints has shape \(3,\)"):
        JointPath.through([0.0, 1.0, 2.0])
    with pytest.raises(ValueError, match=r"parameters\[2\] is 1\.0, after 1\.0; they must strictly increase"):
        JointPath.through([[0.0], [1.0], [2.0]], parameters=[0.0, 1.0, 1.0])
    with pytest.raises(ValueError, match=r"tolerance is -0.1 rad; it must be 0 or positive"):
        JointPath.through([[0.0], [1.0]], tolerance=-0.1)
