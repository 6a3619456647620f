"""Which way a ring looks: the point of a ring Gaussian that stands for it (paper, section 4.5)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import Scenes

SHORTEST = 1e-9
"""Below this length [m] a direction is undefined, and the last defined one is kept."""


def nearest_directions(scenes: Scenes, means: Array, oriented: Sequence[bool], ring: int) -> Array:
    """Towards the nearest of the other frames, chosen at each time (paper, Table 1).

    An oriented frame stands where its Gaussian's mean is at that time, an orientation-less one at its origin.

    Args:
        scenes: S scenes.
        means: The frames' means in the world [m], shape (S, J, d, T).
        oriented: Which frames are oriented.
        ring: The orientation-less frame whose direction is wanted.

    Returns:
        Unit vectors, shape (S, d, T).
    """
    others = [j for j in range(len(oriented)) if j != ring]
    if not others:
        return own_directions(scenes, ring, means.shape[-1])
    here = scenes.positions[:, ring, :, None]
    origins = np.broadcast_to(scenes.positions[..., None], means.shape)
    offsets = np.stack([(means[:, j] if oriented[j] else origins[:, j]) - here for j in others])
    nearest = np.argmin((offsets**2).sum(axis=2), axis=0)
    chosen = np.take_along_axis(offsets, nearest[None, :, None], axis=0)[0]
    return unit_carried_on(chosen, own_directions(scenes, ring, means.shape[-1]))


def sequence_directions(
    scenes: Scenes, landmarks: Array, order: Sequence[int], switch: NDArray[np.bool_], ring: int
) -> Array:
    """Towards the frame visited before until the path's closest approach, towards the next one afterwards.

    Args:
        scenes: S scenes.
        landmarks: Where each frame stands in the world [m], shape (S, J, d).
        order: The frames in the order in which the path comes closest to them.
        switch: For each step whether the closest approach to the ring is past, shape (T,).
        ring: The orientation-less frame whose direction is wanted.

    Returns:
        Unit vectors, shape (S, d, T).
    """
    place = list(order).index(ring)
    before = order[place - 1] if place > 0 else None
    after = order[place + 1] if place + 1 < len(order) else None
    if before is None and after is None:
        return own_directions(scenes, ring, len(switch))
    here = scenes.positions[:, ring, :, None]
    first = landmarks[:, before if before is not None else after, :, None] - here
    then = landmarks[:, after if after is not None else before, :, None] - here
    chosen = np.where(switch, then, first)
    return unit_carried_on(chosen, own_directions(scenes, ring, len(switch)))


def own_directions(scenes: Scenes, ring: int, n_steps: int) -> Array:
    """The frame's own x axis: what is left where there is no other frame to look at, shape (S, d, T)."""
    axis = scenes.rotations[:, ring, :, :1]
    return np.repeat(axis, n_steps, axis=2)


def unit_carried_on(vectors: Array, fallback: Array) -> Array:
    """Unit vectors along the last axis but one; where one has no length, the last that had (else the next).

    Args:
        vectors: Shape (S, d, T).
        fallback: What to take where none has a length, shape (S, d, T).
    """
    length = np.sqrt((vectors**2).sum(axis=1))
    valid = length > SHORTEST
    units = vectors / np.where(valid, length, 1.0)[:, None]
    if valid.all():
        return np.asarray(units)
    steps = np.arange(valid.shape[1])
    last = np.maximum.accumulate(np.where(valid, steps, -1), axis=1)
    first = np.argmax(valid, axis=1)[:, None]
    source = np.where(last >= 0, last, first)
    carried = np.take_along_axis(units, source[:, None], axis=2)
    return np.where(valid.any(axis=1)[:, None, None], carried, fallback)
