"""A time law through given states at given times."""

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.motion.time_law import TimeLaw

N_PIECES = 3
"""Pieces of constant jerk between two states: as many as there are numbers (s, s', s'') to be met."""


def connect_states(durations: Array, states: Array) -> TimeLaw:
    """The time law that meets each state after its duration: three pieces of constant jerk between two.

    The three pieces last equally long, so their jerks follow from one linear system of three equations.

    Args:
        durations: Time between successive states [s], positive, shape (K,).
        states: s, s', s'' at the start, between, and at the end, shape (K + 1, 3).
    """
    step = durations / N_PIECES
    jerks = _jerks(durations, states)
    starts = [states[:-1]]
    for piece in range(N_PIECES - 1):
        starts.append(_advanced(starts[-1], jerks[:, piece], step))
    times = np.concatenate([[0.0], np.cumsum(np.repeat(step, N_PIECES))])
    return TimeLaw(times, np.stack(starts, axis=1).reshape(-1, 3), jerks.ravel())


def _jerks(durations: Array, states: Array) -> Array:
    """The jerk of each piece, shape (K, 3), from what constant acceleration leaves to be made up."""
    missing = states[1:] - _advanced(states[:-1], np.zeros(len(durations)), durations)
    powers = durations[:, None] ** np.array([3, 2, 1])
    d = 1 / N_PIECES
    rest = 1 - d * np.arange(1, N_PIECES + 1)
    effect = np.array([d**3 / 6 + d**2 / 2 * rest + d / 2 * rest**2, d**2 / 2 + d * rest, d + 0 * rest])
    return np.asarray(np.linalg.solve(effect, (missing / powers).T).T)


def _advanced(states: Array, jerks: Array, t: Array) -> Array:
    """The states after time ``t`` of constant jerk."""
    s, v, a = states.T
    return np.column_stack(
        [s + t * (v + t * (a / 2 + t * jerks / 6)), v + t * (a + t * jerks / 2), a + t * jerks]
    )
