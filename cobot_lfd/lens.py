"""What a lens does to straight lines: the Brown-Conrady model, with OpenCV's five coefficients.

A ray meets the plane one metre before the camera at (x, y). With r² = x² + y² the lens moves it to

    x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2 x²)
    y' = y (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 y²) + 2 p2 x y
"""

import numpy as np

from cobot_lfd.arrays import Array

_N_ITERATIONS = 20  # Each makes the rest at least ten times smaller for lenses of up to 5 % distortion.


def distort(rays: Array, coefficients: Array) -> Array:
    """Where a lens moves rays.

    Args:
        rays: Ideal rays (x, y), shape (..., 2).
        coefficients: k1, k2, p1, p2, k3, shape (5,).
    """
    k1, k2, p1, p2, k3 = coefficients
    x, y = rays[..., 0], rays[..., 1]
    r2 = x**2 + y**2
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    moved_x = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x**2)
    moved_y = y * radial + p1 * (r2 + 2 * y**2) + 2 * p2 * x * y
    return np.stack([moved_x, moved_y], axis=-1)


def undistort(rays: Array, coefficients: Array) -> Array:
    """Which ideal rays a lens has moved to the given ones; undoes ``distort``, by fixed-point iteration."""
    ideal = rays
    for _ in range(_N_ITERATIONS):
        ideal = ideal + rays - distort(ideal, coefficients)
    return np.asarray(ideal)
