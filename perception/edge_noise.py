"""How far measured edges may be off, and how the errors of neighbouring points hang together.

A picture whose pixels are sampled at points has stairs along its edges: the edge appears up to half a pixel
off, ever more along a stair, then it jumps back. A stair as long as the edge does not average out. With the
phase of the stairs unknown, the error is a sawtooth of period P, whose autocorrelation over a distance d is
``s² (1 - 6 u (1 - u))`` with ``u = d / P mod 1`` and ``s² = 1/12`` px² (the second Bernoulli polynomial). A
pixel that averages over its area has no such stairs, and shows it by mixed colours on the edge.
"""

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from perception.silhouette import Contour

_MIXED_WITHOUT_STAIRS = 2 / 3  # Mean of 4 a (1 - a) over an edge, where the covered share a is evenly spread.
_LEAST_NOISE = 0.04  # What light, rounding and the lens leave at the least [px].
_NOT_SAWTOOTH = 0.5  # Variance of the stairs that does not follow the sawtooth, as a share of it.
_SPREAD = 3.0  # Number of points over which one pixel's noise is spread.


def stair_variance(mixed: Array) -> float:
    """Variance of an edge's place due to stairs [px²], from the covered shares of the pixels on the edge.

    Where a pixel averages n points across the edge, the mean of ``4 a (1 - a)`` is ``2/3 (1 - 1/n²)``, and
    the variance is ``1/12 / n²``.

    Args:
        mixed: Share of the object in the pixel nearest to each point of the contour, shape (n,).
    """
    mixing = float(np.mean(4 * np.clip(mixed, 0.0, 1.0) * (1 - np.clip(mixed, 0.0, 1.0))))
    return max(0.0, 1.0 - mixing / _MIXED_WITHOUT_STAIRS) / 12


def weighted_normal_equations(
    contour: Contour, jacobian: Array, offsets: Array, stairs: float, white: float
) -> tuple[Array, Array]:
    """Least squares that knows how errors hang together: ``J' R^-1 J`` and ``J' R^-1 r``.

    Args:
        contour: Where the edges were measured, n points.
        jacobian: How they depend on the unknowns, shape (n, m).
        offsets: What was measured [px], shape (n,).
        stairs: Variance due to stairs [px²].
        white: Variance due to all else [px²].
    """
    information, pull = np.zeros((jacobian.shape[1],) * 2), np.zeros(jacobian.shape[1])
    for edge in np.unique(contour.edges):
        mine = contour.edges == edge
        R = _covariance(contour, mine, stairs, white)
        solved = np.linalg.solve(R, np.column_stack([jacobian[mine], offsets[mine]]))
        information += jacobian[mine].T @ solved[:, :-1]
        pull += jacobian[mine].T @ solved[:, -1]
    return information, pull


def _covariance(contour: Contour, mine: NDArray[np.bool_], stairs: float, white: float) -> Array:
    """Covariance of the errors along one edge [px²], shape (k, k)."""
    pixels = contour.pixels[mine]
    across, along = np.sort(np.abs(contour.normals[mine][0]))
    distance = np.linalg.norm(pixels - pixels[0], axis=1)
    u = np.mod(np.abs(distance[:, None] - distance) * across, 1.0)
    sawtooth = stairs * along**2 * (1 - 6 * u * (1 - u))
    rest = _SPREAD * white + _NOT_SAWTOOTH * stairs + _LEAST_NOISE**2
    return np.asarray(sawtooth + rest * np.eye(len(pixels)))
