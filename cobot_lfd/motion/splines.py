"""B-splines and their derivatives as sparse matrices acting on coefficients."""

import numpy as np
from scipy.interpolate import BSpline
from scipy.sparse import csr_array

from cobot_lfd.arrays import Array


def spline_matrix(at: Array, knots: Array, degree: int, order: int = 0) -> csr_array:
    """The matrix from the coefficients of a spline to its derivative of the given order at some places.

    Args:
        at: Where to evaluate, within the knots, shape (K,).
        knots: Knots, not decreasing, shape (n_coefficients + degree + 1,).
        degree: Degree of the spline.
        order: Order of the derivative, 0 to ``degree``.

    Returns:
        A matrix of shape (K, n_coefficients), with ``degree + 1`` numbers per row that are not zero.
    """
    inner = knots[order : len(knots) - order]
    matrix = csr_array(BSpline.design_matrix(at, inner, degree - order))
    for k in range(degree - order + 1, degree + 1):
        matrix = matrix @ _derivative_matrix(knots[degree - k : len(knots) - (degree - k)], k)
    return csr_array(matrix)


def _derivative_matrix(knots: Array, degree: int) -> csr_array:
    """The matrix from the coefficients of a spline to those of its derivative, one degree lower."""
    n = len(knots) - degree - 1
    factors = degree / (knots[degree + 1 : degree + n] - knots[1:n])
    rows = np.arange(n - 1)
    entries = np.concatenate([-factors, factors])
    places = (np.concatenate([rows, rows]), np.concatenate([rows, rows + 1]))
    return csr_array((entries, places), shape=(n - 1, n))
