"""Where the near-optimal timing puts the breaks of its splines."""

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array

GROWTH = 2.2
"""How much longer each break interval near an end is than the one before it."""

CLOSEST = 0.25
"""A break that lies closer to a step than this part of its interval gives way to the step."""

SHORTEST = 1e-5
"""Part of the whole below which an interval is not cut: a jerk over less time drowns in rounding errors."""


def graded_breaks(duration: float, n: int, finest: float) -> Array:
    """Even breaks from 0 to ``duration``, with finer ones near both ends.

    Setting off and stopping take the time in which the acceleration builds up, a few milliseconds for a stiff
    arm; a jerk that could not step within this time would cost it in full. In between it would not.

    Args:
        duration: The last break.
        n: Number of even intervals.
        finest: Length of the interval at each end.
    """
    even = duration / n
    n_fine = max(int(np.ceil(np.log(even / finest) / np.log(GROWTH))), 0)
    fine = finest * GROWTH ** np.arange(n_fine)
    return np.unique(np.concatenate([np.linspace(0.0, duration, n + 1), fine, duration - fine]))


def with_steps(breaks: Array, steps: Array) -> Array:
    """The breaks joined by ``steps``, less those that nearly coincide with a step.

    Args:
        breaks: Breaks from 0 to the end, increasing.
        steps: Further breaks that have to stay where they are; 0 and the end are among them.
    """
    apart = np.abs(breaks[:, None] - steps).min(axis=1) > CLOSEST * np.gradient(breaks)
    return np.unique(np.concatenate([breaks[apart], steps]))


def refined(breaks: Array, chosen: NDArray[np.bool_]) -> Array:
    """The breaks, with the chosen intervals, shape (K,) of bool, cut in half unless they are very short."""
    middles = (breaks[:-1] + breaks[1:]) / 2
    cut = chosen & (np.diff(breaks) > SHORTEST * breaks[-1])
    return np.sort(np.concatenate([breaks, middles[cut]]))
