"""The near-optimal timing: warp a base law by a few linear programs, then stretch it exactly.

A first program, without jerk limits, finds the pace; each later one starts at the result of the one before
and gains on it (sequential convex programming). Breaks are spread evenly over the time of the current law,
and doubled where the law exceeds a limit between the points at which the programs keep it.
"""

from functools import partial

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.motion.limits import JointLimits
from cobot_lfd.motion.path import JointPath
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.time_law_fit import N_PIECES
from cobot_lfd.motion.timing_breaks import graded_breaks, refined, with_steps
from cobot_lfd.motion.timing_program import SquaredRate, fastest_warp
from cobot_lfd.motion.timing_ruckig import rest_to_rest
from cobot_lfd.motion.timing_simple import simple_law
from cobot_lfd.motion.timing_stretch import local_stretch, stretch_factor
from cobot_lfd.motion.timing_warp import Warp

N_BREAKS = 120
"""Even break intervals: more bring the law closer to the optimum and take longer to compute."""

MOST_BREAKS = 400
"""Where refining ends, to bound the time of computation."""

MOST_PROGRAMS = 14
"""Linear programs with jerk limits. Four do for a smooth path; a path that turns on the spot takes more: no
program lets the pace there grow more than threefold."""

LEAST_GAIN = 5e-4
"""Part of the time that a program has to gain for another one to follow."""

TOLERATED = 1.002
"""Stretch of a moment that is not worth another break."""

N_SAMPLES = 5000
"""Samples along a law to compare it by; the one that is taken is stretched exactly afterwards."""

N_INSIDE = 13
"""Samples within a break interval to see whether the law exceeds a limit there."""


def near_optimal_law(path: JointPath, limits: JointLimits) -> TimeLaw:
    """The fastest law that a few linear programs find, or the simple one where that is faster."""
    base = _base_law(path, limits)
    warp = _without_jerk_limits(path, limits, base)
    pace: SquaredRate = partial(_onset_pace, path, limits, warp)
    breaks = _even_in_time(warp)
    laws, times = [], [np.inf]
    for n_done in range(1, MOST_PROGRAMS + 1):
        warp = fastest_warp(path, limits, base, breaks, pace, jerk=True, most=3.0)
        pace = warp.squared_rate
        laws.append(warp.law())
        stretch = _stretch_between_breaks(path, limits, laws[-1])
        times.append(laws[-1].duration * float(stretch.max()))
        crowded = stretch > TOLERATED
        if n_done == 1:
            breaks = _even_in_time(warp)
        elif crowded.any() and len(breaks) < MOST_BREAKS:
            breaks = refined(breaks, crowded)
        elif times[-1] > (1 - LEAST_GAIN) * times[-2]:
            break
    simple = simple_law(path, limits)
    laws.append(simple)
    times.append(simple.duration * stretch_factor(path, simple, limits, N_SAMPLES))
    return laws[int(np.argmin(times[1:]))]


def _base_law(path: JointPath, limits: JointLimits) -> TimeLaw:
    """A law that sets off and stops as fast as the limits allow there, and is about right in between."""
    ends, along = (np.abs(path(np.linspace(0.0, 1.0, n), 1)) for n in (2, 401))
    ends = np.maximum(ends, 1e-3 * along.max())
    acceleration, jerk = (float((limit / ends).min()) for limit in (limits.acceleration, limits.jerk))
    cruise = float((along / limits.velocity).max(axis=1).mean())
    velocity = 1 / max(cruise, 2 / np.sqrt(acceleration), float(np.cbrt(32 / jerk)))
    return rest_to_rest(velocity, acceleration, jerk)


def _without_jerk_limits(path: JointPath, limits: JointLimits, base: TimeLaw) -> Warp:
    """The fastest warp within velocity and acceleration limits alone."""
    breaks = with_steps(graded_breaks(base.duration, N_BREAKS, _finest(base)), base.times)
    return fastest_warp(path, limits, base, breaks, np.ones_like, jerk=False, most=1e4)


def _onset_pace(path: JointPath, limits: JointLimits, warp: Warp, tau: Array) -> Array:
    """The squared rate of a warp, or less where the base law's own jerk would break a limit at that rate.

    The first program with jerk limits starts from it: near its ends, a warp without them is far too fast.
    """
    jerk = path(warp.base(tau), 1) * warp.base(tau, 3)[:, None]
    share = np.abs(jerk / limits.jerk).max(axis=1)
    return np.asarray(np.minimum(warp.squared_rate(tau), np.cbrt(np.maximum(share, 1e-12)) ** -2))


def _even_in_time(warp: Warp) -> Array:
    """Breaks that are even in the time of the warped law, with finer ones at its ends."""
    passed = np.concatenate([[0.0], np.cumsum(warp.durations())])
    even = np.interp(graded_breaks(passed[-1], N_BREAKS, _finest(warp.base)), passed, warp.breaks)
    return with_steps(even, warp.base.times)


def _finest(base: TimeLaw) -> float:
    """Length of the intervals at the ends [s]: three of them while the base law's first jerk lasts."""
    return float(base.times[1]) / 3


def _stretch_between_breaks(path: JointPath, limits: JointLimits, law: TimeLaw) -> Array:
    """The largest local stretch factor of a law within each of its break intervals, shape (K,)."""
    breaks = law.times[::N_PIECES]
    inside = (breaks[:-1, None] + np.diff(breaks)[:, None] * np.linspace(0.02, 0.98, N_INSIDE)).ravel()
    factors = local_stretch(path, law, limits, inside)
    return np.asarray(factors[: len(inside)].reshape(-1, N_INSIDE).max(axis=1))
