"""How good a generated path is: the paper's measures (eqs. 18-31), and ones that do not depend on the axes.

Paths are arrays of shape (M, T, d); the paper's smoothness is defined in the plane only.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.frame import FrameKind

SHARP = 0.5
"""Change of slope above which the paper counts a sharp edge (section 5.3)."""
TURN = 0.1
"""Change of heading per step above which a turn is counted [rad]."""


@dataclass(frozen=True, slots=True)
class F1:
    """The identifier's precision, recall and F1 score, orientation-less frames being the positives.

    Attributes:
        precision: Share of the frames called orientation-less that are; nan if none is called so (eq. 19).
        recall: Share of the orientation-less frames that are called so; nan if there is none (eq. 20).
        score: Their harmonic mean; nan where one is nan, 0 where both are 0 (eq. 18). The paper prints "Inf".
    """

    precision: float
    recall: float
    score: float


def identifier_f1(found: Mapping[str, FrameKind], true: Mapping[str, FrameKind]) -> F1:
    """The F1 score of one identification (paper, eqs. 18-20)."""
    less = FrameKind.ORIENTATION_LESS
    called = {name for name, kind in found.items() if kind is less}
    are = {name for name, kind in true.items() if kind is less}
    precision = len(called & are) / len(called) if called else float("nan")
    recall = len(called & are) / len(are) if are else float("nan")
    total = precision + recall
    return F1(precision, recall, 0.0 if total == 0 else 2 * precision * recall / total)


def sharp_edges(paths: Array) -> Array:
    """Number of sharp edges of each planar path, shape (M,) (paper, eqs. 21-23).

    As printed: slopes dy/dx by central differences, and of their central differences those above 0.5; falling
    slopes never count, and the number depends on how the axes lie. A vertical step has an infinite slope; two
    of them in a row change it by nothing.
    """
    x, y = paths[..., 0], paths[..., 1]
    rise, run = y[:, 2:] - y[:, :-2], x[:, 2:] - x[:, :-2]
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.where((rise == 0) & (run == 0), 0.0, rise / run)
        change = (slope[:, 2:] - slope[:, :-2]) / 2
    return np.asarray((np.nan_to_num(change, nan=0.0) > SHARP).sum(axis=1), dtype=np.float64)


def smoothness(paths: Array) -> float:
    """Mean number of sharp edges per path; less is smoother (paper, eq. 24)."""
    return float(sharp_edges(paths).mean())


def shortest_distance(paths: Array) -> Array:
    """Distance from start to end, shape (M,) [m] (paper, eq. 25)."""
    return np.asarray(np.linalg.norm(paths[:, -1] - paths[:, 0], axis=-1))


def path_length(paths: Array) -> Array:
    """Distance covered, shape (M,) [m] (paper, eq. 26)."""
    return np.asarray(np.linalg.norm(np.diff(paths, axis=1), axis=-1).sum(axis=1))


def efficiency(paths: Array) -> float:
    """Mean of shortest over covered distance, at most 1 (paper, eq. 27)."""
    return float((shortest_distance(paths) / path_length(paths)).mean())


def detour(paths: Array) -> float:
    """Mean of covered over shortest distance, at least 1: what the paper's Table 4 holds as efficiency."""
    return float((path_length(paths) / shortest_distance(paths)).mean())


def reachability(paths: Array, starts: Array, ends: Array, tolerance: float = 0.05) -> float:
    """Share of starts and ends that are reached, in percent (paper, eqs. 28-31; 0.5 each as in eq. 30).

    Args:
        paths: Shape (M, T, d) [m].
        starts: Where each path should start, shape (M, d) [m].
        ends: Where each path should end, shape (M, d) [m].
        tolerance: Epsilon [m].
    """
    start_reached = np.linalg.norm(paths[:, 0] - starts, axis=-1) < tolerance
    end_reached = np.linalg.norm(paths[:, -1] - ends, axis=-1) < tolerance
    return float(50 * (start_reached.mean() + end_reached.mean()))


@dataclass(frozen=True, slots=True)
class Distances:
    """Mean distances between paths and truth (paper, Table 5) [m].

    Attributes:
        total: Over all times.
        start: At the first point.
        end: At the last point.
    """

    total: float
    start: float
    end: float


def distances(paths: Array, truth: Array) -> Distances:
    """The distances of the paper's Table 5, paths and truth taken at the same times."""
    apart = np.linalg.norm(paths - truth, axis=-1)
    return Distances(float(apart.mean()), float(apart[:, 0].mean()), float(apart[:, -1].mean()))


def turns(paths: Array) -> float:
    """Mean number of steps at which a path's heading changes by more than ``TURN``, whatever the axes."""
    steps = np.diff(paths, axis=1)
    length = np.linalg.norm(steps, axis=-1)
    moving = (length[:, 1:] > 1e-9) & (length[:, :-1] > 1e-9)
    cosine = (steps[:, 1:] * steps[:, :-1]).sum(axis=-1) / np.where(
        moving, length[:, 1:] * length[:, :-1], 1.0
    )
    return float(((np.arccos(np.clip(cosine, -1, 1)) > TURN) & moving).sum(axis=1).mean())


def log_dimensionless_jerk(paths: Array) -> float:
    """Mean logarithm of the squared jerk integrated over unit time, over the squared length.

    A straight minimum-jerk path has ln 720 = 6.6; less is smoother, and constant speed along a line has none.
    """
    n_steps = paths.shape[1]
    jerk = np.diff(paths, n=3, axis=1) * (n_steps - 1) ** 3
    mean_square = (jerk**2).sum(axis=-1).mean(axis=1)
    return float(np.log(mean_square / path_length(paths) ** 2).mean())


def length_ratio(paths: Array, truth: Array) -> float:
    """Mean length of the paths over that of the truth."""
    return float((path_length(paths) / path_length(truth)).mean())
