"""The simple timing: one Ruckig call moves s along the whole path.

Limits of the joints become limits on the derivatives of s. With v, a, j the largest s', s'', s''', and joint
by joint and at every place of the path, it is enough that

    |p'| v <= V,   |p''| v^2 + |p'| a <= A,   |p'''| v^3 + 3 |p''| v a + |p'| j <= J.

There are many such v, a, j: a slower pace leaves more of A and J for speeding up. A few are tried, each
stretched to what the path really asks of the joints, and the fastest is taken.
"""

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.motion.limits import JointLimits
from cobot_lfd.motion.path import JointPath
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.timing_ruckig import rest_to_rest
from cobot_lfd.motion.timing_stretch import stretch_factor

SPEED_SHARES = np.linspace(0.1, 1.0, 10)
ACCELERATION_SHARES = (1.0, 0.6, 0.3)
N_SAMPLES = 500
"""Samples along a law to rank it by; the one that is taken is stretched exactly afterwards."""


def simple_law(path: JointPath, limits: JointLimits) -> TimeLaw:
    """The fastest of a few time laws with constant limits on s', s'' and s''', from rest to rest."""
    laws = [rest_to_rest(*candidate) for candidate in _candidates(path, limits)]
    durations = [law.duration * stretch_factor(path, law, limits, N_SAMPLES) for law in laws]
    return laws[int(np.argmin(durations))]


def _candidates(path: JointPath, limits: JointLimits) -> Array:
    """Limits on s', s'' and s''' that keep the joints within theirs, shape (number of candidates, 3)."""
    p1, p2, p3 = (np.abs(path(np.linspace(0.0, 1.0, 2001), order)) for order in (1, 2, 3))
    fastest = min(
        _largest(limits.velocity, p1),
        np.sqrt(_largest(limits.acceleration, p2)),
        np.cbrt(_largest(limits.jerk, p3)),
    )
    candidates = []
    for v in fastest * SPEED_SHARES:
        most = min(
            _largest(limits.acceleration - p2 * v**2, p1),
            _largest(limits.jerk - p3 * v**3, 3 * p2 * v),
        )
        for a in most * np.array(ACCELERATION_SHARES):
            j = _largest(limits.jerk - p3 * v**3 - 3 * p2 * v * a, p1)
            if a > 0 and j > 0:
                candidates.append((v, a, j))
    return np.array(candidates)


def _largest(bound: Array, slope: Array) -> float:
    """The largest x with ``slope * x <= bound`` everywhere."""
    moving = slope > 0
    return float((np.broadcast_to(bound, slope.shape)[moving] / slope[moving]).min(initial=np.inf))
