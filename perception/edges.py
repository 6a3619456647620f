"""How far the edges in the picture are from where they are expected, to a small part of a pixel."""

from dataclasses import dataclass

import cv2
import numpy as np

from cobot_lfd.arrays import Array
from perception.picture import Picture
from perception.silhouette import Contour

_STEP = 0.5  # Distance of the samples across an edge [px].


@dataclass(frozen=True, slots=True, eq=False)
class TableShare:
    """How much of the table each pixel shows, whatever the shade of the object in front of it.

    A pixel on an edge shows a mixture of the object's colour O and the table's colour T, each as bright as
    the light makes it: ``k O + q T``. The weights ``v`` with ``v · O = 0`` and ``v · T = 1`` give q, the
    share of the table; k, the shade of the object's sides, does not matter.

    Attributes:
        weights: What red, green, blue (0..255) are multiplied by, shape (3,).
    """

    weights: Array

    @classmethod
    def between(cls, table: Array, thing: Array) -> "TableShare":
        """For a table and a thing of these colours, red, green, blue, shape (3,) each."""
        rest = table - (table @ thing) / (thing @ thing) * thing
        return cls(rest / (rest @ table))


@dataclass(frozen=True, slots=True, eq=False)
class EdgeOffsets:
    """What was measured at the points of a contour.

    Attributes:
        offsets: Distance of the edge from the contour, positive outwards [px], shape (n,).
        valid: Whether an edge between object and table was found there, shape (n,).
    """

    offsets: Array
    valid: Array


def measure_edges(picture: Picture, share: TableShare, contour: Contour, reach: float) -> EdgeOffsets:
    """Look for the edge across a contour, by adding up how much is not table.

    Args:
        picture: The picture.
        share: Tells the table from the object.
        contour: Where the edge is expected.
        reach: How far to look to either side [px].
    """
    across = np.arange(-reach + _STEP / 2, reach, _STEP)
    where = contour.pixels[:, None] + across[:, None] * contour.normals[:, None]
    table = _sample(picture, share, where)
    outer = np.abs(across - reach) < max(1.5, 0.4 * reach)
    level = np.median(table[:, outer], axis=1)
    lit = level > 0.2
    covered = 1.0 - table / np.where(lit, level, 1.0)[:, None]
    offsets = np.clip(covered, -0.5, 1.5).sum(axis=1) * _STEP - reach
    filled = covered[:, across < -0.6 * reach].mean(axis=1) > 0.7
    in_picture = ((where[:, [0, -1]] > 0) & (where[:, [0, -1]] < np.array(picture.shape[1::-1]) - 1)).all(
        (1, 2)
    )
    return EdgeOffsets(offsets, lit & filled & in_picture & (np.abs(offsets) < 0.8 * reach))


def _sample(picture: Picture, share: TableShare, where: Array) -> Array:
    """The share of the table at places in the picture, shape (n, m)."""
    low = np.clip(np.floor(where.min(axis=(0, 1))).astype(int) - 1, 0, None)
    high = np.ceil(where.max(axis=(0, 1))).astype(int) + 2
    part = picture[low[1] : high[1], low[0] : high[0]]
    if part.size == 0:
        return np.zeros(where.shape[:2])
    table = cv2.transform(part.astype(np.float32), share.weights[None].astype(np.float32))
    columns, rows = (where - low).astype(np.float32).transpose(2, 0, 1)
    return np.asarray(
        cv2.remap(table, columns, rows, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), dtype=np.float64
    )
