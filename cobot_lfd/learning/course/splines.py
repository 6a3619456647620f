"""Quintic B-splines on 0..1: curves whose jerk is smooth, and the penalty on it."""

from functools import cache

import numpy as np
from scipy.interpolate import BSpline

from cobot_lfd.arrays import Array

DEGREE = 5
"""Lowest odd degree at which the third derivative is itself twice differentiable."""


def basis(n_functions: int, at: Array, derivative: int = 0) -> Array:
    """The basis functions, or a derivative of them, at places in 0..1, shape (T, n_functions)."""
    inner = np.linspace(0.0, 1.0, n_functions - DEGREE + 1)
    knots = np.concatenate([np.zeros(DEGREE), inner, np.ones(DEGREE)])
    return np.asarray(BSpline(knots, np.eye(n_functions), DEGREE)(at, nu=derivative))


@cache
def even_basis(n_functions: int, n_places: int) -> Array:
    """The basis at equally spaced places, remembered because it is asked for again and again; read-only."""
    values = basis(n_functions, np.linspace(0.0, 1.0, n_places))
    values.setflags(write=False)
    return values


@cache
def fine_derivative(n_functions: int, derivative: int) -> Array:
    """A derivative of the basis at many places, for integrals, shape (40 B, B); read-only."""
    n_fine = 40 * n_functions
    values = basis(n_functions, (np.arange(n_fine) + 0.5) / n_fine, derivative)
    values.setflags(write=False)
    return values


def roughness_penalty(n_functions: int, derivative: int, weights: Array | None = None) -> Array:
    """The matrix R for which c' R c is the weighted integral of a curve's squared derivative, shape (B, B).

    Args:
        n_functions: B.
        derivative: 2 penalises bends, 3 jerk.
        weights: At the places of ``fine_derivative``; None: 1 everywhere.
    """
    values = fine_derivative(n_functions, derivative)
    weighted = values if weights is None else values * weights[:, None]
    return np.asarray(values.T @ weighted / len(values))
