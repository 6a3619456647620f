"""Flat prints in a scene, markers and boards, drawn into its pictures by following each pixel's rays."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import map_coordinates, uniform_filter

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
    picture: NDArray[np.uint8],
    camera: Camera,
    prints: Sequence[Print],
    depth: Array,
    *,
    shift: ArrayLike = (0.0, 0.0),
    width: float = 1.0,
) -> NDArray[np.uint8]:
    """The picture with prints in it, one ray for each pixel.

    Args:
        picture: Red, green, blue, shape (height, width, 3).
        camera: The camera that took it.
        prints: What is drawn.
        depth: How far from the camera, along its axis, what is in the picture is [m], shape (height, width).
        shift: Where in a pixel its ray goes through, measured from the pixel's centre [px], shape (2,).
        width: Side of the square of a print that a ray takes the mean of [px].
    """
    result = picture.copy()
    for each in prints:
        rows, columns = _reach(camera, each)
        part = result[rows, columns]
        if part.size:
            v, u = np.mgrid[rows, columns]
            pixels = np.stack([u, v], axis=-1) + np.asarray(shift)
            image = _smoothed(each, camera, width)
            part[:] = _seen(each, image, camera, pixels, part, depth[rows, columns])
    return result


def _smoothed(each: Print, camera: Camera, width: float) -> Array:
    """A print's image, each dot the mean of what a ray takes in, shape (rows, columns, 3 or 1)."""
    away = np.linalg.norm(each.world_from_print.position - camera.world_from_camera.position)
    n_dots = width * away / camera.matrix[0, 0] * each.image.shape[1] / each.width
    image = each.image.astype(np.float64).reshape(*each.image.shape[:2], -1)
    size = 2 * round((n_dots - 1) / 2) + 1  # odd, so that nothing moves
    return np.asarray(uniform_filter(image, (size, size, 0), mode="nearest")) if size > 1 else image


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


def _seen(
    each: Print, image: Array, camera: Camera, pixels: Array, behind: NDArray[np.uint8], depth: Array
) -> Array:
    """What is seen along rays through places in the picture, shape (h, w, 3)."""
    print_from_camera = each.world_from_print.inverse() @ camera.world_from_camera
    rays = camera.to_rays(pixels)
    ahead = np.concatenate([rays, np.ones((*rays.shape[:-1], 1))], axis=-1) @ print_from_camera.rotation.T
    start = print_from_camera.position
    distance = -start[2] / ahead[..., 2]
    x, y = np.moveaxis(start[:2] + ahead[..., :2] * distance[..., None], -1, 0)
    hit = (np.abs(x) <= each.width / 2) & (np.abs(y) <= each.height / 2) & (start[2] > 0.0) & (distance > 0.0)
    hit &= (distance < depth + _TOUCHING) if each.on is None else (np.abs(distance - depth) < _TOUCHING)
    n_rows, n_columns = image.shape[:2]
    places = [(0.5 - y / each.height) * n_rows - 0.5, (x / each.width + 0.5) * n_columns - 0.5]
    shade = np.stack(
        [map_coordinates(channel, places, order=1, mode="nearest") for channel in np.moveaxis(image, -1, 0)],
        axis=-1,
    )
    if each.on is None:
        ink = 255 * _DARK + shade * (_BRIGHT - _DARK)
    else:
        ink = behind / (255 * np.array(each.on)) * shade
    return np.where(hit[..., None], np.rint(np.clip(ink, 0, 255)), behind)
