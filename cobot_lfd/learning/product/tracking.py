"""The path that follows Gaussians closely where they are sure, and with little jerk."""

import numpy as np
from scipy.linalg import solveh_banded

from cobot_lfd.arrays import Array
from cobot_lfd.learning.product import symmetric
from cobot_lfd.learning.product.information import Information


def track(information: Information, weight: float) -> Array:
    """The minimum of the mean of (x - mu)' Sigma^-1 (x - mu) plus ``weight`` times the integral of |x'''|².

    Known as linear-quadratic tracking. The axes of one time stand next to each other, so that the matrix is
    banded and one banded Cholesky solution serves a scene. Whole covariances are used, so the result moves
    with the scene.

    Args:
        information: Gaussians over T equally spaced times.
        weight: Penalty on jerk, time running from 0 to 1.

    Returns:
        Positions [m], shape (S, d, T).
    """
    s, d, t = information.weighted.shape
    jerk = _jerk_bands(t) * weight
    bands = np.zeros((s, 3 * d + 1, t * d))
    for lag in range(4):
        # Row r of the lower form holds entry (i + r, i); lags of one step are d rows apart.
        bands[:, lag * d, :] = np.repeat(jerk[lag], d)
    for i in range(d):
        for j in range(i, d):
            entries = information.precision[:, symmetric.entry(d, i, j)] / t
            bands[:, j - i, i::d] += entries
    right = np.swapaxes(information.weighted, 1, 2).reshape(s, t * d) / t
    solved = [solveh_banded(b, r, lower=True, check_finite=False) for b, r in zip(bands, right, strict=True)]
    return np.swapaxes(np.stack(solved).reshape(s, t, d), 1, 2)


def _jerk_bands(n_steps: int) -> Array:
    """Lower bands of the matrix whose form is the mean squared third difference quotient, (4, T)."""
    difference = np.diff(np.eye(n_steps), n=3, axis=0) * (n_steps - 1) ** 3
    matrix = difference.T @ difference / n_steps
    return np.stack([np.append(np.diag(matrix, -lag), np.zeros(lag)) for lag in range(4)])
