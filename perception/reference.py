"""Learns what an object's face looks like from one picture of it."""

import cv2
import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.appearance import Appearance
from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.camera import Camera
from cobot_lfd.frame import Frame
from perception.picture import Picture, check_picture
from perception.rigid import on_plane

_SMALLEST = 8.0  # Least extent of a region [px] that tells anything.
_MARGIN = 2  # Of the map around the region [px].


def learn_appearance(
    name: str,
    picture: Picture,
    camera: Camera,
    z: float,
    region: ArrayLike,
    *,
    frame: Frame | None = None,
) -> Appearance:
    """What a face looks like that lies flat in a region of a picture.

    Args:
        name: Name of the object.
        picture: Red, green, blue, uint8, shape (height, width, 3).
        camera: The camera that took it.
        z: Height of the face in the world [m].
        region: Corners of the part of the picture that shows the face [px], column and row, shape (n, 2).
        frame: Where the object's frame was when the picture was taken; by default it is put in the middle of
            the region, its axes along the world's.

    Raises:
        ValueError: If the picture is not one of this camera, or the region is too small, or not all in it.
    """
    check_picture(picture, camera)
    corners = frozen_array(region, "region", (None, 2))
    _check_region(corners, camera)
    seen = camera.to_plane(corners, z)
    if frame is None:
        frame = Frame(0.5 * (seen.min(axis=0) + seen.max(axis=0)), 0.0)
    outline = frame.localise(seen)
    step = _metres_per_pixel(camera, corners.mean(axis=0), z)
    low, high = outline.min(axis=0) - _MARGIN * step, outline.max(axis=0) + _MARGIN * step
    columns, rows = np.ceil((high - low) / step).astype(int) + 1
    origin = np.array([-low[0], high[1]]) / step
    grid = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1) - origin
    places = camera.project(on_plane(frame.apply(grid * [step, -step]), z)).astype(np.float32)
    image = cv2.remap(
        picture, places[..., 0], places[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
    )
    return Appearance(name, np.asarray(image, np.uint8), outline, step, z, origin)


def _check_region(corners: Array, camera: Camera) -> None:
    extent = np.ptp(corners, axis=0) if len(corners) else np.zeros(2)
    if len(corners) < 3 or extent.min() < _SMALLEST:
        raise ValueError(
            f"the region has {len(corners)} corners and extends over {extent[0]:.0f} x {extent[1]:.0f} px; "
            f"it needs 3 corners or more, and {_SMALLEST:.0f} px in either direction."
        )
    if (corners < -0.5).any() or (corners > np.array([camera.width, camera.height]) - 0.5).any():
        raise ValueError(
            f"the region reaches beyond the picture of {camera.width} x {camera.height} px; choose a part of "
            "the picture that shows all of the object."
        )


def _metres_per_pixel(camera: Camera, pixel: Array, z: float) -> float:
    """How far apart neighbouring pixels lie on a plane, the geometric mean of both directions [m/px]."""
    here, right, below = camera.to_plane(pixel + np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), z)
    (a, b), (c, d) = right - here, below - here
    return float(np.sqrt(abs(a * d - b * c)))
