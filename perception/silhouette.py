"""Where the outline of an object lands in the picture: its top, its foot and the walls between."""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame

_SPACING = 1.0  # Least distance of the contour's points [px].
_MOST_POINTS = 600  # On all edges, seen and not seen; more cost time and tell little.
_CORNER = 2.5  # Length left out at either end of an edge [px]: near a corner the other edge disturbs.
_ASIDE = 0.01  # Distance from an edge at which either side of it is judged [px].


@dataclass(frozen=True, slots=True, eq=False)
class Contour:
    """Points on the border of an object's image.

    Attributes:
        points: The points on the object, in the world [m], shape (n, 3).
        pixels: Where they land in the picture [px], shape (n, 2).
        normals: Unit vectors in the picture that point away from the object, shape (n, 2).
        edges: Number of the straight edge that each point lies on, shape (n,).
    """

    points: Array
    pixels: Array
    normals: Array
    edges: NDArray[np.int_]

    def __getitem__(self, chosen: NDArray[np.bool_]) -> "Contour":
        """Only the chosen points."""
        return Contour(self.points[chosen], self.pixels[chosen], self.normals[chosen], self.edges[chosen])


def corners_in_world(model: ObjectModel, frame: Frame) -> Array:
    """The corners of the outline and, below them, of the foot [m], shape (2 n, 3)."""
    flat = frame.apply(model.outline)
    heights = np.concatenate([np.full(len(flat), model.z), model.base_z])
    return np.column_stack([np.vstack([flat, flat]), heights])


def silhouette_hull(model: ObjectModel, frame: Frame, camera: Camera) -> Array:
    """Corners of the convex hull of an object's image [px], shape (n, 2)."""
    corners = camera.project(corners_in_world(model, frame)).astype(np.float32)
    return np.asarray(cv2.convexHull(corners)[:, 0], dtype=np.float64)


def visible_contour(model: ObjectModel, frame: Frame, camera: Camera, spacing: float = _SPACING) -> Contour:
    """Points on the border of an object's image, ``spacing`` pixels apart or more, the corners left out.

    Every edge of the prism between outline and foot is sampled; the points that have the object's image on
    one side only are on its border.
    """
    corners = corners_in_world(model, frame)
    seen = camera.project(corners)
    starts, ends = _edges(len(model.outline))
    edges, shares = _places(np.linalg.norm(seen[ends] - seen[starts], axis=1), spacing)
    starts, ends, shares = starts[edges], ends[edges], shares[:, None]
    directions = seen[ends] - seen[starts]
    normals = np.column_stack([directions[:, 1], -directions[:, 0]])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    chord = seen[starts] + shares * directions  # A lens bends the edge; what is inside is judged without.
    sides = np.concatenate([chord + _ASIDE * normals, chord - _ASIDE * normals])
    left, right = _covers(sides, seen).reshape(2, -1)
    points = corners[starts] + shares * (corners[ends] - corners[starts])
    outwards = np.where(left[:, None], -normals, normals)
    return Contour(points, camera.project(points), outwards, edges)[left != right]


@lru_cache(maxsize=64)
def _edges(n: int) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    """Indices of the ends of a prism's edges: around the top, around the foot, from top to foot."""
    around, after = np.arange(n), np.roll(np.arange(n), -1)
    return np.concatenate([around, n + around, around]), np.concatenate([after, n + after, n + around])


def _places(lengths: Array, spacing: float) -> tuple[NDArray[np.int_], Array]:
    """Points on edges of given lengths [px]: their edge's number and their share of its length, (n,) each."""
    spacing = max(spacing, lengths.sum() / _MOST_POINTS)
    counts = np.maximum((lengths - 2 * _CORNER) / spacing, 0.0).astype(int)
    edges = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(edges)) - np.repeat(np.cumsum(counts) - counts, counts)
    return edges, 0.5 + (place - 0.5 * (counts[edges] - 1)) * spacing / lengths[edges]


def _covers(pixels: Array, corners: Array) -> NDArray[np.bool_]:
    """Whether a prism's image, its corners [px] of shape (2 m, 2), covers places in the picture, shape (n,).

    A place is covered by a polygon if the line from it to the right crosses the polygon's edges an odd number
    of times. The polygons are the top, the foot and the walls.
    """
    n = len(corners) // 2
    starts, ends = _edges(n)
    (x0, y0), (x1, y1) = corners[starts].T, corners[ends].T
    x, y = pixels.T[..., None]
    slope = (x1 - x0) / np.where(y1 == y0, 1.0, y1 - y0)
    crosses = ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * slope)
    n_crossed = crosses.astype(np.float32) @ _polygons(n)
    return np.asarray((n_crossed % 2 == 1).any(axis=1))


@lru_cache(maxsize=64)
def _polygons(n: int) -> NDArray[np.float32]:
    """Which of a prism's edges belong to its top, its foot and each of its walls, shape (3 n, 2 + n)."""
    edge, walls = np.arange(n), np.eye(n, dtype=np.float32)
    ends = np.zeros((3 * n, 2), np.float32)
    ends[edge, 0] = ends[n + edge, 1] = 1.0
    return np.column_stack([ends, np.vstack([walls, walls, walls + np.roll(walls, 1, axis=0)])])
