"""Connected parts of a picture, and what they are like."""

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array

_MOST_UNLIKE = 0.35  # Of a region's colour from the expected; coloured light makes 0.1, red for orange 0.5.
_SMALLEST = 3  # Fewer averaged pixels are noise; an object has sixty and more.


@dataclass(frozen=True, slots=True, eq=False)
class Region:
    """A connected part of the picture that has an object's colour.

    Attributes:
        hull: Corners of its convex hull [px], shape (n, 2).
        centroid: Middle of its pixels [px], shape (2,).
        area: Number of pixels of the full picture [px].
        colour: Its typical colour, red, green, blue in 0..255, shape (3,).
        at_border: Whether it touches the picture's edge.
        unlikeness: How far its colour is from the expected one; 1 is as far as that is from the table's.
    """

    hull: Array
    centroid: Array
    area: float
    colour: Array
    at_border: bool
    unlikeness: float = 0.0

    @property
    def right_colour(self) -> bool:
        """Whether its colour is the expected one, give or take the light's."""
        return self.unlikeness < _MOST_UNLIKE

    def joined(self, other: "Region") -> "Region":
        """Both as one, with what lies between them."""
        area = self.area + other.area
        corners = np.vstack([self.hull, other.hull]).astype(np.float32)
        return Region(
            hull=np.asarray(cv2.convexHull(corners)[:, 0], np.float64),
            centroid=(self.area * self.centroid + other.area * other.centroid) / area,
            area=area,
            colour=(self.area * self.colour + other.area * other.colour) / area,
            at_border=self.at_border or other.at_border,
            unlikeness=max(self.unlikeness, other.unlikeness),
        )


def connected_regions(mask: NDArray[np.bool_], small: Array, scale: int) -> list[Region]:
    """The connected parts of a mask, in the order in which they are met from above.

    Args:
        mask: What belongs to a region, shape (height, width).
        small: The picture, of which squares of pixels were averaged, shape (height, width, 3).
        scale: Side of those squares [px].
    """
    count, labels, stats, centroids = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    parts = np.asarray(labels)
    return [
        _region(parts, i, stats[i], np.asarray(centroids[i], np.float64), small, scale)
        for i in range(1, count)
        if stats[i, cv2.CC_STAT_AREA] >= _SMALLEST
    ]


def _region(
    labels: NDArray[Any], i: int, stat: NDArray[Any], centroid: Array, small: Array, scale: int
) -> Region:
    x, y, width, height = stat[:4]
    part = labels[y : y + height, x : x + width] == i
    rows, columns = np.nonzero(part)
    hull = cv2.convexHull(np.column_stack([columns + x, rows + y]).astype(np.float32))[:, 0]
    core = cv2.erode(part.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=0) > 0
    colours = small[y : y + height, x : x + width][core if core.any() else part]
    at_border = x == 0 or y == 0 or x + width == labels.shape[1] or y + height == labels.shape[0]
    return Region(
        hull=_full_size(hull, scale),
        centroid=_full_size(centroid, scale),
        area=float(stat[cv2.CC_STAT_AREA]) * scale**2,
        colour=np.median(colours, axis=0),
        at_border=bool(at_border),
    )


def _full_size(pixels: NDArray[Any], scale: int) -> Array:
    """Places in the small picture as places in the full one [px]."""
    return np.asarray((pixels + 0.5) * scale - 0.5, dtype=np.float64)
