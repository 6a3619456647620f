"""Points of a picture that look the same from wherever they are seen: SIFT's, or ORB's, which are faster."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array

FeatureKind = Literal["sift", "orb"]
"""What describes a point: gradients in its surroundings, or comparisons of brightness."""

# How many times a picture is magnified before points are looked for: small objects have only
# details of a few pixels. SIFT magnifies by itself.
_MAGNIFIED: dict[FeatureKind, float] = {"sift": 1.0, "orb": 2.0}
_SIFT: dict[str, Any] = {"contrastThreshold": 0.02, "edgeThreshold": 20.0, "sigma": 1.0}
_ORB: dict[str, Any] = {
    "nfeatures": 2000,
    "scaleFactor": 1.2,
    "nlevels": 6,
    "fastThreshold": 8,
    "edgeThreshold": 16,
}


@dataclass(frozen=True, slots=True, eq=False)
class Keypoints:
    """Points of a picture.

    Attributes:
        places: Column and row [px], shape (n, 2).
        directions: Unit vectors in the picture that turn with it, shape (n, 2).
        descriptors: What they look like, one row each, shape (n, m).
    """

    places: Array
    directions: Array
    descriptors: NDArray[Any]


def find_keypoints(
    grey: NDArray[np.uint8],
    kind: FeatureKind,
    parts: Iterable[tuple[slice, slice]] | None = None,
    closer: float = 1.0,
) -> Keypoints:
    """The points of a grey picture.

    Args:
        grey: The picture.
        kind: What describes the points.
        parts: Rows and columns of parts of it to which to keep; by default all of it.
        closer: How many times larger to see it; more points are found, and that takes longer.
    """
    whole = (slice(0, grey.shape[0]), slice(0, grey.shape[1]))
    found = [_find_in(grey, part, kind, closer) for part in ([whole] if parts is None else parts)]
    some = [each for each in found if len(each.places)]
    if not some:
        return Keypoints(np.empty((0, 2)), np.empty((0, 2)), np.empty((0, 1), np.float32))
    return Keypoints(
        np.vstack([each.places for each in some]),
        np.vstack([each.directions for each in some]),
        np.vstack([each.descriptors for each in some]),
    )


def _find_in(
    grey: NDArray[np.uint8], part: tuple[slice, slice], kind: FeatureKind, closer: float
) -> Keypoints:
    rows, columns = part
    magnified = _MAGNIFIED[kind] * closer
    large = cv2.resize(grey[rows, columns], None, fx=magnified, fy=magnified, interpolation=cv2.INTER_CUBIC)
    finder: Any = cv2.SIFT.create(**_SIFT) if kind == "sift" else cv2.ORB.create(**_ORB)
    points, descriptors = finder.detectAndCompute(large, None)
    places = np.array([point.pt for point in points], dtype=np.float64).reshape(-1, 2)
    angles = np.deg2rad([point.angle for point in points])
    return Keypoints(
        (places + 0.5) / magnified - 0.5 + [columns.start, rows.start],
        np.column_stack([np.cos(angles), np.sin(angles)]),
        descriptors if descriptors is not None else np.empty((0, 1)),
    )


def nearest(
    descriptors: NDArray[Any], among: NDArray[Any], kind: FeatureKind
) -> tuple[NDArray[np.int_], Array]:
    """For each descriptor the nearest among others, and the ratio of its distance to the second's, (n,) each.

    The ratio is far below 1 where only one is like it.
    """
    if not len(descriptors) or len(among) < 2:
        return np.zeros(len(descriptors), dtype=int), np.ones(len(descriptors))
    a, b = (_as_vectors(each, kind) for each in (descriptors, among))
    squares = (a * a).sum(axis=1)[:, None] - 2 * a @ b.T + (b * b).sum(axis=1)
    rows, first = np.arange(len(a)), np.argmin(squares, axis=1)
    nearest_one = squares[rows, first].copy()
    squares[rows, first] = np.inf
    ratios = np.maximum(nearest_one, 0.0) / np.maximum(squares.min(axis=1), 1e-9)
    return first, np.asarray(ratios if kind == "orb" else np.sqrt(ratios), np.float64)


def _as_vectors(descriptors: NDArray[Any], kind: FeatureKind) -> NDArray[np.float32]:
    """Descriptors as vectors; the number of bits in which two differ is their squared distance."""
    numbers = descriptors if kind == "sift" else np.unpackbits(descriptors, axis=1)
    return np.asarray(numbers, np.float32)
