"""What most errors are like, however far off a few are."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array

_NORMAL = 1.4826  # Standard deviation of normal errors, as a multiple of their median size.
_TUKEY = 4.685  # Standard deviations from which on an error does not count at all.


def robust_deviation(errors: NDArray[Any]) -> float:
    """Standard deviation of errors of any shape, told by their median size, which outliers hardly change.

    The median is numpy's, without the care for axes and for what is no number, which takes ten times as long.
    """
    size = np.abs(errors).ravel()
    middle = len(size) // 2
    sorted_there = np.partition(size, [middle, middle - 1 + len(size) % 2])
    return _NORMAL * 0.5 * float(sorted_there[middle] + sorted_there[middle - 1 + len(size) % 2])


def tukey_weights(errors: Array, scale: float) -> Array:
    """Tukey's biweight: 1 for no error, 0 for what is far off, compared with the errors' scale."""
    return np.asarray(np.clip(1.0 - (errors / (_TUKEY * scale)) ** 2, 0.0, None) ** 2)
