"""What the camera saw, with what perception made of it drawn on top."""

from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from cobot_lfd.app.disk import require_folder, write_file
from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, ObjectModel
from cobot_lfd.errors import CobotError

Picture = NDArray[np.uint8]
Colour = tuple[int, int, int]

WHITE, DARK = (255, 255, 255), (20, 20, 20)
X_COLOUR, Y_COLOUR = (255, 140, 60), (110, 235, 180)  # orange and green that colour-blind eyes tell apart
OUTLINE_COLOUR, PATH_COLOUR, DETOUR_COLOUR = (240, 228, 66), (86, 180, 233), (255, 150, 220)

ELLIPSE_COLOUR = (255, 255, 255)

_N_SIGMA, _MAGNIFIED = 3.0, 20.0  # of the error ellipses, which would be too small to be seen
_ROOM_FOR_LETTER = 8.0  # [px] around the tip of an axis, where its name stands
_SUBPIXEL_BITS = 4  # OpenCV draws at multiples of 1/16 px


def draw_detections(
    picture: Picture,
    camera: Camera,
    detections: Iterable[Detection],
    *,
    models: Iterable[ObjectModel] = (),
    path: ArrayLike | None = None,
    detour: ArrayLike | None = None,
    path_z: float | None = None,
    scale: int = 2,
    text_height: float = 9.0,
    judged: bool = False,
) -> Picture:
    """Draw each object's outline, axes, name and standard errors on an enlarged copy of the camera's picture.

    Args:
        picture: What the camera saw, RGB uint8, shape (H, W, 3).
        camera: The camera that took it.
        detections: The objects that were found.
        models: What the objects look like; an object with a model gets its outline drawn at the pose that was
            found, so that one sees how well it fits, and its axes at the height of that outline. One without
            gets the contour that was seen, and its axes on the table.
        path: A planar path to be drawn too [m], shape (T, 2); None for no path.
        detour: A way that was gone instead of the path [m], shape (T, 2); None for no such way.
        path_z: Height at which both are drawn [m]; None for that of the highest outline, so that path and
            frames are seen in one plane, or for the table where there are no models.
        scale: How many times the picture is enlarged, so that thin lines and small text stay legible.
        text_height: Of letters, in pixels of the camera's picture; more where it will be shown small.
        judged: Whether to draw also how sure each place is, as an ellipse, and to write each confidence.

    Returns:
        RGB uint8, shape (scale * H, scale * W, 3).
    """
    by_name = {model.name: model for model in models}
    canvas = _Canvas(picture, camera, scale, text_height)
    highest = max((model.z for model in by_name.values()), default=0.0)
    for way, colour in ((path, PATH_COLOUR), (detour, DETOUR_COLOUR)):
        if way is not None:
            canvas.path(np.asarray(way, dtype=np.float64), highest if path_z is None else path_z, colour)
    if detour is not None:
        canvas.note("blue: the path as learnt; pink: the way round what stands there")
    detections = tuple(detections)
    extents = [_draw_shape(canvas, detection, by_name.get(detection.name)) for detection in detections]
    for detection, extent in zip(detections, extents, strict=True):
        if judged:
            _draw_ellipse(canvas, detection, by_name.get(detection.name))
        _draw_label(canvas, detection, extent, judged=judged)
    if judged:
        canvas.note(f"ellipses: {_N_SIGMA:.0f} standard errors, drawn {_MAGNIFIED:.0f} times as large")
    return canvas.picture


def require_picture_file(file: Path) -> None:
    """Refuse a file that no picture can be written to, before one is taken.

    Raises:
        CobotError: If its name does not end in .png, or there is no such folder.
    """
    if file.suffix.lower() != ".png":
        raise CobotError(f"cannot write a picture to {file}: its name must end in .png.")
    require_folder(file)


def save_picture(picture: Picture, file: Path) -> Path:
    """Write an RGB picture as PNG, whole or not at all, and return its file.

    Raises:
        DataError: If the file cannot be written.
    """
    _, encoded = cv2.imencode(".png", np.ascontiguousarray(picture[..., ::-1]))
    write_file(file, encoded.tobytes())
    return file


def encode_small(picture: Picture, *, width: int, quality: int = 70) -> bytes:
    """An RGB picture as WebP, shrunk to ``width`` [px] where it is wider; ``quality`` in 1..100."""
    height = round(picture.shape[0] * width / picture.shape[1])
    if picture.shape[1] > width:
        picture = np.asarray(cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA), np.uint8)
    bgr = np.ascontiguousarray(picture[..., ::-1])
    _, encoded = cv2.imencode(".webp", bgr, [cv2.IMWRITE_WEBP_QUALITY, quality])
    return bytes(encoded.tobytes())


def _draw_shape(canvas: "_Canvas", detection: Detection, model: ObjectModel | None) -> Array:
    """Outline and axes; returns the pixels between which they lie."""
    if model is None:
        canvas.polygon(detection.contour, OUTLINE_COLOUR)
    else:
        for contour in (model.outline, *model.holes):
            canvas.polygon(canvas.project(detection.frame.apply(contour), model.z), OUTLINE_COLOUR)
    z = 0.0 if model is None else model.z
    length = 0.05 if model is None else 0.8 * float(np.linalg.norm(model.outline, axis=1).max())
    origin = detection.frame.position
    tips = canvas.project(origin + length * detection.frame.rotation.T, z)
    for tip, name, colour in zip(tips, "xy", (X_COLOUR, Y_COLOUR), strict=True):
        canvas.arrow(canvas.project(origin, z), tip, name, colour)
    return np.concatenate([detection.contour, tips - _ROOM_FOR_LETTER, tips + _ROOM_FOR_LETTER])


def _draw_ellipse(canvas: "_Canvas", detection: Detection, model: ObjectModel | None) -> None:
    """How far off the position may be, magnified."""
    around = np.linspace(0.0, 2 * np.pi, 49)[:-1]
    spread, axes = np.linalg.eigh(detection.covariance[:2, :2])
    circle = np.column_stack([np.cos(around), np.sin(around)])
    radii = _MAGNIFIED * _N_SIGMA * np.sqrt(np.maximum(spread, 0.0))
    z = 0.0 if model is None else model.z
    canvas.polygon(canvas.project(detection.frame.position + circle * radii @ axes.T, z), ELLIPSE_COLOUR)


def _draw_label(canvas: "_Canvas", detection: Detection, extent: Array, *, judged: bool) -> None:
    """Name and standard errors below the object, or above where there is no room below."""
    sigma = np.sqrt(np.diag(detection.covariance))
    millimetres, degrees = 1e3 * np.hypot(sigma[0], sigma[1]), np.rad2deg(sigma[2])
    lines = [detection.name, f"±{millimetres:.2f} mm  ±{degrees:.2f}°"]
    if judged:
        lines.append(f"confidence {100 * detection.confidence:.0f} %")
    elif detection.confidence < 0.9:
        lines.append(f"only {100 * detection.confidence:.0f} % of it seen")
    canvas.text_below(extent, lines)


class _Canvas:
    """An enlarged picture that is drawn on in the camera's pixel coordinates."""

    def __init__(self, picture: Picture, camera: Camera, scale: int, text_height: float) -> None:
        if picture.shape != (camera.height, camera.width, 3) or picture.dtype != np.uint8:
            raise ValueError(
                f"picture has shape {picture.shape} and type {picture.dtype}; this camera takes "
                f"({camera.height}, {camera.width}, 3) of uint8."
            )
        size = (scale * camera.width, scale * camera.height)
        self.picture: Picture = np.asarray(
            cv2.resize(picture, size, interpolation=cv2.INTER_CUBIC), dtype=np.uint8
        )
        self._camera = camera
        self._scale = scale
        self._text_height = text_height * scale

    def project(self, points: Array, z: float) -> Array:
        """Pixel positions of points at a height above the table."""
        return self._camera.project(np.concatenate([points, np.full((*points.shape[:-1], 1), z)], axis=-1))

    def polygon(self, pixels: Array, colour: Colour) -> None:
        self._lines(pixels, colour, closed=True)

    def path(self, points: Array, z: float, colour: Colour) -> None:
        pixels = self.project(points, z)
        self._lines(pixels, colour, closed=False)
        centre = self._fixed(pixels[0])
        for radius, filling in ((5, DARK), (4, colour)):
            fixed_radius = (radius * self._scale // 2) << _SUBPIXEL_BITS
            cv2.circle(self.picture, centre, fixed_radius, filling, -1, cv2.LINE_AA, _SUBPIXEL_BITS)

    def arrow(self, start: Array, tip: Array, name: str, colour: Colour) -> None:
        along = (tip - start) / np.linalg.norm(tip - start)
        across = np.array([-along[1], along[0]])
        self._lines(np.stack([start, tip]), colour, closed=False)
        for side in (across, -across):
            self._lines(np.stack([tip, tip - 4.0 * along + 2.5 * side]), colour, closed=False)
        middle = self._enlarged(tip) + 0.78 * self._text_height * along
        self._text(name, middle + self._text_height * np.array([-0.33, 0.39]), colour)

    def text_below(self, extent: Array, lines: list[str]) -> None:
        height = 1.1 * self._text_height
        left = self._enlarged(extent.min(axis=0))[0]
        top, bottom = self._enlarged(extent)[:, 1].min(), self._enlarged(extent)[:, 1].max()
        fits = bottom + (len(lines) + 1) * height < self.picture.shape[0]
        y = bottom + 2.0 * height if fits else top - (len(lines) - 0.2) * height
        for number, line in enumerate(lines):
            width = 0.58 * self._text_height * len(line)
            x = float(np.clip(left, 4.0, max(4.0, self.picture.shape[1] - width)))
            self._text(line, np.array([x, y + number * height]), WHITE)

    def note(self, text: str) -> None:
        """Words in the picture's lower left corner."""
        self._text(text, np.array([6.0, self.picture.shape[0] - 0.45 * self._text_height]), WHITE)

    def _text(self, text: str, origin: Array, colour: Colour) -> None:
        font, size, weight = cv2.FontFace("sans"), round(self._text_height), 500
        x, y = round(float(origin[0])), round(float(origin[1]))
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                cv2.putText(self.picture, text, (x + dx, y + dy), DARK, font, size, weight)
        cv2.putText(self.picture, text, (x, y), colour, font, size, weight)

    def _lines(self, pixels: Array, colour: Colour, *, closed: bool) -> None:
        """Straight lines between pixels, with a dark rim that keeps them visible on any ground."""
        corners = np.array([self._fixed(pixel) for pixel in pixels], dtype=np.int32)
        for width, line_colour in ((self._scale + 2, DARK), (self._scale, colour)):
            cv2.polylines(
                self.picture, [corners], closed, line_colour, width, cv2.LINE_AA, shift=_SUBPIXEL_BITS
            )

    def _enlarged(self, pixels: Array) -> Array:
        """Pixel positions in the enlarged picture; pixel centres lie at whole numbers in both."""
        return self._scale * (pixels + 0.5) - 0.5

    def _fixed(self, pixel: Array) -> tuple[int, int]:
        x, y = np.round(self._enlarged(pixel) * (1 << _SUBPIXEL_BITS)).astype(int).tolist()
        return x, y
