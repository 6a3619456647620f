"""The colours of a picture that are not the table's, found as the peaks of a histogram of shares."""

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from perception.picture import Picture
from perception.robust import robust_deviation
from perception.table import shares

_LEAST = 0.02  # Distance from the table's shares from where on a colour may be another one.
_N_NOISE = 5.0  # Standard deviations of the table's shares that never count as another colour.
_BIN = 0.02  # Of the histogram.
_REACH = 1.0  # The shares' plane lies within this distance of the table's shares.
_FEWEST = 40  # Pixels of a peak.
_APART = 0.08  # Distance of two peaks that are two colours.
_EVERY = 5  # Pixels from one to the next where a part of them is enough.


def label_colours(picture: Picture, table: Array) -> NDArray[np.int_]:
    """For each pixel the number of the colour that it has, -1 where it has the table's.

    Args:
        picture: Red, green, blue, shape (height, width, 3).
        table: The table's colour in it, shape (3,).
    """
    difference = shares(picture.astype(np.float64)) - shares(table)
    distance = np.linalg.norm(difference, axis=-1)
    noise = robust_deviation(distance.ravel()[::_EVERY])
    foreground = distance > max(_LEAST, _N_NOISE * noise)
    labels = np.full(distance.shape, -1)
    peaks = _peaks(difference[foreground])
    if len(peaks):
        apart = np.linalg.norm(difference[foreground][:, None] - peaks, axis=2)
        labels[foreground] = apart.argmin(axis=1)
    return labels


def _peaks(points: Array) -> Array:
    """The places where many points lie, shape (k, 2)."""
    n_bins = round(2 * _REACH / _BIN)
    bins = np.clip(((points + _REACH) / _BIN).astype(int), 0, n_bins - 1)
    counts = np.bincount(bins @ [n_bins, 1], minlength=n_bins**2).reshape(n_bins, n_bins)
    smooth = cv2.GaussianBlur(counts.astype(np.float64), (0, 0), 1.5)
    highest = smooth >= cv2.dilate(smooth, np.ones((3, 3), np.uint8))
    crowd = cv2.boxFilter(counts.astype(np.float64), -1, (5, 5), normalize=False)
    candidates = np.argwhere(highest & (crowd >= _FEWEST))
    candidates = candidates[np.argsort(-smooth[tuple(candidates.T)], kind="stable")]
    kept: list[Array] = []
    for place in (candidates + 0.5) * _BIN - _REACH:
        if all(np.linalg.norm(place - other) > _APART for other in kept):
            kept.append(place)
    return np.array(kept).reshape(-1, 2)
