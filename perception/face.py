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
_LEAST_ERROR = 0.006  # How far off the picture is from which the face was learnt [px]; found by measuring.
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
            in light or shadow, does not shine into them, shape (n,). At the first blur all count: until
            the pose is nearly right, surroundings help.
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
        levels = tuple(_level(appearance, image, mask, i) for i in range(len(BLURS)))
        radius = _RADIUS * float(np.linalg.norm(np.ptp(appearance.outline, axis=0)))
        return cls(levels, appearance.z, radius, appearance.metres_per_pixel)

    @property
    def least_error(self) -> Array:
        """How far off in x [m], y [m] and angle [rad] it may be because of how it was learnt, shape (3,)."""
        return _LEAST_ERROR * self.metres_per_pixel / np.array([1.0, 1.0, self.radius])


def _level(appearance: Appearance, image: NDArray[Any], mask: NDArray[np.uint8], i: int) -> Level:
    """The face's pixels at the i-th blur; only at the last one it is told how soft the picture is."""
    stride = _STRIDES[i]
    pixels = np.argwhere(mask[::stride, ::stride]) * stride
    inwards = np.asarray(cv2.distanceTransform(mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE), np.float64)
    depth = np.full(len(pixels), np.inf) if i == 0 else inwards[tuple(pixels.T)]
    local = appearance.to_local(pixels[:, ::-1])
    rows, columns = pixels.T // _BLOCK
    return Level(
        local=local,
        across=local / np.abs(local).max(),
        blocks=rows * (image.shape[1] // _BLOCK + 1) + columns,
        looks=tuple(
            _look(image, appearance.metres_per_pixel, pixels, local, depth, float(np.hypot(BLURS[i], softer)))
            for softer in (SOFTER if i == len(BLURS) - 1 else SOFTER[:1])
        ),
    )


def _look(
    image: NDArray[Any], scale: float, pixels: NDArray[Any], local: Array, depth: Array, blur: float
) -> Look:
    rows, columns = pixels.T
    smooth = np.asarray(cv2.GaussianBlur(image, (0, 0), blur), np.float64)
    down, right = (np.gradient(smooth, axis=axis)[rows, columns] for axis in (0, 1))
    bright = smooth[rows, columns]
    diffusion = 0.5 * np.asarray(cv2.Laplacian(smooth, cv2.CV_64F))[rows, columns]
    return Look(
        brightness=bright,
        gradients=np.column_stack([right, -down]) / scale,
        shades=np.column_stack(
            [bright, np.ones(len(bright)), diffusion, bright[:, None] * local / np.abs(local).max()]
        ),
        undisturbed=depth >= min(_DISTURBED * blur, float(np.median(depth))),  # Of a narrow face half.
    )
