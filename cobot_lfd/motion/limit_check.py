"""The last check before a trajectory is executed: does it keep the limits?

Nothing is clipped. Velocity, acceleration and jerk are taken from the positions alone, by finite differences:
a second way to them that shares no formula with the timing.
"""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.errors import MotionError
from cobot_lfd.motion.limits import JointLimits
from cobot_lfd.motion.trajectory import JointTrajectory

RATE = 4000.0
"""Samples per second: four times the control rate of the fastest arms."""

SLACK = 1e-9
"""How far a position may lie beyond its limit [rad]: waypoints that were clipped to a limit lie on it."""

ROUNDING = 1e-14
"""Error of a position [rad] by 64-bit arithmetic; at 4 kHz a third difference makes it 0.005 rad/s^3. To it
comes the error of the time, by which a moving joint is off."""

UNITS = ("rad/s", "rad/s^2", "rad/s^3")


@dataclass(frozen=True, slots=True)
class LimitRatios:
    """How much of its limits a trajectory uses: the largest over joints and time; 1 is all of it.

    Attributes:
        velocity: Speed over its limit.
        acceleration: Acceleration over its limit.
        jerk: Jerk over its limit.
    """

    velocity: float
    acceleration: float
    jerk: float


def limit_ratios(trajectory: JointTrajectory, limits: JointLimits) -> LimitRatios:
    """How much of the velocity, acceleration and jerk limits the trajectory uses, by differences at 4 kHz."""
    positions = _positions(trajectory, limits)
    used = [
        float((np.abs(_differences(positions, order)) / limit).max())
        for order, limit in enumerate((limits.velocity, limits.acceleration, limits.jerk), start=1)
    ]
    return LimitRatios(*used)


def check_limits(trajectory: JointTrajectory, limits: JointLimits) -> None:
    """Check the trajectory at 4 kHz against position, velocity, acceleration and jerk limits.

    Raises:
        ValueError: If trajectory and limits have different numbers of joints.
        MotionError: If a limit is exceeded; the message names joint, time, value and limit.
    """
    positions = _positions(trajectory, limits)
    check_positions(positions, limits)
    fastest = np.abs(_differences(positions, 1)).max(axis=0)
    rounding = ROUNDING + np.finfo(np.float64).eps * trajectory.duration * fastest
    names = ("velocity", "acceleration", "jerk")
    for order, (name, unit) in enumerate(zip(names, UNITS, strict=True), start=1):
        limit = getattr(limits, name)
        slack = rounding * (2 * RATE) ** order
        values = _differences(positions, order)
        step, joint = np.unravel_index(int(np.argmax((np.abs(values) - slack) / limit)), values.shape)
        if abs(values[step, joint]) > limit[joint] + slack[joint]:
            raise MotionError(
                f"{name} of joint {joint} is {values[step, joint]:.6g} {unit} "
                f"at {max(int(step) - 2, 0) / RATE:.3f} s; its limit is {limit[joint]:.6g} {unit}. "
                "Time the path with these limits."
            )


def check_positions(positions: Array, limits: JointLimits) -> None:
    """Check joint positions [rad], shape (K, n), against their limits.

    Raises:
        MotionError: If one lies outside; the message names joint, value and limits.
    """
    excess = np.maximum(limits.position_lower - positions, positions - limits.position_upper)
    step, joint = np.unravel_index(int(np.argmax(excess)), excess.shape)
    if excess[step, joint] > SLACK:
        raise MotionError(
            f"position of joint {joint} is {positions[step, joint]:.6g} rad; it must lie between "
            f"{limits.position_lower[joint]:.6g} and {limits.position_upper[joint]:.6g} rad. "
            "Choose another branch of the inverse kinematics, or move the path."
        )


def _positions(trajectory: JointTrajectory, limits: JointLimits) -> Array:
    """Positions at 4 kHz, with the rest before the start and after the end that a third difference needs."""
    if trajectory.n_joints != limits.n_joints:
        raise ValueError(
            f"the trajectory moves {trajectory.n_joints} joints and the limits are for {limits.n_joints}; "
            "use the limits of the arm that the path is for."
        )
    n_steps = int(np.ceil(trajectory.duration * RATE))
    return trajectory.positions(np.arange(-3, n_steps + 4) / RATE)


def _differences(positions: Array, order: int) -> Array:
    """Finite-difference derivative of the given order, shape (K - order, n)."""
    return np.diff(positions, n=order, axis=0) * RATE**order
