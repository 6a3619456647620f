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
    line = x[0] + _middles(knots)[:, None] * (
        x[-1] - x[0]
    )  # Coefficients of the straight way from end to end.
    values = spline_matrix(u, knots, DEGREE)
    nearness, roughness = (_inner_bands(matrix) for matrix in (values.T @ values, _roughness(knots)))
    beside = x - values @ line
    pull = (values.T @ beside)[1:-1]
    best = interpolating
    low, high = 0, len(WEIGHTS)
    while low < high:
        middle = (low + high) // 2
        detour = _smoothed(nearness + len(u) * WEIGHTS[middle] * roughness, pull)
        if detour is not None and np.abs(values @ detour - beside).max() <= tolerance:
            best, low = BSpline(knots, line + detour, DEGREE), middle + 1
        else:
            high = middle
    return best


def _smoothed(normal: Array, pull: Array) -> Array | None:
    """Coefficients of the minimiser for one weight, the first and the last held at zero, shape (M, n).

    Args:
        normal: Bands of the matrix of the normal equations.
        pull: Their right side.
    """
    try:
        inner = solveh_banded(normal, pull, lower=True)
    except LinAlgError:  # The weight is so large that the points no longer count within rounding.
        return None
    return np.pad(inner, ((1, 1), (0, 0)))


def _inner_bands(matrix: csr_array) -> Array:
    """A symmetric matrix without its first and last rows, as the bands on and below its diagonal."""
    inner = matrix[1:-1, 1:-1]
    bands = np.zeros((DEGREE + 1, inner.shape[0]))
    for offset in range(DEGREE + 1):
        diagonal = inner.diagonal(offset)
        bands[offset, : len(diagonal)] = diagonal
    return bands


def _middles(knots: Array) -> Array:
    """The coefficients of the spline ``p(u) = u``: means of ``DEGREE`` successive knots."""
    return np.convolve(knots[1:-1], np.full(DEGREE, 1 / DEGREE), mode="valid")


def _roughness(knots: Array) -> csr_array:
    """The matrix ``R`` with ``c' R c = integral |p'''|^2`` for spline coefficients ``c``, shape (M, M)."""
    breaks = np.unique(knots)
    nodes, weights = np.polynomial.legendre.leggauss(3)
    half = np.diff(breaks)[:, None] / 2
    at = (breaks[:-1, None] + half * (1 + nodes)).ravel()
    third = spline_matrix(at, knots, DEGREE, order=3)
    return csr_array(third.T @ (third * (half * weights).ravel()[:, None]))
