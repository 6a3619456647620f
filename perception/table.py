"""The table's colour, found in the picture: the colour that most of it has, however bright."""

import cv2
import numpy as np

from cobot_lfd.arrays import Array

_N_BINS = 48  # Fine enough to part the table from a pale object, coarse enough to hold the table's noise.
_DARKEST = 12.0  # Mean of red, green, blue below which a pixel tells no colour [0..255].


def chromaticity(colours: Array) -> Array:
    """Red, green, blue as shares of their sum, shape (..., 3); black has none and counts as grey."""
    total = colours.sum(axis=-1, keepdims=True)
    return np.asarray(np.where(total > 0, colours, 1.0) / np.where(total > 0, total, 3.0))


def table_colour(colours: Array) -> Array | None:
    """Mean colour of what most of the picture shows, shape (3,); None if the picture is too dark to tell.

    Brightness changes with light and shadow, the shares of red, green and blue hardly; so the most frequent
    shares are looked for.

    Args:
        colours: Red, green, blue in 0..255, shape (height, width, 3).
    """
    pixels = colours.reshape(-1, 3)
    pixels = pixels[pixels.sum(axis=1) > 3 * _DARKEST]
    if len(pixels) < 0.1 * colours.shape[0] * colours.shape[1]:
        return None
    shares = chromaticity(pixels)[:, :2]
    bins = np.minimum((shares * _N_BINS).astype(int), _N_BINS - 1)
    counts = np.bincount(bins[:, 0] * _N_BINS + bins[:, 1], minlength=_N_BINS**2).reshape(_N_BINS, _N_BINS)
    smooth = cv2.blur(counts.astype(np.float64), (3, 3), borderType=cv2.BORDER_CONSTANT)
    peak = np.array(np.unravel_index(np.argmax(smooth), smooth.shape))
    near = (np.abs(bins - peak) <= 1).all(axis=1)
    return np.asarray(pixels[near].mean(axis=0))
