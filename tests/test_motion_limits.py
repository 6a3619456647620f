"""Joint limits: checked when made, and enforced on trajectories."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.errors import MotionError
from cobot_lfd.motion import JointLimits, JointTrajectory, check_limits, limit_ratios, move
from cobot_lfd.motion.trajectory import TimedPath
from tests.motion_examples import DATA_SHEET, TIGHT, limits_for


def joint_limits(*numbers: list[float]) -> JointLimits:
    """Limits from lists: lower and upper position, velocity, acceleration, jerk."""
    return JointLimits(*(np.array(limit) for limit in numbers))


def faster(trajectory: JointTrajectory, factor: float) -> JointTrajectory:
    """The same motion in a part of the time."""
    (section,) = trajectory.sections
    return JointTrajectory((TimedPath(section.path, section.law.stretched(1 / factor)),))


def test_scaling_multiplies_each_kind_of_limit_by_its_factor() -> None:
    assert_allclose(TIGHT.velocity, DATA_SHEET.velocity)
    assert_allclose(TIGHT.acceleration, DATA_SHEET.acceleration / 4)
    assert_allclose(TIGHT.jerk, 10 * TIGHT.acceleration)
    assert_allclose(TIGHT.position_upper, DATA_SHEET.position_upper)


def test_limits_that_allow_nothing_are_told() -> None:
    with pytest.raises(ValueError, match=r"position_lower of joint 1 is 2.0 rad; it must be below"):
        joint_limits([0.0, 2.0], [1.0, 2.0], [1.0, 1.0], [1.0, 1.0], [1.0, 1.0])
    with pytest.raises(ValueError, match=r"acceleration of joint 0 is -1.0; it must be positive"):
        joint_limits([0.0], [1.0], [1.0], [-1.0], [1.0])
    with pytest.raises(ValueError, match=r"jerk has shape \(2,\)"):
        joint_limits([0.0], [1.0], [1.0], [1.0], [1.0, 2.0])


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        (
            limits_for(2, 1.0, 1e3, 1e6),
            r"velocity of joint [01] is 1\.0?[91]\d* rad/s at .* its limit is 1 rad/s",
        ),
        (
            limits_for(2, 1e3, 1.0, 1e6),
            r"acceleration of joint [01] is -?1\.2\d* rad/s\^2 at .* limit is 1 rad/s\^2",
        ),
        (
            limits_for(2, 1e3, 1e3, 1.0),
            r"jerk of joint [01] is -?1\.3\d* rad/s\^3 at .* its limit is 1 rad/s\^3",
        ),
    ],
)
def test_a_motion_that_is_a_tenth_too_fast_is_refused(limits: JointLimits, message: str) -> None:
    trajectory = move([0.0, 0.0], [2.0, 2.0], limits)
    check_limits(trajectory, limits)
    with pytest.raises(MotionError, match=message):
        check_limits(faster(trajectory, 1.1), limits)


def test_the_check_finds_a_violation_of_a_thousandth() -> None:
    limits = limits_for(1, 1.0, 5.0, 50.0)
    trajectory = move([0.0], [2.0], limits)
    assert limit_ratios(trajectory, limits).velocity <= 1.0
    with pytest.raises(MotionError, match="of joint 0 is"):
        check_limits(faster(trajectory, 1.001), limits)


def test_ratios_grow_with_the_first_second_and_third_power_of_the_pace() -> None:
    limits = limits_for(1, 1.0, 5.0, 50.0)
    trajectory = move([0.0], [2.0], limits)
    slow, fast = limit_ratios(trajectory, limits), limit_ratios(faster(trajectory, 2.0), limits)
    assert_allclose(fast.velocity, 2 * slow.velocity, rtol=1e-3)
    assert_allclose(fast.acceleration, 4 * slow.acceleration, rtol=1e-3)
    assert_allclose(fast.jerk, 8 * slow.jerk, rtol=1e-3)


def test_a_position_outside_its_limits_is_refused() -> None:
    wide = limits_for(1, 1.0, 1.0, 1.0)
    narrow = joint_limits([-1.0], [1.0], [1.0], [1.0], [1.0])
    trajectory = move([0.0], [1.5], wide)
    with pytest.raises(
        MotionError, match=r"position of joint 0 is 1.5 rad; it must lie between -1 and 1 rad"
    ):
        check_limits(trajectory, narrow)


def test_a_position_on_its_limit_is_allowed() -> None:
    limits = joint_limits([-1.0], [1.0], [1.0], [1.0], [1.0])
    check_limits(move([-1.0], [1.0], limits), limits)


def test_a_trajectory_of_another_arm_is_told() -> None:
    trajectory = JointTrajectory.hold([0.0, 0.0], 1.0)
    with pytest.raises(ValueError, match="the trajectory moves 2 joints and the limits are for 7"):
        check_limits(trajectory, DATA_SHEET)
