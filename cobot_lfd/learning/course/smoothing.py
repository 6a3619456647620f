"""Paths without jerk that is not in the task."""

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course.splines import basis, even_basis, roughness_penalty

N_FUNCTIONS = 60
"""Spline functions of a generated path."""

PACE_WEIGHT = 0.004
"""How firmly the pace at both ends is held, against positions. A demonstration sets off from rest; without
this, smoothing makes the path set off backwards by a few millimetres, and turning costs an arm time. More
of it makes jerk where a demonstration sets off at speed."""
PACE_SPAN = 0.02
"""The pace at an end is told from twice this part of the duration: over less, trembling counts as pace."""


def readout(variance: Array, weight: float) -> Array:
    """The linear map from positions over time to the spline that follows them with little jerk.

    The spline minimises the mean of |x(t) - y(t)|² v / variance(t), with v the variance's median, plus
    ``weight`` times the integral of |x'''(t)|², and sets off and arrives at the pace at which y does. The
    same map serves every axis and every scene, so that the result moves with the scene.

    Args:
        variance: How far positions may be left, over time, shape (T,).
        weight: Penalty on jerk.

    Returns:
        Shape (B, T).
    """
    values = even_basis(N_FUNCTIONS, len(variance))
    weighted = values * (np.median(variance) / variance)[:, None] / len(variance)
    pace, wanted_pace = basis(N_FUNCTIONS, np.array([0.0, 1.0]), 1), _end_differences(len(variance))
    matrix = values.T @ weighted + weight * roughness_penalty(N_FUNCTIONS, 3) + PACE_WEIGHT * pace.T @ pace
    return np.asarray(np.linalg.solve(matrix, weighted.T + PACE_WEIGHT * pace.T @ wanted_pace))


def _end_differences(n_times: int) -> Array:
    """The map from positions over time to the pace at both ends, exact for parabolas, shape (2, T)."""
    step = max(1, min(round(PACE_SPAN * n_times), (n_times - 1) // 2))
    one_sided = np.array([-1.5, 2.0, -0.5]) * (n_times - 1) / step
    differences = np.zeros((2, n_times))
    differences[0, : 2 * step + 1 : step] = one_sided
    differences[1, n_times - 1 - 2 * step :: step] = -one_sided[::-1]
    return differences


def read(coefficients: Array, n_steps: int) -> Array:
    """Positions of splines at equally spaced times: (..., B, d) -> (..., n_steps, d)."""
    return np.asarray(even_basis(N_FUNCTIONS, n_steps) @ coefficients)
