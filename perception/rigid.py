"""The planar motion that brings points to where they were seen."""

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame


def rigid_fit(local: Array, world: Array) -> Frame:
    """The frame that takes points, shape (n, 2), to where they were seen, by least squares."""
    a, b = local - local.mean(axis=0), world - world.mean(axis=0)
    angle = np.arctan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b))
    turn = Frame(np.zeros(2), float(angle))
    return Frame(world.mean(axis=0) - turn.apply(local.mean(axis=0)), turn.angle)


def on_plane(points: Array, z: float) -> Array:
    """Points on the plane at height ``z`` [m], shape (..., 3), from their x and y, shape (..., 2)."""
    return np.concatenate([points, np.full((*points.shape[:-1], 1), z)], axis=-1)
