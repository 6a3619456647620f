"""Stretch a time law, exactly and uniformly, until it uses the limits and no more.

A motion played ``k`` times slower has its velocities divided by ``k``, its accelerations by ``k^2`` and its
jerks by ``k^3``: one number brings all of them within their limits.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.arrays import Array
from cobot_lfd.motion.limits import JointLimits
from cobot_lfd.motion.path import JointPath
from cobot_lfd.motion.time_law import TimeLaw

N_SAMPLES = 3000
"""Samples along a law; between two of them a stretch grows by less than ``GROWTH``."""

GROWTH = 0.05
"""Intervals whose ends come this near to the largest stretch are sampled again."""

N_BETWEEN = 8
"""Further samples in each of them; between two of them a stretch grows by less than the margin."""

N_AT_PEAK = 101
"""Further samples around the one at which the stretch is largest."""

MARGIN = 1e-4
"""Part of the time that is given away so that no limit is exceeded between two samples."""


class JointDerivatives(NamedTuple):
    """Velocity, acceleration and jerk of each joint, each of shape (..., n)."""

    velocity: Array
    acceleration: Array
    jerk: Array


def stretch_to_limits(path: JointPath, law: TimeLaw, limits: JointLimits) -> TimeLaw:
    """The law stretched (or compressed) so that the largest ratio of a derivative to its limit is 1."""
    times = np.linspace(0.0, law.duration, N_SAMPLES)
    coarse = local_stretch(path, law, limits, times)
    near_peak = np.flatnonzero(coarse[:N_SAMPLES] >= (1 - GROWTH) * coarse[:N_SAMPLES].max())
    between = times[near_peak, None] + times[1] * np.linspace(-1.0, 1.0, 2 * N_BETWEEN + 1)
    around = local_stretch(path, law, limits, between.ravel())
    peak = (
        between.flat[int(np.argmax(around[: between.size]))]
        + times[1] * np.linspace(-1.0, 1.0, N_AT_PEAK) / N_BETWEEN
    )
    fine = local_stretch(path, law, limits, peak)
    return law.stretched((1 + MARGIN) * float(max(coarse.max(), around.max(), fine.max())))


def stretch_factor(path: JointPath, law: TimeLaw, limits: JointLimits, n_samples: int) -> float:
    """How many times as long the law has to take so that its largest derivative-to-limit ratio is 1."""
    return float(local_stretch(path, law, limits, np.linspace(0.0, law.duration, n_samples)).max())


def local_stretch(path: JointPath, law: TimeLaw, limits: JointLimits, times: Array) -> Array:
    """How many times as long the law would have to take, were the limits those of one moment only.

    Args:
        path: Where the joints go.
        law: When they are where.
        limits: What the joints can do.
        times: The moments [s], shape (K,).

    Returns:
        The factors at ``times``, then those on both sides of each step of the law's jerk, shape (K + 2 B,).
    """
    s, ds, dds, ddds = _states(law, times)
    return least_stretch(joint_derivatives(path, s, ds, dds, ddds), limits)


def least_stretch(derivatives: JointDerivatives, limits: JointLimits) -> Array:
    """The factors by which a motion has to be slowed down at each moment, shape (...,)."""
    velocity = np.abs(derivatives.velocity / limits.velocity).max(axis=-1)
    acceleration = np.abs(derivatives.acceleration / limits.acceleration).max(axis=-1)
    jerk = np.abs(derivatives.jerk / limits.jerk).max(axis=-1)
    return np.asarray(np.maximum(velocity, np.maximum(np.sqrt(acceleration), np.cbrt(jerk))))


def joint_derivatives(
    path: JointPath, s: Array, ds: ArrayLike, dds: ArrayLike, ddds: ArrayLike
) -> JointDerivatives:
    """Velocity, acceleration and jerk of ``p(s(t))``, by the chain rule.

    Args:
        path: The path p.
        s: The parameter, shape (K,).
        ds: First time derivative of s, shape (K,).
        dds: Second time derivative of s, shape (K,).
        ddds: Third time derivative of s, shape (K,).
    """
    p1, p2, p3 = (path(s, order) for order in (1, 2, 3))
    d1, d2, d3 = (np.asarray(d, dtype=np.float64)[:, None] for d in (ds, dds, ddds))
    return chain_rule(p1, p2, p3, d1, d2, d3)


def chain_rule(p1: Array, p2: Array, p3: Array, d1: Array, d2: Array, d3: Array) -> JointDerivatives:
    """Time derivatives from those of p in s, shape (..., n), and those of s in t, shape (..., 1)."""
    return JointDerivatives(p1 * d1, p2 * d1**2 + p1 * d2, p3 * d1**3 + 3 * p2 * d1 * d2 + p1 * d3)


def _states(law: TimeLaw, times: Array) -> Array:
    """The parameter and its derivatives at ``times``, then on both sides of jerk steps, (4, K + 2 B)."""
    inside = np.array(law.derivatives(times))
    starts = np.vstack([law.states.T, law.jerks])
    ends = np.vstack([law.derivatives(law.times[1:])[:3], law.jerks])
    return np.hstack([inside, starts, ends])
