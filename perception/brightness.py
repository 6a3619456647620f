"""How bright a picture is, every colour counting alike, and how noisy."""

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from perception.picture import Picture
from perception.robust import robust_deviation

_EVERY = 8  # Rows from one to the next in which noise is measured.
_LEAST_NOISE = 0.4  # What rounding leaves at the least [0..255].


def brightness(picture: Picture) -> NDArray[np.uint8]:
    """Mean of red, green and blue, shape (height, width).

    A photographer's grey hardly counts blue and so hides what a blue board shows; the mean of all three
    treats every colour alike, and averages the sensor's noise best.
    """
    return np.asarray(cv2.transform(picture, np.full((1, 3), 1 / 3, np.float32)), np.uint8)


def noise_of(image: NDArray[Any]) -> float:
    """Standard deviation of the noise of an image's pixels [0..255], from neighbours that should agree."""
    rows = image[::_EVERY].astype(np.float32)
    return max(_LEAST_NOISE, robust_deviation(np.diff(rows, axis=1)) / 2**0.5)
