"""Which frames the task needs: the fewest that predict left-out demonstrations as well as any."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course import held_out_errors
from cobot_lfd.learning.data import TaskData

EXHAUSTIVE = 4
"""Up to so many frames, all their sets are tried; beyond, one frame at a time is dropped."""

STANDARD_ERRORS = 2.0
"""A set is as good as the best if the paired difference is within so many standard errors: a frame that
matters makes a difference of many, one that does not seldom of two."""


def select_frames(data: TaskData, oriented: Sequence[bool]) -> list[int]:
    """The smallest set of frames whose held-out error is about as good as the best.

    Args:
        data: The demonstrations, with all frames.
        oriented: Which frames are oriented.

    Returns:
        The frames to keep, in their order.
    """
    n_frames = len(data.names)
    if n_frames < 3 or len(data.paths) < 3:
        return list(range(n_frames))
    errors: dict[tuple[int, ...], Array] = {}

    def error_of(frames: tuple[int, ...]) -> Array:
        if frames not in errors:
            errors[frames] = np.log(
                held_out_errors(data.take(frames), [oriented[j] for j in frames]) + 1e-3 * data.scale
            )
        return errors[frames]

    if n_frames <= EXHAUSTIVE:
        for size in range(1, n_frames + 1):
            for tried in combinations(range(n_frames), size):
                error_of(tried)
    else:
        kept = tuple(range(n_frames))
        while len(kept) > 1:
            error_of(kept)
            fewer: list[tuple[int, ...]] = list(combinations(kept, len(kept) - 1))
            kept = min(fewer, key=lambda group: error_of(group).mean())
    mean = {group: float(error.mean()) for group, error in errors.items()}
    best = min(mean, key=mean.__getitem__)
    good = [(len(group), mean[group], group) for group in errors if _as_good(errors[group], errors[best])]
    return list(min(good)[2])


def _as_good(candidate: Array, best: Array) -> bool:
    """Whether the paired difference is within the allowed standard errors."""
    difference = candidate - best
    return bool(difference.mean() <= STANDARD_ERRORS * difference.std(ddof=1) / np.sqrt(len(difference)))
