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
from cobot_lfd.motion.timing_stretch import chain_rule, least_stretch

SPEED_SHARES = np.linspace(0.1, 1.0, 10)
ACCELERATION_SHARES = (1.0, 0.6, 0.3)
N_PLACES = 1001
"""Places along the path at which its slope and bends are looked at."""

N_SAMPLES = 500
"""Samples along a law to rank it by; the one that is taken is stretched exactly afterwards."""

STILL = 1e-12
"""A derivative below which a joint counts as still."""


def simple_law(path: JointPath, limits: JointLimits) -> TimeLaw:
    """The fastest of a few time laws with constant limits on s', s'' and s''', from rest to rest."""
    places = np.linspace(0.0, 1.0, N_PLACES)
    bends = np.array([path(places, order) for order in (1, 2, 3)])
    laws = [rest_to_rest(*candidate) for candidate in _candidates(np.abs(bends), limits)]
    return laws[int(np.argmin(_durations(laws, bends, limits)))]


def _durations(laws: list[TimeLaw], bends: Array, limits: JointLimits) -> Array:
    """How long each law takes [s] once it is stretched; nearly, as each moment counts at the next place."""
    states = np.array([law.derivatives(np.linspace(0.0, law.duration, N_SAMPLES)) for law in laws])
    s, *rates = np.moveaxis(states, 1, 0)
    places = np.rint(np.clip(s, 0.0, 1.0) * (N_PLACES - 1)).astype(np.intp)
    derivatives = chain_rule(*(bend[places] for bend in bends), *(rate[..., None] for rate in rates))
    stretch = least_stretch(derivatives, limits).max(axis=1)
    return np.asarray(stretch * [law.duration for law in laws])


def _candidates(bends: Array, limits: JointLimits) -> list[tuple[float, float, float]]:
    """Limits on s', s'' and s''' that keep the joints within theirs.

    Args:
        bends: Sizes of the path's first three derivatives at many places, shape (3, number of places, n).
        limits: What the joints can do.
    """
    _, p2, p3 = bends
    per_p1, per_p2, per_p3 = 1 / np.maximum(bends, STILL)
    fastest = min(
        (limits.velocity * per_p1).min(),
        np.sqrt((limits.acceleration * per_p2).min()),
        np.cbrt((limits.jerk * per_p3).min()),
    )
    candidates = []
    for v in fastest * SPEED_SHARES:
        left = limits.jerk - p3 * v**3
        most = min(((limits.acceleration - p2 * v**2) * per_p1).min(), (left * per_p2).min() / (3 * v))
        for a in most * np.array(ACCELERATION_SHARES):
            j = ((left - 3 * v * a * p2) * per_p1).min()
            if a > 0 and j > 0:
                candidates.append((float(v), float(a), float(j)))
    return candidates
