"""Draws markers in pictures, so that detectors can be compared with ArUco at the same poses."""

from collections.abc import Mapping, Sequence

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame
from cobot_lfd.marker import Marker, marker_image
from perception.picture import Picture
from scenes.rendering import sample_pattern

DARK, BRIGHT = 25, 230  # A marker's ink and paper, of 255.


def marker_for(model: ObjectModel, number: int) -> Marker:
    """The marker that fits on an object, with a white margin of a sixth of the ink."""
    return Marker(model.name, number, float(np.ptp(model.outline, axis=0).min()) * 0.75, model.z)


def with_markers(
    picture: Picture, camera: Camera, markers: Sequence[Marker], frames: Mapping[str, Frame], samples: int
) -> Picture:
    """The picture with markers drawn in it, each pixel the mean of as many points as the renderer takes."""
    result = picture.copy()
    for marker in markers:
        cells = np.pad(marker_image(marker.number), 1, constant_values=255)
        centre = camera.project([*frames[marker.name].position, marker.z])
        reach = 0.8 * marker.size * camera.matrix[0, 0] / (camera.world_from_camera.position[2] - marker.z)
        reach += 20.0  # A distorted lens draws a little larger.
        low = np.maximum(np.floor(centre - reach).astype(int), 0)
        high = np.minimum(np.ceil(centre + reach).astype(int), [camera.width, camera.height])
        columns, rows = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
        part = result[low[1] : high[1], low[0] : high[0]]
        colours = [
            _painted(
                part, np.stack([columns, rows], axis=-1) + shift, camera, marker, cells, frames[marker.name]
            )
            for shift in sample_pattern(samples)
        ]
        part[:] = np.rint(np.mean(colours, axis=0))
    return result


def _painted(
    part: Picture, pixels: Array, camera: Camera, marker: Marker, cells: Picture, frame: Frame
) -> Picture:
    """A part of a picture with one marker, sampled at places in the picture, shape (height, width, 2)."""
    local = frame.localise(camera.to_plane(pixels, marker.z)) / (marker.size / 6)
    column, row = np.floor(local[..., 0] + 4).astype(int), np.floor(4 - local[..., 1]).astype(int)
    on_marker = (column >= 0) & (column < 8) & (row >= 0) & (row < 8)
    ink = np.where(cells[np.clip(row, 0, 7), np.clip(column, 0, 7)] > 0, BRIGHT, DARK)
    return np.where(on_marker[..., None], ink[..., None], part).astype(np.uint8)
