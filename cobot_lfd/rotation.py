"""A rotation as axis times angle, and back: for loops that turn one thing hundreds of times in a second.

SciPy's ``Rotation`` does the same for many at once; one at a time, it takes ten times as long as this.
"""

from math import atan2, cos, hypot, pi, sin

import numpy as np

from cobot_lfd.arrays import Array

_TINY = 1e-12  # sine of an angle below which it has no axis


def rotation_vector(matrix: Array) -> Array:
    """The rotation as its axis, as long as its angle is large [rad], shape (3,).

    Args:
        matrix: Rotation matrix, shape (3, 3).
    """
    (a, b, c), (d, e, f), (g, h, i) = matrix.tolist()
    x, y, z = 0.5 * (h - f), 0.5 * (c - g), 0.5 * (d - b)  # the axis times the sine of the angle
    sine, cosine = hypot(x, y, z), 0.5 * (a + e + i - 1.0)
    if sine > _TINY:
        ratio = atan2(sine, cosine) / sine
        return np.array([ratio * x, ratio * y, ratio * z])
    if cosine > 0.0:
        return np.array([x, y, z])
    return _half_turn(matrix)


def rotation_matrix(vector: Array) -> Array:
    """The rotation matrix, shape (3, 3), of an axis that is as long as its angle is large [rad]."""
    x, y, z = vector.tolist()
    angle = hypot(x, y, z)
    if angle > _TINY:
        x, y, z = x / angle, y / angle, z / angle
    c, s = cos(angle), sin(angle)
    v = 1.0 - c
    return np.array(
        [
            [c + v * x * x, v * x * y - s * z, v * x * z + s * y],
            [v * x * y + s * z, c + v * y * y, v * y * z - s * x],
            [v * x * z - s * y, v * y * z + s * x, c + v * z * z],
        ]
    )


def _half_turn(matrix: Array) -> Array:
    """The rotation vector of half a turn, whose matrix is twice the axis times itself, minus one."""
    squares = 0.5 * (matrix + np.eye(3))
    longest = int(np.argmax(np.diag(squares)))
    axis = squares[longest] / np.sqrt(squares[longest, longest])
    return np.asarray(pi * axis)
