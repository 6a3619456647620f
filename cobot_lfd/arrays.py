"""Arrays in value types: checked once when the value is made, then read-only."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
"""An array of 64-bit floats; docstrings give its shape and unit."""


def frozen_array(value: ArrayLike, name: str, shape: tuple[int | None, ...]) -> Array:
    """A read-only copy of ``value``, checked to be finite and of the given shape.

    Args:
        value: Anything that numpy turns into an array of floats.
        name: What the array is called in an error message.
        shape: The expected shape; None stands for any length.

    Raises:
        ValueError: If the shape differs or a number is not finite.
    """
    array = np.array(value, dtype=np.float64)
    if array.ndim != len(shape) or any(
        n is not None and n != m for n, m in zip(shape, array.shape, strict=True)
    ):
        wanted = "(" + ", ".join("any" if n is None else str(n) for n in shape) + ")"
        raise ValueError(f"{name} has shape {array.shape}; it must have shape {wanted}.")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds numbers that are not finite; remove or repair them.")
    array.setflags(write=False)
    return array
