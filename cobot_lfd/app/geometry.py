"""Polygons in the plane and in space: points along them, distances from them."""

import numpy as np

from cobot_lfd.arrays import Array


def densify(corners: Array, step: float) -> Array:
    """Points on the polygon through corners [m], shape (M, d), no farther apart than ``step`` [m]."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    places = np.linspace(0.0, lengths[-1], max(2, int(np.ceil(lengths[-1] / step)) + 1))
    return np.column_stack([np.interp(places, lengths, column) for column in corners.T])


def farthest_from(path: Array, points: Array) -> float:
    """Largest distance of points from the polygon through a path [m], shapes (M, 2) and (T, 2)."""
    start, step = path[:-1], np.diff(path, axis=0)
    squared = np.maximum((step**2).sum(axis=1), 1e-18)
    along = ((points[:, None] - start) * step).sum(axis=2) / squared
    nearest = start + np.clip(along, 0.0, 1.0)[..., None] * step
    return float(np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1).max())
