"""The table's colour, found in the picture: the colour that most of it has, however bright."""

import cv2
import numpy as np

from cobot_lfd.arrays import Array

_N_BINS = 48  # Fine enough to part the table from a pale object, coarse enough to hold the table's noise.
_LEAST_BRIGHT = 0.1  # Share of the picture that must tell a colour.
_DARKEST = 12.0  # Mean of red, green, blue below which a pixel tells no colour [0..255].
_PLANE = np.array([[2.0, -1.0, -1.0], [0.0, np.sqrt(3), -np.sqrt(3)]]).T / np.sqrt(6)
"""Two axes of the plane in which the shares of red, green and blue lie, shape (3, 2)."""


def chromaticity(colours: Array) -> Array:
    """Red, green, blue as shares of their sum, shape (..., 3); black has none and counts as grey."""
    total = np.asarray(colours @ np.ones(3))[..., None]
    return np.asarray(np.where(total > 0, colours / np.maximum(total, 1e-9), 1 / 3))


def shares(colours: Array) -> Array:
    """Colours, shape (..., 3), as places in the plane of their shares of red, green and blue, (..., 2).

    Grey, and black, which has no shares, lie in its origin.
    """
    placed = colours @ np.column_stack([_PLANE, np.ones(3)])
    return np.asarray(placed[..., :2] / np.maximum(placed[..., 2:], 1e-9))


def table_colour(colours: Array) -> Array | None:
    """Mean colour of what most of the picture shows, shape (3,); None if the picture is too dark to tell.

    Brightness changes with light and shadow, the shares of red, green and blue hardly; so the most frequent
    shares are looked for.

    Args:
        colours: Red, green, blue in 0..255, shape (n, 3).
    """
    bright = colours[colours @ np.ones(3) > 3 * _DARKEST]
    if len(bright) < _LEAST_BRIGHT * len(colours):
        return None
    bins = (chromaticity(bright)[:, :2] * (_N_BINS - 1e-6)).astype(int)
    counts = np.bincount(bins @ [_N_BINS, 1], minlength=_N_BINS**2).reshape(_N_BINS, _N_BINS)
    smooth = cv2.blur(counts.astype(np.float64), (3, 3), borderType=cv2.BORDER_CONSTANT)
    peak = np.divmod(np.argmax(smooth), _N_BINS)
    near = (np.abs(bins - peak) <= 1).all(axis=1)
    return np.asarray(bright[near].mean(axis=0))
