"""Which frames the task needs: those it visits, and the fewest more that predict left-out demonstrations."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.special import stdtrit

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course.course import VISITED, held_out_errors, task_size
from cobot_lfd.learning.data import TaskData

EXHAUSTIVE = 4
"""Up to so many frames, all their sets are tried; beyond, all pairs, and the best sets are made larger."""

N_GROWN = 3
"""So many of the best sets of each size are made larger by each further frame."""

CONFIDENCE = 0.975
"""A set is worse than the best if a paired t-test says so at this level (one-sided), shared out among the
frames that are not visited (Bonferroni), since each of them may help by chance ..."""

MARGIN = 0.05
"""... and if its errors are larger by more than this part; what helps less is not worth a frame."""


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """How left-out demonstrations are predicted with a frame and without it.

    Attributes:
        with_it: Mean distance of each demonstration from what the others predict, with the frame [m], (N,).
        without: The same without it [m], (N,).
        gain: Mean of the logarithms of their ratios; 0.1 stands for errors that are 10 % larger without.
        standard_error: Of that mean.
    """

    with_it: Array
    without: Array
    gain: float
    standard_error: float

    @property
    def n_helped(self) -> int:
        """How many demonstrations are predicted better with the frame."""
        return int((self.with_it < self.without).sum())


@dataclass(frozen=True, slots=True, eq=False)
class Selection:
    """The chosen frames, and how all sets that were tried predict left-out demonstrations.

    Attributes:
        frames: Numbers of the chosen frames, in their order.
        visited: Numbers of the frames that every demonstration passes closely.
        errors: For each set that was tried the mean distance of each demonstration from what the others
            predict [m], shape (N,).
        floor: Added to errors before their logarithm is taken [m]; differences below it hardly count.
    """

    frames: tuple[int, ...]
    visited: frozenset[int]
    errors: Mapping[tuple[int, ...], Array]
    floor: float

    def compare(self, frame: int) -> Comparison | None:
        """What a frame adds to the other chosen ones; None for the only chosen one."""
        others = tuple(j for j in self.frames if j != frame)
        if not others:
            return None
        with_it, without = self.errors[tuple(sorted((*others, frame)))], self.errors[others]
        gain = np.log(without + self.floor) - np.log(with_it + self.floor)
        return Comparison(with_it, without, float(gain.mean()), float(gain.std(ddof=1) / np.sqrt(len(gain))))


def select_frames(data: TaskData, oriented: Sequence[bool]) -> list[int]:
    """The frames to keep, in their order; all where there are too few frames or demonstrations to tell."""
    if len(data.names) < 3 or len(data.paths) < 3:
        return list(range(len(data.names)))
    return list(compare_frames(data, oriented).frames)


def compare_frames(data: TaskData, oriented: Sequence[bool]) -> Selection:
    """The smallest set of frames whose held-out error is about as good as the best.

    Args:
        data: At least three demonstrations, with all frames.
        oriented: Which frames are oriented.
    """
    floor = 1e-3 * data.scale
    visited = _visited(data)
    errors: dict[tuple[int, ...], Array] = {}

    def try_sets(sets: Iterable[tuple[int, ...]]) -> None:
        for group in sets:
            if group not in errors:
                errors[group] = held_out_errors(data.take(group), [oriented[j] for j in group])

    def score(group: tuple[int, ...]) -> float:
        return float(np.log(errors[group] + floor).mean())

    n_frames = len(data.names)
    n_all = n_frames if n_frames <= EXHAUSTIVE else 2
    try_sets(g for size in range(1, n_all + 1) for g in _sets(n_frames, size) if visited <= set(g))
    try_sets([tuple(sorted(visited))] if visited else [])
    for size in range(max(n_all, len(visited)), n_frames):
        best = sorted((group for group in errors if len(group) == size), key=score)[:N_GROWN]
        if best and score(best[0]) > min(map(score, errors)):
            break  # The last frame did not help; neither will another.
        try_sets(tuple(sorted((*group, j))) for group in best for j in range(n_frames) if j not in group)
    logs = {group: np.log(error + floor) for group, error in errors.items()}
    best_logs = logs[min(errors, key=score)]
    confidence = 1.0 - (1.0 - CONFIDENCE) / max(n_frames - len(visited), 1)
    good = [
        (len(group), score(group), group) for group in errors if _as_good(logs[group], best_logs, confidence)
    ]
    chosen = min(good)[2]
    others = (tuple(j for j in chosen if j != out) for out in chosen if len(chosen) > 1)
    try_sets([*others, *(tuple(sorted((*chosen, j))) for j in range(n_frames) if j not in chosen)])
    return Selection(chosen, frozenset(visited), errors, floor)


def _sets(n_frames: int, size: int) -> Iterable[tuple[int, ...]]:
    return combinations(range(n_frames), size)


def _visited(data: TaskData) -> set[int]:
    """The frames that every demonstration passes closely: they matter, whatever else."""
    nearest = np.linalg.norm(data.local, axis=-1).min(axis=-1).max(axis=0)
    return {int(j) for j in np.flatnonzero(nearest < VISITED * task_size(data))}


def _as_good(candidate: Array, best: Array, confidence: float) -> bool:
    """Whether a paired t-test finds no difference, or one that does not matter."""
    difference = candidate - best
    n = len(difference)
    chance = stdtrit(n - 1, confidence) * difference.std(ddof=1) / np.sqrt(n)
    return bool(difference.mean() <= max(chance, np.log1p(MARGIN)))
