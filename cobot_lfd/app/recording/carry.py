"""The part of a recording that is the carry: standing still before and after it tells nothing."""

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array

_MOVED = 0.004  # [m] from where the carry began, or will end, that counts as moving


def trimmed_carry(carrying: NDArray[np.bool_], positions: Array) -> NDArray[np.bool_]:
    """The longest run of samples that carry, without the standing at its two ends.

    Args:
        carrying: Whether each sample carries, shape (M,).
        positions: Where the tool was [m], shape (M, 3).

    Returns:
        Whether each sample is part of the carry, shape (M,); nothing where the tool did not move.
    """
    kept = np.zeros_like(carrying)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], carrying, [False]]).astype(int)))
    if not len(edges):
        return kept
    starts, ends = edges[::2], edges[1::2]
    lengths = [_length(positions[start:end]) for start, end in zip(starts, ends, strict=True)]
    start, end = (int(edge[int(np.argmax(lengths))]) for edge in (starts, ends))
    path = positions[start:end, :2]
    left = np.flatnonzero(np.linalg.norm(path - path[0], axis=1) > _MOVED)
    arriving = np.flatnonzero(np.linalg.norm(path - path[-1], axis=1) > _MOVED)
    if len(left) and len(arriving):
        kept[start + max(int(left[0]) - 1, 0) : start + min(int(arriving[-1]) + 2, len(path))] = True
    return kept


def _length(path: Array) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
