"""ArUco markers: what they look like, and which of them lies where on an object."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array

N_MARKERS = 50
MARKER_CELLS = 6  # Along a side, with the black border.

# The cells inside the border, row by row, white is 1, of the markers 0 to 49 of ArUco's dictionary 4X4_50.
_CELLS = (
    0xB532, 0x0F9A, 0x332D, 0x9946, 0x549E, 0x79CD, 0x9E2E, 0xC4F2, 0xFEDA, 0xCF56,
    0xF991, 0x11A7, 0x0EB7, 0x2A0F, 0x24B1, 0x263E, 0x4665, 0x6600, 0x6C5E, 0x76AF,
    0x868B, 0xB02B, 0xCCD5, 0xDD82, 0xFE47, 0x9471, 0xACE4, 0xA554, 0x2123, 0x346F,
    0x4415, 0x57B2, 0x9ECF, 0xF0CB, 0x08AE, 0x0929, 0x1875, 0x04FF, 0x0DF6, 0x1C5A,
    0x1718, 0x2A28, 0x328C, 0x38B2, 0x24E8, 0x2EEB, 0x2D3F, 0x4B64, 0x502E, 0x5013,
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Marker:
    """A marker that lies flat on something.

    Attributes:
        name: Name of the frame that it marks; the frame is in its middle, x to its right, y to its top.
        number: Its number in the dictionary of 4 x 4 markers, 0 to 49.
        size: Length of the black square's sides [m].
        z: Its height in the world [m].
    """

    name: str
    number: int
    size: float
    z: float

    def __post_init__(self) -> None:
        """Check."""
        if not 0 <= self.number < N_MARKERS:
            raise ValueError(
                f"marker '{self.name}' has number {self.number}; it must be 0 to {N_MARKERS - 1}."
            )

    @property
    def corners(self) -> Array:
        """Top left, top right, bottom right, bottom left in the marker's frame [m], shape (4, 2)."""
        return np.array([[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]]) * self.size / 2


def marker_image(number: int, pixels_per_cell: int = 1) -> NDArray[np.uint8]:
    """A marker as it is printed, with its black border, 0 or 255, shape (6 n, 6 n)."""
    bits = (_CELLS[number] >> np.arange(15, -1, -1)) & 1
    cells = np.pad(255 * bits.reshape(4, 4), 1).astype(np.uint8)
    return np.kron(cells, np.ones((pixels_per_cell, pixels_per_cell), np.uint8))
