"""Local linear regression over time: the limit of many Gaussians that all demonstrations share.

With responsibilities shared fully between demonstrations (gamma = 1 in the paper's eq. 15) and more and more,
narrower components, Gaussian mixture regression on time becomes a weighted linear fit around each time.
"""

import numpy as np

from cobot_lfd.arrays import Array


def local_linear_weights(times: Array, at: Array, width: float) -> Array:
    """Weights with which samples at ``times`` make up the local linear fit at ``at``, shape (T', T).

    Args:
        times: Normalised times of the samples, shape (T,).
        at: Where the fit is wanted, shape (T',).
        width: Standard deviation of the Gaussian kernel, in units of the path's duration.
    """
    offset = times[None] - at[:, None]
    kernel = np.exp(-0.5 * (offset / width) ** 2)
    s0, s1, s2 = (np.sum(kernel * offset**power, axis=1, keepdims=True) for power in (0, 1, 2))
    weights = kernel * (s2 - offset * s1)
    return np.asarray(weights / (s0 * s2 - s1**2))


def kernel_weights(times: Array, at: Array, width: float) -> Array:
    """Weights of the local average, never negative, shape (T', T)."""
    kernel = np.exp(-0.5 * ((times[None] - at[:, None]) / width) ** 2)
    return np.asarray(kernel / kernel.sum(axis=1, keepdims=True))


def kernel_statistics(paths: Array, linear: Array, average: Array) -> tuple[Array, Array]:
    """Mean and covariance between demonstrations at each time.

    The mean is the local linear fit; the covariance is that of the demonstrations' own smoothed paths about
    it (divided by N - 1), plus the noise that smoothing took out.

    Args:
        paths: One sort of local path per demonstration, shape (N, ..., T, d).
        linear: Weights of the local linear fit, shape (T', T).
        average: Weights of the local average, shape (T', T).

    Returns:
        Mean, shape (..., T', d), and covariance, shape (..., T', d, d).
    """
    smooth = linear @ paths
    mean = smooth.mean(axis=0)
    spread = smooth - mean
    n = len(paths)
    between = np.einsum("n...a,n...b->...ab", spread, spread) / max(n - 1, 1)
    residual = paths - smooth if smooth.shape == paths.shape else paths - _own_fit(paths, linear)
    noise = np.einsum("n...a,n...b->...ab", residual, residual) / n
    flat = noise.reshape(*noise.shape[:-2], -1)
    noise = (average @ flat).reshape(between.shape)
    return mean, between + noise


def _own_fit(paths: Array, linear: Array) -> Array:
    """The smoothed paths brought back to the samples' own times by linear interpolation."""
    fit = linear @ paths
    n_at, n_times = linear.shape
    places = np.linspace(0, n_at - 1, n_times)
    low = np.minimum(places.astype(int), n_at - 2)
    share = (places - low)[:, None]
    return np.asarray(fit[..., low, :] * (1 - share) + fit[..., low + 1, :] * share)
