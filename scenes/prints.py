"""Flat prints in a scene, markers and boards, drawn into its pictures by following each pixel's rays."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.pose import Pose
from scenes.colours import Colour

_BRIGHT, _DARK = 0.9, 0.1  # Of paper and ink, where the image is white and black.
_TOUCHING = 0.003  # What is drawn so near to a print is the surface that it is on [m].


@dataclass(frozen=True, slots=True, eq=False)
class Print:
    """A picture on paper, or on an object's face. It hides what is behind it.

    Attributes:
        image: Grey, or red, green, blue, 0..255, shape (rows, columns) or (rows, columns, 3).
        width: Extent from left to right [m].
        height: Extent from top to bottom [m].
        world_from_print: Its pose: origin in its middle, x to the right, y to the top, z towards the viewer.
        on: Colour of the face that it is printed on; light and shadow on the print are those on the face.
            Paper in the air has none; it throws no shadow and catches none.
    """

    image: NDArray[np.uint8]
    width: float
    height: float
    world_from_print: Pose
    on: Colour | None = None


def draw_prints(
    picture: NDArray[np.uint8], camera: Camera, prints: Sequence[Print], samples: int, depth: Array
) -> NDArray[np.uint8]:
    """The picture with prints in it, each pixel the mean of ``samples`` x ``samples`` rays.

    Args:
        picture: Red, green, blue, shape (height, width, 3).
        camera: The camera that took it.
        prints: What is drawn.
        samples: Rays along each side of a pixel.
        depth: How far from the camera, along its axis, what is in the picture is [m], shape (height, width).
    """
    result = picture.copy()
    for each in prints:
        rows, columns = _reach(camera, each)
        part = result[rows, columns]
        if not part.size:
            continue
        v, u = np.mgrid[rows, columns]
        shifts = (np.arange(samples) + 0.5) / samples - 0.5
        pixels = [np.stack([u + x, v + y], axis=-1) for x in shifts for y in shifts]
        seen = [_seen(each, camera, place, part, depth[rows, columns]) for place in pixels]
        part[:] = np.rint(np.clip(np.mean(seen, axis=0), 0, 255))
    return result


def _reach(camera: Camera, each: Print) -> tuple[slice, slice]:
    """Rows and columns of the picture that a print may be seen in."""
    x, y = each.width / 2, each.height / 2
    corners = each.world_from_print.apply([[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0]])
    if (camera.world_from_camera.inverse().apply(corners)[:, 2] <= 0.0).any():
        return slice(0), slice(0)
    size = np.array([camera.width, camera.height])
    pixels = camera.project(corners)
    low = np.clip(np.floor(pixels.min(axis=0)).astype(int) - 1, 0, size)
    high = np.clip(np.ceil(pixels.max(axis=0)).astype(int) + 2, 0, size)
    return slice(low[1], high[1]), slice(low[0], high[0])


def _seen(each: Print, camera: Camera, pixels: Array, behind: NDArray[np.uint8], depth: Array) -> Array:
    """What is seen along rays through places in the picture, shape (h, w, 3)."""
    print_from_camera = each.world_from_print.inverse() @ camera.world_from_camera
    rays = camera.to_rays(pixels)
    ahead = np.concatenate([rays, np.ones((*rays.shape[:-1], 1))], axis=-1) @ print_from_camera.rotation.T
    start = print_from_camera.position
    distance = -start[2] / ahead[..., 2]
    place = start[:2] + ahead[..., :2] * distance[..., None]
    n_rows, n_columns = each.image.shape[:2]
    column = np.floor((place[..., 0] / each.width + 0.5) * n_columns).astype(int)
    row = np.floor((0.5 - place[..., 1] / each.height) * n_rows).astype(int)
    hit = (
        (column >= 0)
        & (column < n_columns)
        & (row >= 0)
        & (row < n_rows)
        & (start[2] > 0.0)
        & (distance > 0.0)
    )
    shade = each.image[np.clip(row, 0, n_rows - 1), np.clip(column, 0, n_columns - 1)]
    if each.on is None:
        hit &= distance < depth + _TOUCHING
        ink = 255 * _DARK + (shade if shade.ndim == 3 else shade[..., None]) * (_BRIGHT - _DARK)
    else:
        hit &= np.abs(distance - depth) < _TOUCHING
        ink = behind / (255 * np.array(each.on)) * (shade if shade.ndim == 3 else shade[..., None])
    return np.where(hit[..., None], ink, behind)
