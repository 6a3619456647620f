"""Tells how much of a pixel shows an object and how much the table, each as bright as the light makes it."""

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from perception.picture import Picture

_COLOURS_OFF = 0.73  # Of a face or a shadow as a whole [0..255].
_SHADE = 0.3  # Standard deviation of p + q from 1, by shadows and the shade of faces.


@dataclass(frozen=True, slots=True, eq=False)
class Mixture:
    """A pixel's colour as a mixture of two, ``p O + q T + r N``: the object's colour O and the table's T.

    The shade of the object's faces goes into p, shadows on the table into q; so a pixel that shows only the
    object has q = 0 and one that shows only the table p = 0, however the light falls. N is at right angles to
    both and as long as T: r is what belongs to neither. Where O and T differ little but in brightness, as
    white and wood do, noise would drown p and q; so they are the likeliest given that ``p + q`` is near 1.

    Attributes:
        weights: The rows give p, q and r when multiplied by red, green, blue (0..255) and 1, shape (3, 4).
        colours: O, T and N are its columns, shape (3, 3).
        noise: Standard deviation of the noise of the picture's pixels [0..255].
    """

    weights: Array
    colours: Array
    noise: float

    @classmethod
    def of(cls, thing: Array, table: Array, noise: float = 1.0) -> "Mixture":
        """For an object and a table of these colours, red, green, blue, shape (3,) each.

        Args:
            thing: The object's colour.
            table: The table's.
            noise: Standard deviation of the noise of the picture's pixels [0..255].
        """
        neither = np.cross(thing, table)
        if np.linalg.norm(neither) < 1e-6 * np.linalg.norm(table) ** 2:
            neither = np.cross(table, np.roll(table, 1) * [1.0, -1.0, 1.0])
        neither *= np.linalg.norm(table) / np.linalg.norm(neither)
        pair = np.column_stack([thing, table])
        information = pair.T @ pair / noise**2 + 1.0 / _SHADE**2
        shares = np.linalg.solve(information, np.column_stack([pair.T / noise**2, np.full(2, _SHADE**-2)]))
        rest = np.append(neither / (neither @ neither), 0.0)
        return cls(np.vstack([shares, rest]), np.column_stack([pair, neither]), noise)

    @property
    def table_noise(self) -> float:
        """Standard deviation of the share q of the table in a pixel."""
        return self.noise * float(np.linalg.norm(self.weights[1, :3]))

    @property
    def table_error(self) -> float:
        """Standard deviation of the share q over all of a face or a shadow, whose colours are a little off.

        It is the uncertainty of q, given that the colours are off by one of 255 and ``p + q`` from 1 by the
        shade: small where object and table differ in colour, large where they do so only in brightness.
        """
        pair = self.colours[:, :2]
        return float(np.linalg.inv(pair.T @ pair / _COLOURS_OFF**2 + np.eye(2) / _SHADE**2)[1, 1] ** 0.5)

    @property
    def foreign_noise(self) -> float:
        """Standard deviation of what ``foreign`` gives for a pixel of the table."""
        rest = self.colours[:, [0, 2]] @ self.weights[[0, 2], :3]
        return self.noise * float(np.linalg.norm(rest) / np.linalg.norm(self.colours[:, 1]))

    def foreign(self, thing: Array, table: Array, neither: Array) -> Array:
        """How much of colours, given by their shares, is not the table's; of what is; shape (n,)."""
        rest = np.outer(thing, self.colours[:, 0]) + np.outer(neither, self.colours[:, 2])
        tables = np.maximum(table, 1e-3) * np.linalg.norm(self.colours[:, 1])
        return np.asarray(np.linalg.norm(rest, axis=1) / tables)

    def near(self, picture: Picture, pixels: Array, reach: float) -> "MixtureImage":
        """The mixture in the part of a picture that is around some places, shape (n, 2)."""
        size = np.array(picture.shape[1::-1])
        low = np.clip(np.floor(pixels.min(axis=0) - reach).astype(int), 0, size - 1)
        high = np.clip(np.ceil(pixels.max(axis=0) + reach).astype(int) + 2, low + 1, size)
        part = picture[low[1] : high[1], low[0] : high[0]].astype(np.float32)
        return MixtureImage(cv2.transform(part, self.weights.astype(np.float32)), low, size)


@dataclass(frozen=True, slots=True, eq=False)
class MixtureImage:
    """The shares of object, table and neither in a part of a picture.

    Attributes:
        shares: p, q and r, shape (height, width, 3).
        origin: Column and row of its first pixel in the picture, shape (2,).
        picture_size: Width and height of the picture [px], shape (2,).
    """

    shares: Any
    origin: NDArray[np.int_]
    picture_size: NDArray[np.int_]

    def between_pixels(self, columns: Array, rows: Array) -> Array:
        """Shares p, q and r, interpolated at places in the picture, shape (3, n, m)."""
        x, y = (columns - self.origin[0]).astype(np.float32), (rows - self.origin[1]).astype(np.float32)
        sampled = cv2.remap(self.shares, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(sampled, dtype=np.float64).transpose(2, 0, 1)

    def at_pixels(self, pixels: Array) -> Array:
        """Shares p, q and r of the pixels nearest to places in the picture, shape (3, n)."""
        height, width = self.shares.shape[:2]
        nearest = np.clip(np.rint(pixels).astype(int) - self.origin, 0, np.array([width, height]) - 1)
        return np.asarray(self.shares[nearest[:, 1], nearest[:, 0]], dtype=np.float64).T

    def holds(self, columns: Array, rows: Array) -> NDArray[np.bool_]:
        """Whether the lines of places, shape (n, m), lie within the picture from end to end, shape (n,)."""
        x, y = columns[:, [0, -1]], rows[:, [0, -1]]
        width, height = self.picture_size
        return np.asarray(((x > 0) & (y > 0) & (x < width - 1) & (y < height - 1)).all(axis=1))
