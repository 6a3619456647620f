"""Poses that many pairs of alike points agree on."""

from collections.abc import Iterator

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from perception.rigid import rigid_fit

_FEWEST_FOR_AFFINITY = 6  # Pairs; fewer say too little about which of them are wrong.
_MILLIMETRES = 1e3  # OpenCV's estimators expect numbers of the order of pixels.


def vote(
    local: Array, local_directions: Array, world: Array, world_directions: Array, tolerance: float, most: int
) -> Iterator[Frame]:
    """The poses that explain most pairs of a face's point and a picture's point, the best first.

    Each pair says by its places and directions where the face would be; every pose is judged by the number of
    the face's points that it brings to where they were seen. No pair serves two poses, so several faces that
    look the same are found one by one. In the end each pose is fitted to all the pairs that agree with it.

    Args:
        local: Points of the face in its frame [m], shape (n, 2).
        local_directions: Their directions there, unit vectors, shape (n, 2).
        world: The points of the picture that look like them, on the face's plane [m], shape (n, 2).
        world_directions: Their directions there, unit vectors, shape (n, 2).
        tolerance: How far off a point may be [m].
        most: How many poses to return at most.
    """
    x, w = _complex(local), _complex(world)
    turns = _complex(world_directions) * np.conj(_complex(local_directions))
    shifts = w - turns * x
    agree = np.abs(np.outer(turns, x) + (shifts[:, None] - w)) < tolerance
    free = np.ones(len(x), dtype=bool)
    for _ in range(most):
        counts = (agree & free).sum(axis=1) * free
        if not len(counts) or counts.max() < 1:
            break
        best = int(np.argmax(counts))
        chosen = agree[best] & free
        yield (
            _fitted(local[chosen], world[chosen])
            if chosen.sum() > 1
            else Frame(np.array([shifts[best].real, shifts[best].imag]), float(np.angle(turns[best])))
        )
        free &= ~chosen


def _complex(vectors: Array) -> NDArray[np.complex64]:
    """Vectors in the plane as complex numbers, which turns multiply, shape (n,)."""
    return (vectors[:, 0] + 1j * vectors[:, 1]).astype(np.complex64)


def _fitted(local: Array, world: Array) -> Frame:
    """The pose that fits pairs best; where there are enough, those that are wrong are left out (MAGSAC)."""
    inliers: NDArray[np.bool_] = np.ones(len(local), dtype=bool)
    if len(local) >= _FEWEST_FOR_AFFINITY:
        _, found = cv2.estimateAffine2D(
            _MILLIMETRES * local, _MILLIMETRES * world, method=cv2.USAC_MAGSAC, ransacReprojThreshold=1.0
        )
        if found is not None and np.sum(found) >= _FEWEST_FOR_AFFINITY:
            inliers = np.ravel(found) > 0
    return rigid_fit(local[inliers], world[inliers])
