"""What a real camera does to a picture: its lens bends and blurs it, its sensor adds noise and colour."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter, map_coordinates

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from scenes.view import Lens, Sensor

_MARGIN = 2  # Of the ideal picture around the bent one [px].


def ideal_camera(camera: Camera) -> Camera:
    """A camera without distortion that sees all that the given one sees."""
    if not camera.distortion.any():
        return camera
    corner = np.array([camera.width, camera.height]) - 0.5
    along = np.linspace(0.0, 1.0, 65)[:, None]
    border = [start + along * (end - start) for start, end in _sides(np.array([-0.5, -0.5]), corner)]
    ideal = replace(camera, distortion=np.zeros(5))
    reached = ideal.to_pixels(camera.to_rays(np.vstack(border)))
    low = np.floor(reached.min(axis=0)).astype(int) - _MARGIN
    width, height = np.ceil(reached.max(axis=0)).astype(int) + _MARGIN - low
    shift = np.zeros((3, 3))
    shift[:2, 2] = low
    return replace(ideal, width=int(width), height=int(height), matrix=camera.matrix - shift)


def through_lens(picture: NDArray[np.uint8], ideal: Camera, camera: Camera, lens: Lens) -> Array:
    """The picture of an ideal camera as a camera with this lens would take it, shape (height, width, 3)."""
    colours = picture.astype(np.float64)
    if camera.distortion.any():
        v, u = np.indices((camera.height, camera.width))
        columns, rows = np.moveaxis(ideal.to_pixels(camera.to_rays(np.stack([u, v], axis=-1))), -1, 0)
        channels = [
            map_coordinates(colours[..., i], [rows, columns], order=1, mode="nearest") for i in range(3)
        ]
        colours = np.stack(channels, axis=-1)
    if lens.blur > 0.0:
        colours = gaussian_filter(colours, sigma=(lens.blur, lens.blur, 0.0), mode="nearest")
    return colours


def on_sensor(colours: Array, sensor: Sensor, generator: np.random.Generator) -> NDArray[np.uint8]:
    """What a sensor makes of the light that falls on it, shape (height, width, 3)."""
    seen = colours * sensor.exposure * np.array(sensor.colour_cast)
    if sensor.noise > 0.0:
        seen = seen + generator.normal(scale=sensor.noise, size=seen.shape)
    return np.asarray(np.clip(np.rint(seen), 0, 255), dtype=np.uint8)


def _sides(low: Array, high: Array) -> list[tuple[Array, Array]]:
    """Start and end of the four sides of a rectangle."""
    corners = [low, np.array([high[0], low[1]]), high, np.array([low[0], high[1]])]
    return list(zip(corners, [*corners[1:], corners[0]], strict=True))
