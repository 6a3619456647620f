"""Give times to a joint path: as fast as the joints' limits allow, without leaving the path."""

from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.motion.limit_check import check_limits, check_positions
from cobot_lfd.motion.limits import JointLimits
from cobot_lfd.motion.path import JointPath
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.timing_near_optimal import near_optimal_law
from cobot_lfd.motion.timing_simple import simple_law
from cobot_lfd.motion.timing_stretch import stretch_to_limits
from cobot_lfd.motion.trajectory import JointTrajectory, TimedPath

TimingMethod = Literal["simple", "near_optimal"]

METHODS: dict[TimingMethod, Callable[[JointPath, JointLimits], TimeLaw]] = {
    "simple": simple_law,
    "near_optimal": near_optimal_law,
}


def time_path(path: JointPath, limits: JointLimits, *, method: TimingMethod = "simple") -> JointTrajectory:
    """Follow the path from rest to rest, within velocity, acceleration and jerk limits of every joint.

    The arm stays on the path by construction: ``q(t) = p(s(t))``. The result has passed ``check_limits``. A
    path that goes nowhere gives a trajectory of duration 0.

    Args:
        path: Where the joints go.
        limits: What the joints can do.
        method: ``"simple"`` moves s with one trapezoid of acceleration: the hardest place of the path sets
            the pace of all of it. ``"near_optimal"`` solves a few linear programs and comes within a few
            percent of the fastest motion that velocity and acceleration limits alone would allow.

    Raises:
        ValueError: If path and limits have different numbers of joints, or there is no such method.
        MotionError: If the path leaves the position limits.
    """
    if method not in METHODS:
        raise ValueError(f"no timing method named {method!r}; choose one of: {', '.join(METHODS)}.")
    if path.n_joints != limits.n_joints:
        raise ValueError(
            f"the path moves {path.n_joints} joints and the limits are for {limits.n_joints}; "
            "use the limits of the arm that the path is for."
        )
    check_positions(path(np.linspace(0.0, 1.0, 1001)), limits)
    if path.is_constant:
        return JointTrajectory.hold(path(0.0), 0.0)
    law = stretch_to_limits(path, METHODS[method](path, limits), limits)
    trajectory = JointTrajectory((TimedPath(path, law),))
    check_limits(trajectory, limits)
    return trajectory


def move(start: ArrayLike, goal: ArrayLike, limits: JointLimits) -> JointTrajectory:
    """Move all joints from rest to rest along the straight line between two positions.

    The joints move in proportion (Ruckig's phase synchronisation), so the way that is swept, and has to be
    free of collisions, does not depend on the limits. It takes the least time for a straight line; a
    trajectory of duration 0 where start and goal are the same.

    Args:
        start: Joint positions [rad], shape (n,).
        goal: Joint positions [rad], shape (n,).
        limits: What the joints can do.

    Raises:
        ValueError: If the numbers of joints differ or a number is not finite.
        MotionError: If start or goal lies outside the position limits.
    """
    ends: list[Array] = [
        frozen_array(start, "start", (limits.n_joints,)),
        frozen_array(goal, "goal", (limits.n_joints,)),
    ]
    return time_path(JointPath.through(np.array(ends)), limits, method="simple")
