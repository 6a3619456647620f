"""Which frames the task needs: those it visits, and the fewest more that predict left-out demonstrations."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from scipy.stats import t as student

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course.course import VISITED, held_out_errors, task_size
from cobot_lfd.learning.data import TaskData

EXHAUSTIVE = 4
"""Up to so many frames, all their sets are tried; beyond, one frame at a time is dropped."""

CONFIDENCE = 0.975
"""A set is worse than the best if a paired t-test says so at this level (one-sided)."""


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
    visited = _visited(data)
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
                if visited <= set(tried):
                    error_of(tried)
    else:
        kept = tuple(range(n_frames))
        error_of(kept)
        while len(kept) > max(len(visited), 1):
            fewer = [tuple(j for j in kept if j != out) for out in kept if out not in visited]
            kept = min(fewer, key=lambda group: error_of(group).mean())
    mean = {group: float(error.mean()) for group, error in errors.items()}
    best = min(mean, key=mean.__getitem__)
    good = [(len(group), mean[group], group) for group in errors if _as_good(errors[group], errors[best])]
    return list(min(good)[2])


def _visited(data: TaskData) -> set[int]:
    """The frames that every demonstration passes closely: they matter, whatever else."""
    nearest = np.linalg.norm(data.local, axis=-1).min(axis=-1).max(axis=0)
    return {int(j) for j in np.flatnonzero(nearest < VISITED * task_size(data))}


def _as_good(candidate: Array, best: Array) -> bool:
    """Whether a paired t-test finds no difference."""
    difference = candidate - best
    n = len(difference)
    return bool(difference.mean() <= student.ppf(CONFIDENCE, n - 1) * difference.std(ddof=1) / np.sqrt(n))
