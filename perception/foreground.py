"""The parts of a picture in which there is something: everything but the even table."""

from collections.abc import Iterable

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array

_SCALE = 4  # Side of the squares of pixels that are averaged first [px].
_LEAST_EDGE = 8.0  # Difference between neighbouring squares that may be more than the table's noise [0..255].
_N_NOISE = 6.0  # The same in standard deviations of that noise.
_MARGIN = 3  # Squares around what was found.
_MOST = 0.6  # Of the picture; beyond, all of it is taken.

Part = tuple[slice, slice]
"""Rows and columns of a part of a picture."""


def foreground_parts(grey: NDArray[np.uint8]) -> list[Part]:
    """Rectangles around what stands out in a grey picture."""
    height, width = grey.shape
    small = cv2.resize(grey, (width // _SCALE, height // _SCALE), interpolation=cv2.INTER_AREA)
    edges = np.asarray(cv2.morphologyEx(small, cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)), np.float64)
    typical = float(np.median(edges))  # Largest less smallest of nine noisy values: about 3 sigma.
    mask = (edges > typical + max(_LEAST_EDGE, _N_NOISE * typical / 3.0)).astype(np.uint8)
    mask = np.asarray(cv2.dilate(mask, np.ones((2 * _MARGIN + 1,) * 2, np.uint8)), np.uint8)
    count, _, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    boxes = [(int(y), int(y + h), int(x), int(x + w)) for x, y, w, h, _ in stats[1:count]]
    if sum((bottom - top) * (right - left) for top, bottom, left, right in boxes) > _MOST * mask.size:
        return [(slice(0, height), slice(0, width))]
    return [
        (slice(top * _SCALE, min(bottom * _SCALE, height)), slice(left * _SCALE, min(right * _SCALE, width)))
        for top, bottom, left, right in boxes
    ]


def without(parts: Iterable[Part], contour: Array) -> list[Part]:
    """The parts but those in which there is room for little else than what lies in a contour [px], (n, 2)."""
    left, top = contour.min(axis=0) - 2 * _SCALE * _MARGIN  # The thing's own margin, its walls and shadow.
    right, bottom = contour.max(axis=0) + 2 * _SCALE * _MARGIN
    return [
        (rows, columns)
        for rows, columns in parts
        if rows.start < top or rows.stop > bottom or columns.start < left or columns.stop > right
    ]
