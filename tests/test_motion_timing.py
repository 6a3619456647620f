"""Timing: within every limit, as fast as closed forms say, and never off the machine."""

import ast
import resource
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import cobot_lfd.motion
from cobot_lfd.arrays import Array
from cobot_lfd.errors import MotionError
from cobot_lfd.motion import (
    JointLimits,
    JointPath,
    JointTrajectory,
    check_limits,
    limit_ratios,
    move,
    time_path,
)
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.timing import METHODS, TimingMethod
from cobot_lfd.motion.timing_stretch import stretch_to_limits
from tests.motion_examples import DATA_SHEET, TIGHT, limits_for, random_path, random_waypoints


def fastest_time(distance: float, velocity: float, acceleration: float, jerk: float) -> float:
    """The least time [s] from rest to rest over a distance with bounded velocity, acceleration and jerk."""
    acceleration = min(acceleration, np.sqrt(velocity * jerk))
    ramp = acceleration / jerk
    if distance >= velocity**2 / acceleration + velocity * ramp:
        return distance / velocity + velocity / acceleration + ramp
    if distance >= 2 * acceleration * ramp**2:
        return float(ramp + np.sqrt(ramp**2 + 4 * distance / acceleration))
    return float(np.cbrt(32 * distance / jerk))


@pytest.mark.parametrize(
    ("distance", "bounds"),
    [
        (3.0, (1.0, 2.0, 10.0)),  # reaches its velocity
        (0.5, (1.0, 2.0, 10.0)),  # reaches its acceleration, not its velocity
        (0.05, (1.0, 2.0, 10.0)),  # reaches neither
        (3.0, (1.0, 50.0, 10.0)),  # reaches its velocity before its acceleration
    ],
)
@pytest.mark.parametrize("method", ["simple", "near_optimal"])
def test_one_joint_takes_the_least_time_that_is_possible(
    distance: float, bounds: tuple[float, float, float], method: TimingMethod
) -> None:
    path = JointPath.through(np.linspace(0, distance, 20)[:, None])
    trajectory = time_path(path, limits_for(1, *bounds), method=method)
    assert trajectory.duration == pytest.approx(fastest_time(distance, *bounds), rel=2e-4)


@pytest.mark.parametrize("limits", [DATA_SHEET, TIGHT], ids=["data sheet", "tight"])
@pytest.mark.parametrize("method", ["simple", "near_optimal"])
@pytest.mark.parametrize("seed", [0, 1])
def test_limits_hold_by_finite_differences_and_one_of_them_is_used_up(
    seed: int, method: TimingMethod, limits: JointLimits
) -> None:
    trajectory = time_path(random_path(seed), limits, method=method)
    check_limits(trajectory, limits)
    ratios = limit_ratios(trajectory, limits)
    assert 0.95 < max(ratios.velocity, ratios.acceleration, ratios.jerk) <= 1.0005


@pytest.mark.parametrize(("method", "tolerance"), [("simple", 1e-6), ("near_optimal", 5e-3)])
def test_the_way_back_is_the_way_there_in_reverse(method: TimingMethod, tolerance: float) -> None:
    waypoints = random_waypoints(2)
    there = time_path(JointPath.through(waypoints, tolerance=0), TIGHT, method=method)
    back = time_path(JointPath.through(waypoints[::-1], tolerance=0), TIGHT, method=method)
    assert back.duration == pytest.approx(there.duration, rel=tolerance)
    shares = np.linspace(0, 1, 200)
    forward = there.positions(shares * there.duration)
    backward = back.positions((1 - shares) * back.duration)
    assert_allclose(backward, forward, atol=10 * tolerance)


@pytest.mark.parametrize("method", ["simple", "near_optimal"])
def test_a_symmetric_path_gets_a_time_symmetric_profile(method: TimingMethod) -> None:
    angle = np.linspace(-1.0, 1.0, 201)
    path = JointPath.through(np.column_stack([np.sin(angle), np.cos(2 * angle)]), tolerance=0)
    trajectory = time_path(path, limits_for(2, 1.5, 4.0, 40.0), method=method)
    shares = np.linspace(0, 1, 101)
    positions = trajectory.positions(shares * trajectory.duration)
    assert_allclose(positions[::-1] * [-1, 1], positions, atol=2e-3)


@pytest.mark.parametrize("method", ["simple", "near_optimal"])
def test_an_arm_that_is_k_times_as_quick_takes_a_kth_of_the_time(method: TimingMethod) -> None:
    path, k = random_path(3), 3.0
    quick = TIGHT.scaled(velocity=k, acceleration=k**2, jerk=k**3)
    slow_time, quick_time = (time_path(path, limits, method=method).duration for limits in (TIGHT, quick))
    assert quick_time == pytest.approx(slow_time / k, rel=1e-3)


@pytest.mark.parametrize("limits", [DATA_SHEET, TIGHT], ids=["data sheet", "tight"])
def test_the_near_optimal_method_is_much_faster_than_the_simple_one(limits: JointLimits) -> None:
    path = random_path(4)
    simple = time_path(path, limits, method="simple").duration
    assert time_path(path, limits, method="near_optimal").duration < 0.7 * simple


def test_the_near_optimal_method_copes_with_a_path_that_turns_on_the_spot() -> None:
    """Out and back again through nearly the same positions: the path's curvature there is enormous."""
    out = np.linspace(0, 1, 60)[:, None] * np.array([1.0, 0.5])
    back = out[::-1] + np.linspace(0, 0.02, 60)[:, None]
    path, limits = JointPath.through(np.vstack([out, back])), limits_for(2, 2.0, 8.0, 400.0)
    trajectory = time_path(path, limits, method="near_optimal")
    check_limits(trajectory, limits)
    assert trajectory.duration < 0.6 * time_path(path, limits).duration


def test_a_move_goes_straight_in_the_time_of_its_slowest_joint() -> None:
    limits = limits_for(3, 1.0, 2.0, 10.0)
    start, goal = np.array([0.0, 1.0, -1.0]), np.array([2.0, 0.5, -0.9])
    trajectory = move(start, goal, limits)
    assert trajectory.duration == pytest.approx(fastest_time(2.0, 1.0, 2.0, 10.0), rel=2e-4)
    positions = trajectory.every(0.01).positions
    shares = (positions[:, 0] - start[0]) / (goal - start)[0]
    assert_allclose(positions, start + shares[:, None] * (goal - start), atol=1e-9)  # [rad]
    assert (np.diff(shares) >= -1e-12).all()


def test_no_joint_could_have_made_a_move_faster_than_it_takes() -> None:
    rng = np.random.default_rng(5)
    for _ in range(10):
        start, goal = rng.uniform(-2, 2, (2, 7))
        least = max(
            fastest_time(*numbers)
            for numbers in zip(
                np.abs(goal - start), TIGHT.velocity, TIGHT.acceleration, TIGHT.jerk, strict=True
            )
        )
        assert least <= move(start, goal, TIGHT).duration < 2 * least


@pytest.mark.parametrize("method", ["simple", "near_optimal"])
def test_a_way_of_no_length_takes_no_time(method: TimingMethod) -> None:
    path = JointPath.through(np.tile(np.full(7, 0.2), (5, 1)))
    trajectory = time_path(path, DATA_SHEET, method=method)
    assert trajectory.duration == 0
    assert_allclose(trajectory.every(1e-3).positions, [np.full(7, 0.2)])
    assert move(path(0.0), path(0.0), DATA_SHEET).duration == 0


def test_a_tiny_way_is_timed_like_any_other() -> None:
    trajectory = move(np.zeros(7), np.full(7, 1e-5), DATA_SHEET)
    assert trajectory.duration == pytest.approx(fastest_time(1e-5, 2.175, 7.5, 3750.0), rel=2e-4)


def test_requests_that_cannot_be_met_are_told() -> None:
    path = random_path(6)
    unknown: Any = "fast"
    with pytest.raises(
        ValueError, match="no timing method named 'fast'; choose one of: simple, near_optimal"
    ):
        time_path(path, DATA_SHEET, method=unknown)
    with pytest.raises(ValueError, match="the path moves 7 joints and the limits are for 2"):
        time_path(path, limits_for(2, 1.0, 1.0, 1.0))
    with pytest.raises(
        MotionError, match=r"position of joint 3 is 6.5 rad; it must lie between -6 and 6 rad"
    ):
        move(np.zeros(7), [0, 0, 0, 6.5, 0, 0, 0], DATA_SHEET)
    with pytest.raises(ValueError, match=r"goal has shape \(6,\); it must have shape \(7\)"):
        move(np.zeros(7), np.zeros(6), DATA_SHEET)
    with pytest.raises(ValueError, match="start holds numbers that are not finite"):
        move(np.full(7, np.inf), np.zeros(7), DATA_SHEET)


@pytest.fixture
def no_socket_can_be_opened() -> Iterator[None]:
    """Not by Python nor by native code: the process may open no file descriptor beyond those it has."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    with socket.socket() as probe:
        next_descriptor = probe.fileno()
    resource.setrlimit(resource.RLIMIT_NOFILE, (next_descriptor, hard))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


@pytest.mark.usefixtures("no_socket_can_be_opened")
def test_timing_works_where_no_socket_can_be_opened() -> None:
    with pytest.raises(OSError, match="Too many open files"):
        socket.socket()
    path = random_path(7)
    for method in METHODS:
        check_limits(time_path(path, DATA_SHEET, method=method), DATA_SHEET)
    check_limits(move(path(0.0), path(1.0), DATA_SHEET), DATA_SHEET)


def test_ruckig_is_never_given_intermediate_positions() -> None:
    """In the community edition they would be posted to a server."""
    folder = Path(cobot_lfd.motion.__file__).parent
    trees = [ast.parse(file.read_text()) for file in folder.glob("*.py")]
    names = {node.attr for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    assert "target_position" in names
    assert not {name for name in names if "intermediate" in name}


def test_two_timings_of_one_path_are_the_same_to_the_last_bit() -> None:
    def samples(method: TimingMethod) -> Array:
        trajectory: JointTrajectory = time_path(random_path(8), TIGHT, method=method)
        return trajectory.every(0.01).positions

    for method in METHODS:
        assert samples(method).tobytes() == samples(method).tobytes()


def test_a_jerk_that_steps_up_between_all_samples_is_stretched_away() -> None:
    """The hardest moment may lie in a piece that is shorter than the time between two samples."""
    limits = limits_for(1, 1.0, 1.0, 1.0)
    starts, jerks = np.array([0.0, 0.50007, 0.50011]), np.array([0.1, 1000.0, 0.0])
    states = [np.zeros(3)]
    for duration, jerk in zip(np.diff(starts), jerks, strict=False):
        s, v, a = states[-1]
        states.append(np.array([s + v * duration, v + a * duration, a + jerk * duration]))
    law = TimeLaw(np.append(starts, 1.0), np.array(states), jerks)
    line = JointPath.through(np.array([[0.0], [1.0]]))
    assert_allclose(stretch_to_limits(line, law, limits).jerks.max(), 1.0, rtol=1e-3)
