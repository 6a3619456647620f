"""The smoothest spline that stays within a tolerance of its points.

A smoothing spline minimises ``sum |p(u_i) - x_i|^2 + weight * integral |p'''|^2``. The weight is the
largest for which no point is missed by more than the tolerance. With the third derivative in the penalty the
minimiser is a quintic spline with knots at the points, which is four times continuously differentiable.
"""

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.linalg import LinAlgError, solveh_banded
from scipy.sparse import csr_array

from cobot_lfd.arrays import Array
from cobot_lfd.motion.splines import spline_matrix

DEGREE = 5
WEIGHTS = np.logspace(-26.0, -2.0, 97)
"""Smoothing weights to choose from: the first smooths nothing, the last leaves about one bend."""


def fit_spline(u: Array, x: Array, tolerance: float) -> BSpline:
    """The smoothest spline that misses no inner point by more than ``tolerance`` and no end point at all.

    Args:
        u: Parameters of the points, strictly increasing from 0 to 1, shape (M,), M >= 2.
        x: The points, shape (M, n).
        tolerance: Largest distance in each coordinate between a point and the spline at its parameter.
    """
    interpolating = make_interp_spline(u, x, k=min(DEGREE, len(u) - 1))
    if tolerance == 0 or len(u) <= DEGREE + 1:
        return interpolating
    knots = interpolating.t
    values = spline_matrix(u, knots, DEGREE)
    roughness = _roughness(knots)
    best = interpolating
    low, high = 0, len(WEIGHTS)
    while low < high:
        middle = (low + high) // 2
        spline = _smoothed(knots, values, roughness, x, len(u) * WEIGHTS[middle])
        if spline is not None and np.abs(spline(u) - x).max() <= tolerance:
            best, low = spline, middle + 1
        else:
            high = middle
    return best


def _smoothed(
    knots: Array, values: csr_array, roughness: csr_array, x: Array, weight: float
) -> BSpline | None:
    """The minimiser for one weight, with its first and last coefficient held at the end points."""
    normal = values.T @ values + weight * roughness
    ends = [0, len(x) - 1]
    right = (values.T @ x - normal[:, ends] @ x[ends])[1:-1]
    inner = normal[1:-1, 1:-1]
    banded = np.zeros((DEGREE + 1, inner.shape[0]))
    for offset in range(DEGREE + 1):
        diagonal = inner.diagonal(offset)
        banded[offset, : len(diagonal)] = diagonal
    try:
        coefficients = solveh_banded(banded, right, lower=True)
    except LinAlgError:  # The weight is so large that the points no longer count within rounding.
        return None
    return BSpline(knots, np.vstack([x[0], coefficients, x[-1]]), DEGREE)


def _roughness(knots: Array) -> csr_array:
    """The matrix ``R`` with ``c' R c = integral |p'''|^2`` for spline coefficients ``c``, shape (M, M)."""
    breaks = np.unique(knots)
    nodes, weights = np.polynomial.legendre.leggauss(3)
    half = np.diff(breaks)[:, None] / 2
    at = (breaks[:-1, None] + half * (1 + nodes)).ravel()
    third = spline_matrix(at, knots, DEGREE, order=3)
    return csr_array(third.T @ (third * (half * weights).ravel()[:, None]))
