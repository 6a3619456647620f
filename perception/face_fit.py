"""The pose of a face whose look is known, fitted to the brightness of all its pixels in a picture."""

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.appearance import Appearance
from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.frame import Frame
from perception.rigid import on_plane

_BLURS = (2.0, 1.0, 0.5)  # Of face and picture, step after step [px]: far reach at first, then precision.
_STRIDES = (2, 2, 1)  # Of the pixels that are compared at each blur.
_N_STEPS = 6
_SMALL_STEP = 5e-6  # [m] and [rad]
_TUKEY = 4.685
_LEAST_NOISE = 2.0  # Of brightness, in any case [0..255].
_LEAST_WEIGHT = 0.2  # From here on a pixel counts as one that shows the face.
_BLOCK = 4  # Side of the squares of pixels within which errors hang together [px].
_N_EVEN = 5  # Unknowns where the light is even; at first it always is, until the pose is nearly right.
_FEWEST_PIXELS = 60
_LEAST_INSIDE = 0.3  # Share of a face that must lie in the picture.
_RIDGE = 1e-3 * np.eye(7)  # Keeps what no pixel tells anything about where it is.
_DARK = 20.0  # Brightness below which a ratio tells little [0..255].
_LEAST_CONTRAST = 0.2  # Of the picture, compared with the face; below, it shows something else.
_LEAST_ERROR = 0.03  # How far off the picture is from which the face was learnt [px]; found by measuring.
_RADIUS = 0.3  # Of a face's pixels about its middle, as a share of its extent.


@dataclass(frozen=True, slots=True, eq=False)
class FaceFit:
    """A pose and how well the picture supports it.

    Attributes:
        frame: The pose.
        covariance: Of the errors in x [m], y [m] and angle [rad], shape (3, 3).
        shown: Share of the face's pixels that look as they should.
        correlation: Of the brightness of those, expected and seen.
    """

    frame: Frame
    covariance: Array
    shown: float
    correlation: float


@dataclass(frozen=True, slots=True, eq=False)
class _Level:
    """A face's pixels well inside its outline, at one blur.

    Attributes:
        local: Where they are in the object's frame [m], shape (n, 2).
        brightness: How bright they are [0..255], shape (n,).
        gradients: Of the brightness, along the frame's axes [1/m], shape (n, 2).
        blocks: Number of the square that each lies in, shape (n,).
        shades: How the brightness changes with each of the light's numbers, shape (n, 4).
    """

    local: Array
    brightness: Array
    gradients: Array
    blocks: NDArray[np.int_]
    shades: Array


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """A face, prepared for being fitted.

    Attributes:
        levels: Its pixels at each blur; the more it is blurred, the fewer are needed.
        z: Height of the face [m].
        least_error: How far off in x [m], y [m] and angle [rad] it may be because of how it was learnt, (3,).
    """

    levels: tuple[_Level, ...]
    z: float
    least_error: Array

    @classmethod
    def of(cls, appearance: Appearance) -> "Face":
        """From what the face looks like."""
        grey = cv2.cvtColor(appearance.image, cv2.COLOR_RGB2GRAY).astype(np.float32)
        mask = np.zeros(grey.shape, np.uint8)
        cv2.fillPoly(mask, [np.rint(appearance.to_pixels(appearance.outline)).astype(np.int32)], 1)
        mask = np.asarray(cv2.erode(mask, np.ones((3, 3), np.uint8), borderValue=0), np.uint8)
        levels = tuple(
            _level(appearance, grey, mask, blur, stride)
            for blur, stride in zip(_BLURS, _STRIDES, strict=True)
        )
        radius = _RADIUS * float(np.linalg.norm(np.ptp(appearance.outline, axis=0)))
        least_error = _LEAST_ERROR * appearance.metres_per_pixel / np.array([1.0, 1.0, radius])
        return cls(levels, appearance.z, least_error)


def _level(
    appearance: Appearance, grey: NDArray[Any], mask: NDArray[np.uint8], blur: float, stride: int
) -> _Level:
    smooth = np.asarray(cv2.GaussianBlur(grey, (0, 0), blur), np.float64)
    rows, columns = (stride * indices for indices in np.nonzero(mask[::stride, ::stride]))
    down, right = (np.gradient(smooth, axis=axis)[rows, columns] for axis in (0, 1))
    local, brightness = appearance.to_local(np.column_stack([columns, rows])), smooth[rows, columns]
    u, v = (local / np.abs(local).max()).T
    return _Level(
        local=local,
        brightness=brightness,
        gradients=np.column_stack([right, -down]) / appearance.metres_per_pixel,
        blocks=(rows // _BLOCK) * (grey.shape[1] // _BLOCK + 1) + columns // _BLOCK,
        shades=np.column_stack([brightness, np.ones_like(brightness), brightness * u, brightness * v]),
    )


def blurred(grey: NDArray[np.uint8]) -> list[NDArray[Any]]:
    """A grey picture at each of the blurs that faces are compared at."""
    return [np.asarray(cv2.GaussianBlur(grey.astype(np.float32), (0, 0), blur)) for blur in _BLURS]


def fit_face(
    pictures: list[NDArray[Any]], camera: Camera, face: Face, start: Frame, *, even: bool = True
) -> FaceFit | None:
    """Move a face until its pixels look as they are expected to look.

    Gauss-Newton on the differences of brightness, with the face's own gradients as in inverse compositional
    alignment (Baker and Matthews 2004), for the pose together with the light;
    Tukey's weights leave out what covers the face.

    Args:
        pictures: The grey picture at each blur.
        camera: The camera that took it.
        face: The face.
        start: Where it is, to a few pixels.
        even: Whether the light is taken to be even across the face; if not, a cover may pass for shade.

    Returns:
        The fit; None if the face leaves the picture, or too little of it is seen.
    """
    seen, inside = _seen(pictures[0], camera, face.levels[0], face.z, start)
    if inside.mean() < _LEAST_INSIDE:
        return None
    frame, light = start, _first_light(face.levels[0].brightness[inside], seen[inside])
    for picture, level in zip(pictures, face.levels, strict=True):
        for _ in range(_N_STEPS):
            seen, inside = _seen(picture, camera, level, face.z, frame)
            if inside.mean() < _LEAST_INSIDE:
                return None
            errors = seen - level.shades @ light
            jacobian = _jacobian(level, frame, light)
            weighted = jacobian * _weights(errors, inside)[:, None]
            free = _N_EVEN if even or level is face.levels[0] else len(weighted.T)
            information = weighted[:, :free].T @ jacobian[:, :free] + _RIDGE[:free, :free]
            step = np.zeros(len(weighted.T))
            step[:free] = -np.linalg.solve(information, weighted[:, :free].T @ errors)
            frame = Frame(frame.position + step[:2], frame.angle + step[2])
            light = light + step[3:]
            if np.abs(step[:3]).max() < _SMALL_STEP:
                break
    return _judged(pictures[-1], camera, face, frame, light)


def _seen(
    picture: NDArray[Any], camera: Camera, level: _Level, z: float, frame: Frame
) -> tuple[Array, NDArray[np.bool_]]:
    """Brightness of the picture where a face's pixels land, and whether they land in it, shape (n,) each."""
    places = camera.project(on_plane(frame.apply(level.local), z)).astype(np.float32)
    x, y = places.T
    sampled = cv2.remap(picture, x[:, None], y[:, None], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    inside = (x >= 0) & (y >= 0) & (x <= camera.width - 1) & (y <= camera.height - 1)
    return np.asarray(sampled, np.float64).ravel(), inside


def _first_light(expected: Array, seen: Array) -> Array:
    """The light as it seems at first, an even factor, shape (4,).

    Its numbers are a factor of the face's brightness, what is added to it [0..255], and how much the factor
    grows towards the ends of the frame's axes.
    """
    return np.array([float(np.median(seen / np.maximum(expected, _DARK))), 0.0, 0.0, 0.0])


def _jacobian(level: _Level, frame: Frame, light: Array) -> Array:
    """How much brighter each pixel is seen by a step in x, y and angle, and expected by one of the light's.

    Its sign is that of the difference between seen and expected, shape (n, 7).
    """
    in_world = light[0] * level.gradients @ frame.rotation.T
    x, y = (level.local @ frame.rotation.T).T
    by_angle = in_world[:, 1] * x - in_world[:, 0] * y
    return np.column_stack([in_world, by_angle, -level.shades])


def _weights(errors: Array, inside: NDArray[np.bool_]) -> Array:
    """Tukey's biweight, shape (n,); 0 for what is not in the picture."""
    scale = max(1.4826 * float(np.median(np.abs(errors[inside]))), _LEAST_NOISE)
    return np.where(inside, np.clip(1.0 - (errors / (_TUKEY * scale)) ** 2, 0.0, None) ** 2, 0.0)


def _judged(picture: NDArray[Any], camera: Camera, face: Face, frame: Frame, light: Array) -> FaceFit | None:
    """How well a pose is supported by the least blurred picture.

    The covariance is the sandwich ``H^-1 (sum over blocks of g g') H^-1`` (Huber 1967): it takes the errors
    as they are, also where those of neighbouring pixels hang together.
    """
    level = face.levels[-1]
    seen, inside = _seen(picture, camera, level, face.z, frame)
    errors = seen - level.shades @ light
    weights = _weights(errors, inside)
    shown = weights > _LEAST_WEIGHT
    if shown.sum() < _FEWEST_PIXELS:
        return None
    jacobian = _jacobian(level, frame, light)
    weighted = jacobian * weights[:, None]
    pulls = np.zeros((level.blocks.max() + 1, jacobian.shape[1]))
    np.add.at(pulls, level.blocks, weighted * errors[:, None])
    inverse = np.linalg.inv(weighted.T @ jacobian + _RIDGE)
    covariance = (inverse @ (pulls.T @ pulls) @ inverse)[:3, :3] + np.diag(face.least_error**2)
    return FaceFit(
        frame,
        covariance,
        shown=float(shown.mean()),
        correlation=_correlation((level.shades @ light)[shown], seen[shown])
        if light[0] > _LEAST_CONTRAST
        else 0.0,
    )


def _correlation(a: Array, b: Array) -> float:
    """Of two series of values; 0 where one of them is even."""
    a, b = a - a.mean(), b - b.mean()
    return float(a @ b / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-9))
