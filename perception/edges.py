"""How far the edges in the picture are from where they are expected, to a small part of a pixel."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from perception.mixture import Mixture
from perception.picture import Picture
from perception.silhouette import Contour

_STEP = 0.5  # Distance of the samples across an edge [px].
_FAR = 0.6  # Share of the reach from where on a sample is well inside or well outside.
_LEAST_LIGHT = (
    0.15  # Of object or table, compared with their typical brightness: darker, it is something else.
)
_LEAST_COVERED = 0.7  # Share of the object well inside its outline, and of the table well outside.


@dataclass(frozen=True, slots=True, eq=False)
class EdgeOffsets:
    """What was measured at the points of a contour.

    Attributes:
        offsets: Distance of the edge from the contour, positive outwards [px], shape (n,).
        mixed: Share of the object in the pixel nearest to each point, shape (n,).
        valid: Whether an edge between object and table was found there, shape (n,).
    """

    offsets: Array
    mixed: Array
    valid: NDArray[np.bool_]


def measure_edges(picture: Picture, mixture: Mixture, contour: Contour, reach: float) -> EdgeOffsets:
    """Look for the edge across a contour, by adding up how much of the way shows the object.

    Args:
        picture: The picture.
        mixture: Tells the object from the table.
        contour: Where the edge is expected.
        reach: How far to look to either side [px].
    """
    across = np.arange(-reach + _STEP / 2, reach, _STEP)
    image = mixture.near(picture, contour.pixels, reach)
    columns, rows = contour.pixels.T[..., None] + contour.normals.T[..., None] * across
    thing, table = image.between_pixels(columns, rows)
    inside, outside = across < -_FAR * reach, across > _FAR * reach
    thing_level, table_level = thing[:, inside].mean(axis=1), table[:, outside].mean(axis=1)
    light = np.maximum(table_level, _LEAST_LIGHT)
    covered = np.clip(1.0 - table / light[:, None], -0.5, 1.5)
    valid = (
        (thing_level > _LEAST_LIGHT)
        & (table_level > _LEAST_LIGHT)
        & (covered[:, inside].mean(axis=1) > _LEAST_COVERED)
        & (np.abs(covered[:, outside].mean(axis=1)) < 1.0 - _LEAST_COVERED)
        & image.holds(columns, rows)
    )
    mixed = 1.0 - image.at_pixels(contour.pixels)[1] / light
    return EdgeOffsets(covered.sum(axis=1) * _STEP - reach, mixed, valid)
