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
_LEAST_FILLED = 0.4  # Of a rectangle; a shadow's edge right across the picture fills less.
_SMALLEST_PART = 24  # Longer side from which on such a rectangle is cut in two [squares].

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
    count, labels, _, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    squares = [part for i in range(1, count) for part in _tight(np.asarray(labels) == i)]
    return [
        (slice(top * _SCALE, min(bottom * _SCALE, height)), slice(left * _SCALE, min(right * _SCALE, width)))
        for top, bottom, left, right in squares
    ]


def _tight(mask: NDArray[np.bool_]) -> list[tuple[int, int, int, int]]:
    """Rectangles around what a mask holds, without much else: top, bottom, left and right of each [squares].

    One that holds much else is cut where there is least to cut, in the middle half of its longer side; the
    parts overlap there, so that what is cut is seen from both.
    """
    left, top, width, height = cv2.boundingRect(mask.astype(np.uint8))
    inside = mask[top : top + height, left : left + width]
    if max(height, width) < _SMALLEST_PART or inside.mean() > _LEAST_FILLED:
        return [(top, top + height, left, left + width)]
    axis = int(width > height)
    length = (height, width)[axis]
    middle = np.arange(length // 4, length - length // 4)
    cut = (top, left)[axis] + int(middle[np.argmin(inside.sum(axis=1 - axis)[middle])])
    halves = []
    for kept in (slice(0, cut + _MARGIN), slice(cut - _MARGIN, None)):
        half = np.zeros_like(mask)
        where = (kept, slice(None)) if axis == 0 else (slice(None), kept)
        half[where] = mask[where]
        halves += _tight(half)
    return halves


def without(parts: Iterable[Part], contour: Array) -> list[Part]:
    """The parts but those in which there is room for little else than what lies in a contour [px], (n, 2)."""
    left, top = contour.min(axis=0) - 2 * _SCALE * _MARGIN  # The thing's own margin, its walls and shadow.
    right, bottom = contour.max(axis=0) + 2 * _SCALE * _MARGIN
    return [
        (rows, columns)
        for rows, columns in parts
        if rows.start < top or rows.stop > bottom or columns.start < left or columns.stop > right
    ]
