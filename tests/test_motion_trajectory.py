"""Time laws and trajectories: exact at any time, at rest at their ends, joined without a gap."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.motion import JointPath, JointTrajectory, check_limits, move, time_path
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.time_law_fit import connect_states
from cobot_lfd.motion.timing import TimingMethod
from cobot_lfd.motion.trajectory import TimedPath
from tests.motion_examples import DATA_SHEET, limits_for, random_path


@pytest.fixture(scope="module")
def trajectory() -> JointTrajectory:
    """A random path, timed."""
    return time_path(random_path(0), DATA_SHEET)


def test_positions_are_the_path_at_the_laws_parameter(trajectory: JointTrajectory) -> None:
    (section,) = trajectory.sections
    times = np.linspace(0, trajectory.duration, 333)
    assert_allclose(trajectory.sample(times).positions, section.path(section.law(times)), atol=1e-15)
    assert_allclose(trajectory.positions(times), trajectory.sample(times).positions, atol=0)


def test_velocities_and_accelerations_are_derivatives_of_the_positions(trajectory: JointTrajectory) -> None:
    times, h = np.linspace(0.01, trajectory.duration - 0.01, 500), 1e-5
    samples, later, earlier = (trajectory.sample(times + shift) for shift in (0.0, h, -h))
    assert_allclose(samples.velocities, (later.positions - earlier.positions) / (2 * h), atol=1e-5)
    assert_allclose(samples.accelerations, (later.velocities - earlier.velocities) / (2 * h), atol=2e-2)


@pytest.mark.parametrize("method", ["simple", "near_optimal"])
def test_the_motion_starts_and_ends_at_rest(method: TimingMethod) -> None:
    path = random_path(1)
    trajectory = time_path(path, DATA_SHEET, method=method)
    samples = trajectory.sample([-1.0, 0.0, trajectory.duration, trajectory.duration + 1.0])
    assert_allclose(samples.positions, path(np.array([0.0, 0.0, 1.0, 1.0])), atol=1e-10)
    assert_allclose(samples.velocities, 0, atol=1e-9)
    assert_allclose(samples.accelerations, 0, atol=1e-7)


@pytest.mark.parametrize("period", [1 / 240, 1e-3, 0.07])
def test_samples_on_a_control_period_are_even_and_end_at_the_goal(
    trajectory: JointTrajectory, period: float
) -> None:
    samples = trajectory.every(period)
    assert_allclose(np.diff(samples.times), period, rtol=1e-9)
    assert samples.times[0] == 0
    assert trajectory.duration <= samples.times[-1] + 1e-9 < trajectory.duration + period + 1e-8
    assert_allclose(samples.positions[-1], trajectory.goal, atol=1e-10)


def test_stretching_divides_the_derivatives_by_powers_of_the_factor(trajectory: JointTrajectory) -> None:
    law = trajectory.sections[0].law
    slow = law.stretched(2.5)
    times = np.linspace(0, law.duration, 100)
    assert slow.duration == pytest.approx(2.5 * law.duration)
    for order in range(3):
        assert_allclose(slow(2.5 * times, order), law(times, order) / 2.5**order, atol=1e-12)


def test_connected_states_are_met_with_continuous_acceleration() -> None:
    rng = np.random.default_rng(2)
    durations, states = rng.uniform(0.1, 1.0, 5), rng.normal(size=(6, 3))
    law = connect_states(durations, states)
    times = np.concatenate([[0.0], np.cumsum(durations)])
    for order in range(3):
        assert_allclose(law(times, order), states[:, order], atol=1e-10)
        assert_allclose(law(law.times[1:-1] - 1e-9, order), law(law.times[1:-1] + 1e-9, order), atol=1e-5)


def test_trajectories_that_meet_become_one() -> None:
    limits = limits_for(2, 1.0, 5.0, 50.0)
    first, pause = move([0.0, 0.0], [0.5, -0.2], limits), JointTrajectory.hold([0.5, -0.2], 0.5)
    last = move([0.5, -0.2], [1.0, 1.0], limits)
    whole = JointTrajectory.concatenate([first, pause, last])
    assert whole.duration == pytest.approx(first.duration + 0.5 + last.duration)
    times = np.linspace(0, last.duration, 50)
    late = whole.sample(first.duration + 0.5 + times)
    assert_allclose(late.positions, last.sample(times).positions, atol=1e-12)
    assert_allclose(late.velocities, last.sample(times).velocities, atol=1e-12)
    assert_allclose(whole.sample([first.duration + 0.25]).positions, [[0.5, -0.2]], atol=1e-12)
    assert_allclose([whole.start, whole.goal], [[0.0, 0.0], [1.0, 1.0]], atol=1e-12)
    check_limits(whole, limits)


def test_a_gap_between_trajectories_is_told() -> None:
    limits = limits_for(1, 1.0, 5.0, 50.0)
    with pytest.raises(
        ValueError, match=r"ends at \[1\.\] rad and the next starts at \[1\.1\] rad; they must meet"
    ):
        JointTrajectory.concatenate([move([0.0], [1.0], limits), move([1.1], [2.0], limits)])
    with pytest.raises(ValueError, match="sections is empty"):
        JointTrajectory.concatenate([])


def test_a_pause_of_no_duration_is_a_single_sample_at_rest() -> None:
    pause = JointTrajectory.hold([0.3, -0.2], 0.0)
    samples = pause.every(1e-3)
    assert pause.duration == 0
    assert_allclose(samples.positions, [[0.3, -0.2]])
    assert_allclose(samples.velocities, [[0.0, 0.0]])
    check_limits(pause, limits_for(2, 1.0, 1.0, 1.0))


def test_times_that_make_no_sense_are_told() -> None:
    path = JointPath.through([[0.0], [1.0]])
    with pytest.raises(ValueError, match=r"duration is -1.0 s; it must be 0 or positive"):
        JointTrajectory.hold([0.0], -1.0)
    with pytest.raises(ValueError, match=r"period is 0.0 s; it must be positive"):
        JointTrajectory.hold([0.0], 1.0).every(0.0)
    with pytest.raises(ValueError, match="times holds numbers that are not finite"):
        JointTrajectory.hold([0.0], 1.0).sample([np.nan])
    with pytest.raises(ValueError, match=r"the time law ends at s = 0.0; it must end at 1"):
        TimedPath(path, TimeLaw.hold(1.0))
    with pytest.raises(ValueError, match="times must start at 0 and never decrease"):
        TimeLaw(np.array([0.0, -1.0]), np.zeros((1, 3)), np.zeros(1))
