"""Checks that a picture is what it should be before anything is looked for in it."""

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.camera import Camera

Picture = NDArray[np.uint8]
"""Red, green, blue, shape (height, width, 3)."""


def check_picture(picture: Picture, camera: Camera) -> None:
    """Check kind and size of a picture.

    Raises:
        ValueError: If it is no picture of this camera.
    """
    if not isinstance(picture, np.ndarray) or picture.dtype != np.uint8:
        kind = picture.dtype if isinstance(picture, np.ndarray) else type(picture).__name__
        raise ValueError(f"the picture holds {kind}; it must be an array of uint8, 0 to 255.")
    wanted = (camera.height, camera.width, 3)
    if picture.shape != wanted:
        raise ValueError(
            f"the picture has shape {picture.shape}; the camera's have shape {wanted}: "
            "height, width, and red, green, blue."
        )
