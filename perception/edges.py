"""How far the edges in the picture are from where they are expected, to a small part of a pixel."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from perception.mixture import Mixture
from perception.picture import Picture
from perception.silhouette import Contour

_STEP = 0.5  # Distance of the samples across an edge [px].
_FAR_REACH = 3.0  # Reach from which on twice that will do [px]: a rough place is looked for.
_FAR = 0.6  # Share of the reach from where on a sample is well inside or well outside.
_LEAST_LIGHT = (
    0.15  # Of object or table, compared with their typical brightness: darker, it is something else.
)
_BEYOND = np.array([1.5, 2.5, 3.5])  # Beyond the reach, where no blur brings the object's colour [px].
_MOST_FOREIGN = 0.05  # Of a colour in the table's place, compared with the table's.
_USUAL_NOISE = 0.08  # Of a share: what the limits here allow for.
_N_SIGMA = 2.0  # By which they widen with more of it.
_LEAST_COVERED = 0.7  # Share of the object well inside its outline, and of the table well outside.


@dataclass(frozen=True, slots=True, eq=False)
class EdgeOffsets:
    """What was measured at the points of a contour.

    Attributes:
        offsets: Distance of the edge from the contour, positive outwards [px], shape (n,).
        mixed: Share of the object in the pixel nearest to each point, shape (n,).
        valid: Whether an edge between object and table was found there, shape (n,).
        empty: Whether the table is seen on both sides, shape (n,); no object can be there.
    """

    offsets: Array
    mixed: Array
    valid: NDArray[np.bool_]
    empty: NDArray[np.bool_]


def measure_edges(picture: Picture, mixture: Mixture, contour: Contour, reach: float) -> EdgeOffsets:
    """Look for the edge across a contour, by adding up how much of the way shows the object.

    Args:
        picture: The picture.
        mixture: Tells the object from the table.
        contour: Where the edge is expected.
        reach: How far to look to either side [px].
    """
    step = _STEP if reach < _FAR_REACH else 2 * _STEP
    across = np.arange(-reach + step / 2, reach, step)
    image = mixture.near(picture, contour.pixels, reach + _BEYOND[-1])
    columns, rows = _across(contour, np.concatenate([across, reach + _BEYOND]))
    shares = image.between_pixels(columns, rows)
    columns, rows = columns[:, : len(across)], rows[:, : len(across)]
    thing, table, _ = shares[..., : len(across)]
    inside, outside = across < -_FAR * reach, across > _FAR * reach
    light = np.maximum(table[:, outside].mean(axis=1), _LEAST_LIGHT)
    covered = np.clip(1.0 - table / light[:, None], -0.5, 1.5)
    within, without = covered[:, inside].mean(axis=1), covered[:, outside].mean(axis=1)
    beyond = shares[..., len(across) :].mean(axis=2)
    on_table = mixture.foreign(*beyond) < _MOST_FOREIGN + _blur(mixture.foreign_noise, len(_BEYOND))
    slack = 1.0 - _LEAST_COVERED + _blur(mixture.table_noise, int(inside.sum()))
    table_outside = on_table & (light > _LEAST_LIGHT) & (np.abs(without) < slack)
    object_inside = (thing[:, inside].mean(axis=1) > _LEAST_LIGHT) & (within > 1.0 - slack)
    return EdgeOffsets(
        offsets=covered.sum(axis=1) * step - reach,
        mixed=1.0 - image.at_pixels(contour.pixels)[1] / light,
        valid=table_outside & object_inside & image.holds(columns, rows),
        empty=table_outside & (np.abs(within) < 1.0 - _LEAST_COVERED),
    )


def _blur(noise: float, n: int) -> float:
    """How far the mean of n samples may be off because of noise; every other of them is independent."""
    excess = max(0.0, noise - _USUAL_NOISE)
    return float(_N_SIGMA * excess / np.sqrt(max(1.0, 0.5 * n)))


def _across(contour: Contour, distances: Array) -> Array:
    """Columns and rows of places at distances outwards from a contour [px], shape (2, n, m)."""
    return np.asarray(contour.pixels.T[..., None] + contour.normals.T[..., None] * distances)
