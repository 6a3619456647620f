"""Limits and paths that the tests of motion share."""

import numpy as np
from scipy.interpolate import make_interp_spline

from cobot_lfd.arrays import Array
from cobot_lfd.motion import JointLimits, JointPath

ACCELERATION = np.array([15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0])

DATA_SHEET = JointLimits(
    position_lower=np.full(7, -6.0),
    position_upper=np.full(7, 6.0),
    velocity=np.array([2.175] * 4 + [2.61] * 3),
    acceleration=ACCELERATION,
    jerk=500 * ACCELERATION,
)
"""Velocity, acceleration and jerk of the Panda's data sheet."""

TIGHT = DATA_SHEET.scaled(acceleration=1 / 4, jerk=1 / 200)
"""A quarter of the acceleration, and ten times that as jerk."""


def limits_for(n: int, velocity: float, acceleration: float, jerk: float) -> JointLimits:
    """The same limits for ``n`` joints that may go anywhere within a thousand radians."""
    ones = np.ones(n)
    return JointLimits(-1e3 * ones, 1e3 * ones, velocity * ones, acceleration * ones, jerk * ones)


def random_waypoints(seed: int, n_waypoints: int = 200) -> Array:
    """Dense waypoints on a spline through six random positions of seven joints [rad], shape (M, 7)."""
    via = np.random.default_rng(seed).uniform(-1.0, 1.0, (6, 7))
    return np.asarray(make_interp_spline(np.linspace(0, 1, 6), via, k=3)(np.linspace(0, 1, n_waypoints)))


def random_path(seed: int) -> JointPath:
    """A path through random waypoints."""
    return JointPath.through(random_waypoints(seed))
