"""Stretch a time law, exactly and uniformly, until it uses the limits and no more.

A motion played ``k`` times slower has its velocities divided by ``k``, its accelerations by ``k^2`` and its
jerks by ``k^3``: one number brings all of them within their limits.
"""

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.motion.limits import JointLimits
from cobot_lfd.motion.path import JointPath
from cobot_lfd.motion.time_law import TimeLaw

N_SAMPLES = 20000
"""Samples along a law; between two of them a ratio grows by less than the margin."""

MARGIN = 1e-4
"""Part of the time that is given away so that no limit is exceeded between two samples."""


def stretch_to_limits(path: JointPath, law: TimeLaw, limits: JointLimits) -> TimeLaw:
    """The law stretched (or compressed) so that the largest ratio of a derivative to its limit is 1."""
    return law.stretched((1 + MARGIN) * stretch_factor(path, law, limits, N_SAMPLES))


def stretch_factor(path: JointPath, law: TimeLaw, limits: JointLimits, n_samples: int) -> float:
    """How many times as long the law has to take so that its largest derivative-to-limit ratio is 1."""
    law_states = _states(law, n_samples)
    slopes = [path(law_states[:, 0], order) for order in (1, 2, 3)]
    ratios = [
        (np.abs(value) / limit).max()
        for value, limit in zip(
            joint_derivatives(*slopes, *law_states[:, 1:].T[:, :, None]),
            (limits.velocity, limits.acceleration, limits.jerk),
            strict=True,
        )
    ]
    return float(max(ratios[0], ratios[1] ** (1 / 2), ratios[2] ** (1 / 3)))


def joint_derivatives(
    p1: Array, p2: Array, p3: Array, ds: Array, dds: Array, ddds: Array
) -> tuple[Array, Array, Array]:
    """Velocity, acceleration and jerk of ``p(s(t))``, by the chain rule.

    Args:
        p1: First derivative of the path in s, shape (K, n); p2 and p3: the second and the third.
        p2: See p1.
        p3: See p1.
        ds: First time derivative of s, shape (K, 1); dds and ddds: the second and the third.
        dds: See ds.
        ddds: See ds.
    """
    return p1 * ds, p2 * ds**2 + p1 * dds, p3 * ds**3 + 3 * p2 * ds * dds + p1 * ddds


def _states(law: TimeLaw, n_samples: int) -> Array:
    """The parameter and its three derivatives at even times and on both sides of jerk steps, shape (K, 4)."""
    even = np.linspace(0.0, law.duration, n_samples)
    inside = np.column_stack([law(even, order) for order in range(4)])
    starts = np.column_stack([law.states, law.jerks])
    ends = np.column_stack([*(law(law.times[1:], order) for order in range(3)), law.jerks])
    return np.vstack([inside, starts, ends])
