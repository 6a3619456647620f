"""What an object's uppermost face looks like from straight above, learnt from one picture of it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cobot_lfd.arrays import Array, frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class Appearance:
    """A face as a map: how it looks from straight above, with a scale and a frame.

    It consists of plain arrays and numbers, which are all that needs to be stored.

    Attributes:
        name: Name of the object.
        image: Red, green, blue, uint8, shape (rows, columns, 3); the frame's x axis runs to the right, its y
            axis upwards.
        outline: Corners of the part of it that shows the object, in the object's frame [m], shape (n, 2).
        metres_per_pixel: Its scale [m/px].
        z: Height of the face in the world [m].
        origin: Where in the image the frame has its origin, column and row [px], shape (2,).
    """

    name: str
    image: NDArray[np.uint8]
    outline: Array
    metres_per_pixel: float
    z: float
    origin: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        image = np.array(self.image)
        if image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] != 3 or not image.size:
            raise ValueError(
                f"image of '{self.name}' has shape {image.shape} and type {image.dtype}; it must have shape "
                "(rows, columns, 3) and type uint8."
            )
        image.setflags(write=False)
        object.__setattr__(self, "image", image)
        object.__setattr__(self, "outline", frozen_array(self.outline, "outline", (None, 2)))
        object.__setattr__(self, "origin", frozen_array(self.origin, "origin", (2,)))
        if not self.metres_per_pixel > 0.0:
            raise ValueError(
                f"metres_per_pixel of '{self.name}' is {self.metres_per_pixel}; it must be positive."
            )

    def to_local(self, pixels: ArrayLike) -> Array:
        """Places in the image (column, row) as places in the object's frame [m], shape (..., 2)."""
        off = np.asarray(pixels, dtype=np.float64) - self.origin
        return np.asarray(off * [self.metres_per_pixel, -self.metres_per_pixel])

    def to_pixels(self, local: ArrayLike) -> Array:
        """Places in the object's frame [m] as places in the image; undoes ``to_local``."""
        scaled = np.asarray(local, dtype=np.float64) / [self.metres_per_pixel, -self.metres_per_pixel]
        return np.asarray(scaled + self.origin)
