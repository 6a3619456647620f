"""Paths without jerk that is not in the task."""

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course.splines import even_basis, roughness_penalty

N_FUNCTIONS = 60
"""Spline functions of a generated path."""


def readout(variance: Array, weight: float) -> Array:
    """The linear map from positions over time to the spline that follows them with little jerk.

    The spline minimises the mean of |x(t) - y(t)|² v / variance(t), with v the variance's median, plus
    ``weight`` times the integral of |x'''(t)|². The same map serves every axis and every scene, so that the
    result moves with the scene.

    Args:
        variance: How far positions may be left, over time, shape (T,).
        weight: Penalty on jerk.

    Returns:
        Shape (B, T).
    """
    values = even_basis(N_FUNCTIONS, len(variance))
    weighted = values * (np.median(variance) / variance)[:, None] / len(variance)
    matrix = values.T @ weighted + weight * roughness_penalty(N_FUNCTIONS, 3)
    return np.asarray(np.linalg.solve(matrix, weighted.T))


def read(coefficients: Array, n_steps: int) -> Array:
    """Positions of splines at equally spaced times: (..., B, d) -> (..., n_steps, d)."""
    return np.asarray(even_basis(N_FUNCTIONS, n_steps) @ coefficients)
