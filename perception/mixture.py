"""Tells how much of a pixel shows an object and how much the table, each as bright as the light makes it."""

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from perception.picture import Picture


@dataclass(frozen=True, slots=True, eq=False)
class Mixture:
    """A pixel's colour as a mixture of two: ``p O + q T``, with the object's colour O and the table's T.

    The shade of the object's faces goes into p, shadows on the table into q; so a pixel that shows only the
    object has q = 0 and one that shows only the table p = 0, however the light falls.

    Attributes:
        weights: The rows give p and q when multiplied by red, green, blue (0..255), shape (2, 3).
    """

    weights: Array

    @classmethod
    def of(cls, thing: Array, table: Array) -> "Mixture":
        """For an object and a table of these colours, red, green, blue, shape (3,) each."""
        return cls(np.linalg.pinv(np.column_stack([thing, table])))

    def near(self, picture: Picture, pixels: Array, reach: float) -> "MixtureImage":
        """The mixture in the part of a picture that is around some places, shape (n, 2)."""
        size = np.array(picture.shape[1::-1])
        low = np.clip(np.floor(pixels.min(axis=0) - reach).astype(int), 0, size - 1)
        high = np.clip(np.ceil(pixels.max(axis=0) + reach).astype(int) + 2, low + 1, size)
        part = picture[low[1] : high[1], low[0] : high[0]].astype(np.float32)
        return MixtureImage(cv2.transform(part, self.weights.astype(np.float32)), low, size)


@dataclass(frozen=True, slots=True, eq=False)
class MixtureImage:
    """The shares of object and table in a part of a picture.

    Attributes:
        shares: p and q, shape (height, width, 2).
        origin: Column and row of its first pixel in the picture, shape (2,).
        picture_size: Width and height of the picture [px], shape (2,).
    """

    shares: Any
    origin: NDArray[np.int_]
    picture_size: NDArray[np.int_]

    def between_pixels(self, columns: Array, rows: Array) -> tuple[Array, Array]:
        """Shares p and q, interpolated at places in the picture, shape (n, m) each."""
        x, y = (columns - self.origin[0]).astype(np.float32), (rows - self.origin[1]).astype(np.float32)
        sampled = cv2.remap(self.shares, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(sampled[..., 0], dtype=np.float64), np.asarray(sampled[..., 1], dtype=np.float64)

    def at_pixels(self, pixels: Array) -> tuple[Array, Array]:
        """Shares p and q of the pixels nearest to places in the picture, shape (n,) each."""
        height, width = self.shares.shape[:2]
        nearest = np.clip(np.rint(pixels).astype(int) - self.origin, 0, np.array([width, height]) - 1)
        found = np.asarray(self.shares[nearest[:, 1], nearest[:, 0]], dtype=np.float64)
        return found[:, 0], found[:, 1]

    def holds(self, columns: Array, rows: Array) -> NDArray[np.bool_]:
        """Whether the lines of places, shape (n, m), lie within the picture from end to end, shape (n,)."""
        x, y = columns[:, [0, -1]], rows[:, [0, -1]]
        width, height = self.picture_size
        return np.asarray(((x > 0) & (y > 0) & (x < width - 1) & (y < height - 1)).all(axis=1))
