"""A face prepared for being fitted: how its pixels look at several blurs, and through softer lenses."""

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.appearance import Appearance
from cobot_lfd.arrays import Array
from perception.brightness import brightness

BLURS = (2.0, 1.0, 0.5)  # Of face and picture, step after step [px]: far reach at first, then precision.
SOFTER = (0.0, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0)
"""Blur that the picture may have and the picture from which the face was learnt has not [px]."""

_STRIDES = (2, 2, 1)  # Of the pixels that are compared at each blur.
_BLOCK = 6  # Side of the squares of pixels within which errors hang together [px].
_LEAST_ERROR = 0.004  # How far off the picture is from which the face was learnt [px]; found by measuring.
_DISTURBED = 2.0  # Distance from the outline within which surroundings disturb a face, in blurs.
_RADIUS = 0.3  # Of a face's pixels about its middle, as a share of its extent.


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """How a face's pixels look through a lens.

    Attributes:
        brightness: How bright they are [0..255], shape (n,).
        gradients: Of the brightness, along the frame's axes [1/m], shape (n, 2).
        shades: How the brightness that is seen changes with the light's numbers, shape (n, 5): a factor, what
            is added, the square of a further blur (half of the second derivatives' sum, since blur is
            diffusion), and how much the factor grows along the frame's axes.
        undisturbed: Whether they are so far inside the outline that what surrounds the face, which may be
            in light or shadow, does not shine into them, shape (n,).
    """

    brightness: Array
    gradients: Array
    shades: Array
    undisturbed: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """A face's pixels well inside its outline, at one blur.

    Attributes:
        local: Where they are in the object's frame [m], shape (n, 2).
        across: The same as shares of the face's reach, in -1..1, shape (n, 2).
        blocks: Number of the square that each lies in, shape (n,).
        looks: How they look through each of the softer lenses.
    """

    local: Array
    across: Array
    blocks: NDArray[np.int_]
    looks: tuple[Look, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """A face, prepared for being fitted.

    Attributes:
        levels: Its pixels at each blur; the more it is blurred, the fewer are needed.
        z: Height of the face [m].
        radius: Of its pixels about its middle [m].
        metres_per_pixel: Scale of the picture that it was learnt from [m/px].
    """

    levels: tuple[Level, ...]
    z: float
    radius: float
    metres_per_pixel: float

    @classmethod
    def of(cls, appearance: Appearance) -> "Face":
        """From what the face looks like."""
        image = brightness(appearance.image).astype(np.float32)
        mask = np.zeros(image.shape, np.uint8)
        cv2.fillPoly(mask, [np.rint(appearance.to_pixels(appearance.outline)).astype(np.int32)], 1)
        mask = np.asarray(cv2.erode(mask, np.ones((3, 3), np.uint8), borderValue=0), np.uint8)
        levels = tuple(
            _level(appearance, image, mask, blur, stride)
            for blur, stride in zip(BLURS, _STRIDES, strict=True)
        )
        radius = _RADIUS * float(np.linalg.norm(np.ptp(appearance.outline, axis=0)))
        return cls(levels, appearance.z, radius, appearance.metres_per_pixel)

    @property
    def least_error(self) -> Array:
        """How far off in x [m], y [m] and angle [rad] it may be because of how it was learnt, shape (3,)."""
        return _LEAST_ERROR * self.metres_per_pixel / np.array([1.0, 1.0, self.radius])


def _level(
    appearance: Appearance, image: NDArray[Any], mask: NDArray[np.uint8], blur: float, stride: int
) -> Level:
    rows, columns = (stride * indices for indices in np.nonzero(mask[::stride, ::stride]))
    depth = np.asarray(cv2.distanceTransform(mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE))
    local = appearance.to_local(np.column_stack([columns, rows]))
    return Level(
        local=local,
        across=local / np.abs(local).max(),
        blocks=(rows // _BLOCK) * (image.shape[1] // _BLOCK + 1) + columns // _BLOCK,
        looks=tuple(
            _look(appearance, image, depth, rows, columns, float(np.hypot(blur, softer))) for softer in SOFTER
        ),
    )


def _look(
    appearance: Appearance,
    image: NDArray[Any],
    depth: NDArray[Any],
    rows: NDArray[Any],
    columns: NDArray[Any],
    blur: float,
) -> Look:
    across = appearance.to_local(np.column_stack([columns, rows]))
    across /= np.abs(across).max()
    smooth = np.asarray(cv2.GaussianBlur(image, (0, 0), blur), np.float64)
    down, right = (np.gradient(smooth, axis=axis)[rows, columns] for axis in (0, 1))
    bright = smooth[rows, columns]
    diffusion = 0.5 * np.asarray(cv2.Laplacian(smooth, cv2.CV_64F))[rows, columns]
    return Look(
        brightness=bright,
        gradients=np.column_stack([right, -down]) / appearance.metres_per_pixel,
        shades=np.column_stack([bright, np.ones(len(bright)), diffusion, bright[:, None] * across]),
        undisturbed=depth[rows, columns] > _DISTURBED * blur,
    )
