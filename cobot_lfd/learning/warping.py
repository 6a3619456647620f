"""Dynamic time warping: demonstrations brought to one another's timing by their distances to the frames.

Two moments of different demonstrations belong together where the path is about as far from every frame; that
needs no frame's direction. Logarithms make a centimetre count near a frame and little far from it. All are
warped to the demonstration that the others are most like, and from there to their mean timing.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.distance import cdist

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import TaskData

NEAR = 0.05
"""Distances are told apart down to this part of the task's scale; below, trembling would lead."""
N_STEPS = 200
"""Warps are found on so many steps at most; the work grows with their square."""
BAND = 0.3
"""How far one demonstration may run ahead of another, as a part of the duration."""
SMOOTHING = 0.02
"""A warp is a staircase; it is smoothed by this part of the duration."""


def warp_together(data: TaskData) -> TaskData:
    """The demonstrations with one common timing; where each goes does not change.

    Args:
        data: The demonstrations.
    """
    if len(data.paths) < 2 or len(data.times) < 3:
        return data
    profiles = np.log(np.linalg.norm(data.local, axis=-1) + NEAR * data.scale).swapaxes(1, 2)
    profiles = profiles[
        :, np.linspace(0, len(data.times) - 1, min(len(data.times), N_STEPS)).round().astype(int)
    ]
    reference = profiles[_most_typical(profiles)]
    steps = np.linspace(0, 1, len(reference))
    own_times = np.stack([np.interp(data.times, steps, warp(reference, other)) for other in profiles])
    common = np.interp(data.times, own_times.mean(axis=0), data.times)
    paths = np.stack(
        [
            np.stack(
                [np.interp(np.interp(common, data.times, own), data.times, axis) for axis in path.T], axis=1
            )
            for own, path in zip(own_times, data.paths, strict=True)
        ]
    )
    return TaskData(data.names, data.times, paths, data.scenes, data.duration)


def _most_typical(profiles: Array) -> int:
    """The demonstration from which it is cheapest to all others; profiles of shape (N, T, J)."""
    n = len(profiles)
    costs = np.zeros((n, n))
    for i in range(n):
        for j in range(i):
            total = _accumulated(cdist(profiles[i], profiles[j], "sqeuclidean"))
            costs[i, j] = costs[j, i] = total[-1, -1]
    return int(costs.sum(axis=1).argmin())


def warp(reference: Array, other: Array) -> Array:
    """When the other is where the reference is.

    Args:
        reference: What is compared, over time, shape (T, J).
        other: The same of the other demonstration, shape (T, J).

    Returns:
        Normalised times of the other at each step of the reference, increasing from 0 to 1, shape (T,).
    """
    steps = len(reference)
    matched = _path_back(_accumulated(cdist(reference, other, "sqeuclidean")))
    times = np.array([np.mean(pair) for pair in matched]) / (steps - 1)
    n_beyond = min(steps - 1, round(4 * SMOOTHING * steps) + 1)
    longer = np.pad(times, n_beyond, mode="reflect", reflect_type="odd")
    smooth = gaussian_filter1d(longer, max(SMOOTHING * steps, 1e-3))[n_beyond : n_beyond + steps]
    rising = np.maximum.accumulate(smooth) + 1e-9 * np.arange(steps)
    return np.asarray((rising - rising[0]) / (rising[-1] - rising[0]))


def _accumulated(cost: Array) -> Array:
    """Cost of the cheapest way from (0, 0) to each pair of steps within the band, shape (T, T).

    Pairs of one anti-diagonal depend on the two before only, so each is one vector operation.
    """
    steps = len(cost)
    total = np.full((steps + 1, steps + 1), np.inf)
    total[0, 0] = 0.0
    width = max(1, round(BAND * steps))
    for diagonal in range(2 * steps - 1):
        first = max(0, diagonal - steps + 1, (diagonal - width + 1) // 2)
        last = min(steps - 1, diagonal, (diagonal + width) // 2)
        i = np.arange(first, last + 1)
        j = diagonal - i
        before = np.minimum(np.minimum(total[i, j + 1], total[i + 1, j]), total[i, j])
        total[i + 1, j + 1] = cost[i, j] + before
    return np.asarray(total[1:, 1:])


def _path_back(total: Array) -> list[list[int]]:
    """The cheapest way: for each step of the reference the other's steps that belong to it."""
    steps = len(total)
    i = j = steps - 1
    matched: list[list[int]] = [[] for _ in range(steps)]
    moves: NDArray[np.intp] = np.array([[1, 1], [1, 0], [0, 1]])
    while True:
        matched[i].append(j)
        if i == 0 and j == 0:
            return matched
        costs = [total[i - a, j - b] if i >= a and j >= b else np.inf for a, b in moves]
        a, b = moves[int(np.argmin(costs))]
        i, j = i - int(a), j - int(b)
