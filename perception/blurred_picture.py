"""A picture at each of the blurs that faces are compared at."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.camera import Camera
from perception.brightness import noise_of
from perception.face import BLURS
from perception.foreground import Part

_KERNEL = 9  # Reach of the last blur [px].
_AROUND = 8  # Pixels around a part that the first blur reaches.


@dataclass(frozen=True, slots=True, eq=False)
class BlurredPicture:
    """How bright a picture is, at each of the blurs that faces are compared at.

    Attributes:
        levels: The picture at each blur, shape (height, width) each.
        noise: Standard deviation of the noise in the least blurred one [0..255].
        camera: The camera that took it.
    """

    levels: tuple[NDArray[Any], ...]
    noise: float
    camera: Camera

    @classmethod
    def of(cls, image: NDArray[np.uint8], parts: Iterable[Part], camera: Camera) -> "BlurredPicture":
        """From how bright a picture is; only in its parts may there be faces."""
        levels = tuple(image.astype(np.float32) for _ in BLURS)
        for rows, columns in parts:
            above, left = max(rows.start - _AROUND, 0), max(columns.start - _AROUND, 0)
            part = image[above : rows.stop + _AROUND, left : columns.stop + _AROUND].astype(np.float32)
            inner = tuple(slice(a.start - o, a.stop - o) for a, o in ((rows, above), (columns, left)))
            for level, blur in zip(levels, BLURS, strict=True):
                level[rows, columns] = cv2.GaussianBlur(part, (0, 0), blur)[inner]
        kernel = np.ravel(cv2.getGaussianKernel(_KERNEL, BLURS[-1]))
        left = float(kernel @ kernel) * 2 / 3  # Of the variance along an axis; interpolation leaves 2/3.
        return cls(levels, noise_of(image) * left, camera)
