"""The near-optimal timing: warp a base law by a few linear programs, then stretch it exactly.

A first program, without jerk limits, finds the pace; each later one starts at the result of the one before
and gains on it (sequential convex programming). Breaks are spread evenly over the time of the current law, and
doubled where the law exceeds a limit between the points at which the programs keep it.
"""

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.motion.limits import JointLimits
from cobot_lfd.motion.path import JointPath
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.time_law_fit import N_PIECES
from cobot_lfd.motion.timing_breaks import graded_breaks, refined, with_steps
from cobot_lfd.motion.timing_program import fastest_warp
from cobot_lfd.motion.timing_ruckig import rest_to_rest
from cobot_lfd.motion.timing_simple import simple_law
from cobot_lfd.motion.timing_stretch import local_stretch, stretch_factor
from cobot_lfd.motion.timing_warp import Warp

N_BREAKS = 120
"""Even break intervals: more bring the law closer to the optimum and take longer to compute."""

MOST_BREAKS = 400
"""Where refining ends, to bound the time of computation."""

N_PROGRAMS = 6
"""Linear programs with jerk limits. The first three or four bring nearly all of the gain."""

TOLERATED = 1.002
"""Stretch of a moment that is not worth another break."""

N_SAMPLES = 5000
"""Samples along a law to compare it by; the one that is taken is stretched exactly afterwards."""

N_INSIDE = 13
"""Samples within a break interval to see whether the law exceeds a limit there."""


def near_optimal_law(path: JointPath, limits: JointLimits) -> TimeLaw:
    """The fastest law that a few linear programs find, or the simple one where that is faster."""
    base, onset = _base_law(path, limits)
    warp = _without_jerk_limits(path, limits, base, onset)
    laws = [simple_law(path, limits)]
    breaks = _even_in_time(warp, onset)
    for n_done in range(1, N_PROGRAMS + 1):
        warp = fastest_warp(path, limits, base, breaks, warp.squared_rate, jerk=True, most=3.0)
        laws.append(warp.law())
        if n_done == 1:
            breaks = _even_in_time(warp, onset)
        elif len(breaks) < MOST_BREAKS:
            breaks = refined(breaks, _stretch_between_breaks(path, limits, laws[-1]) > TOLERATED)
    times = [law.duration * stretch_factor(path, law, limits, N_SAMPLES) for law in laws]
    return laws[int(np.argmin(times))]


def _base_law(path: JointPath, limits: JointLimits) -> tuple[TimeLaw, float]:
    """A law that sets off and stops as the limits allow there, and how long its jerk then lasts [s]."""
    ends, along = (np.abs(path(np.linspace(0.0, 1.0, n), 1)) for n in (2, 401))
    ends = np.maximum(ends, 1e-3 * along.max())
    acceleration, jerk = (float((limit / ends).min()) for limit in (limits.acceleration, limits.jerk))
    pace = float((along / limits.velocity).max(axis=1).mean())
    velocity = 1 / max(pace, 2 / np.sqrt(acceleration))
    return rest_to_rest(velocity, acceleration, jerk), acceleration / jerk


def _without_jerk_limits(path: JointPath, limits: JointLimits, base: TimeLaw, onset: float) -> Warp:
    """The fastest warp within velocity and acceleration limits alone: the pace to start from."""
    breaks = with_steps(graded_breaks(base.duration, N_BREAKS, onset / 3), base.times)
    return fastest_warp(path, limits, base, breaks, np.ones_like, jerk=False, most=1e4)


def _even_in_time(warp: Warp, onset: float) -> Array:
    """Breaks that are even in the time of the warped law, with finer ones at its ends."""
    passed = np.concatenate([[0.0], np.cumsum(warp.durations())])
    even = np.interp(graded_breaks(passed[-1], N_BREAKS, onset / 3), passed, warp.breaks)
    return with_steps(even, warp.base.times)


def _stretch_between_breaks(path: JointPath, limits: JointLimits, law: TimeLaw) -> Array:
    """The largest local stretch factor of a law within each of its break intervals, shape (K,)."""
    breaks = law.times[::N_PIECES]
    inside = (breaks[:-1, None] + np.diff(breaks)[:, None] * np.linspace(0.02, 0.98, N_INSIDE)).ravel()
    factors = local_stretch(path, law, limits, inside)
    return np.asarray(factors[: len(inside)].reshape(-1, N_INSIDE).max(axis=1))
