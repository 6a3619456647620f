"""Where the outline of an object lands in the picture: its top, its foot and the walls between."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame

_SPACING = 1.0  # Distance of the contour's points [px].
_CORNER = 2.5  # Length left out at either end of an edge [px]: near a corner the other edge disturbs.
_SUBPIXEL_BITS = 4  # OpenCV draws polygons with corners at multiples of 1/16 px.


@dataclass(frozen=True, slots=True, eq=False)
class Contour:
    """Points on the border of an object's image.

    Attributes:
        points: The points on the object, in the world [m], shape (n, 3).
        pixels: Where they land in the picture [px], shape (n, 2).
        normals: Unit vectors in the picture that point away from the object, shape (n, 2).
    """

    points: Array
    pixels: Array
    normals: Array


def corners_in_world(model: ObjectModel, frame: Frame) -> Array:
    """The corners of the outline and, below them, of the foot [m], shape (2 n, 3)."""
    flat = frame.apply(model.outline)
    heights = np.repeat([model.z, model.base_z], len(flat))
    return np.column_stack([np.vstack([flat, flat]), heights])


def silhouette_hull(model: ObjectModel, frame: Frame, camera: Camera) -> Array:
    """Corners of the convex hull of an object's image [px], shape (n, 2)."""
    corners = camera.project(corners_in_world(model, frame)).astype(np.float32)
    return np.asarray(cv2.convexHull(corners)[:, 0], dtype=np.float64)


def visible_contour(model: ObjectModel, frame: Frame, camera: Camera) -> Contour:
    """Points on the border of an object's image, one per pixel, the corners left out.

    Every edge of the prism between outline and foot is sampled; the points that have the object's image on
    one side only are on its border.
    """
    corners = corners_in_world(model, frame)
    starts, ends = _edges(len(model.outline))
    points, directions = _sample_edges(corners[starts], corners[ends], camera)
    if not len(points):
        return Contour(np.zeros((0, 3)), np.zeros((0, 2)), np.zeros((0, 2)))
    pixels = camera.project(points)
    normals = np.column_stack([directions[:, 1], -directions[:, 0]])
    inside = _Mask(model, corners, camera)
    left, right = inside(pixels + 1.5 * normals), inside(pixels - 1.5 * normals)
    border = left != right
    normals = np.where(left[:, None], -normals, normals)
    return Contour(points[border], pixels[border], normals[border])


def _edges(n: int) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    """Indices of the ends of a prism's edges: around the top, around the foot, from top to foot."""
    around, after = np.arange(n), np.roll(np.arange(n), -1)
    return np.concatenate([around, n + around, around]), np.concatenate([after, n + after, n + around])


def _sample_edges(starts: Array, ends: Array, camera: Camera) -> tuple[Array, Array]:
    """Points on edges [m], shape (n, 3), and the edges' directions in the picture there, shape (n, 2)."""
    along = camera.project(ends) - camera.project(starts)
    lengths = np.linalg.norm(along, axis=1)
    points, directions = [], []
    for start, end, step, length in zip(starts, ends, along, lengths, strict=True):
        count = int((length - 2 * _CORNER) / _SPACING)
        if count < 1:
            continue
        shares = 0.5 + (np.arange(count) - 0.5 * (count - 1)) * _SPACING / length
        points.append(start + shares[:, None] * (end - start))
        directions.append(np.tile(step / length, (count, 1)))
    if not points:
        return np.zeros((0, 3)), np.zeros((0, 2))
    return np.vstack(points), np.vstack(directions)


class _Mask:
    """Tells which pixels an object's image covers."""

    def __init__(self, model: ObjectModel, corners: Array, camera: Camera) -> None:
        n = len(model.outline)
        pixels = camera.project(corners)
        self._origin = np.floor(pixels.min(axis=0)).astype(int) - 3
        width, height = np.ceil(pixels.max(axis=0)).astype(int) + 4 - self._origin
        self._mask = np.zeros((height, width), dtype=np.uint8)
        scaled = np.rint((pixels - self._origin) * 2**_SUBPIXEL_BITS).astype(np.int32)
        after = np.roll(np.arange(n), -1)
        walls = [scaled[[i, j, n + j, n + i]] for i, j in enumerate(after)]
        for polygon in [scaled[:n], scaled[n:], *walls]:
            cv2.fillPoly(self._mask, [polygon], color=1, shift=_SUBPIXEL_BITS)

    def __call__(self, pixels: Array) -> NDArray[np.bool_]:
        """Whether each pixel is covered, shape (n,)."""
        columns, rows = (np.rint(pixels).astype(int) - self._origin).T
        height, width = self._mask.shape
        within = (columns >= 0) & (rows >= 0) & (columns < width) & (rows < height)
        covered = self._mask[np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)] > 0
        return np.asarray(within & covered)
