"""A Gaussian mixture shared by several frames, and regression with it.

Component k has one weight for all frames and one Gaussian of [t, x] per frame (paper, section 3.1).
"""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array


@dataclass(frozen=True, slots=True, eq=False)
class Mixture:
    """K Gaussians of [t, x] in each of J frames, with shared weights.

    Attributes:
        weights: Share of each component, shape (K,).
        means: Shape (K, J, 1 + d); time is normalised, positions are in the frame's axes [m].
        covariances: Shape (K, J, 1 + d, 1 + d).
    """

    weights: Array
    means: Array
    covariances: Array


def regress(mixture: Mixture, times: Array) -> tuple[Array, Array]:
    """Gaussian mixture regression of the position on time, in each frame (paper, section 3.3).

    The mixture of the components' conditionals is replaced by the Gaussian with the same moments.

    Args:
        mixture: The mixture.
        times: Normalised times, shape (T,).

    Returns:
        Means [m], shape (J, T, d), and covariances [m²], shape (J, T, d, d).
    """
    shares = _activations(mixture, times)
    time_variance = mixture.covariances[:, :, 0, 0]
    slopes = mixture.covariances[:, :, 1:, 0] / time_variance[..., None]
    conditional = mixture.covariances[:, :, 1:, 1:] - (
        slopes[..., :, None] * mixture.covariances[:, :, 0, None, 1:]
    )
    offsets = times[None, None] - mixture.means[:, :, :1]
    centres = mixture.means[:, :, None, 1:] + slopes[:, :, None] * offsets[..., None]
    mean = np.einsum("tk,kjtd->jtd", shares, centres)
    spread = centres - mean
    covariance = np.einsum("tk,kjab->jtab", shares, conditional)
    return mean, covariance + np.einsum("tk,kjta,kjtb->jtab", shares, spread, spread)


def _activations(mixture: Mixture, times: Array) -> Array:
    """Posterior share of each component given the time alone, shape (T, K)."""
    variance = mixture.covariances[:, 0, 0, 0]
    log_density = -0.5 * ((times[:, None] - mixture.means[:, 0, 0]) ** 2 / variance + np.log(variance))
    log_share = log_density + np.log(mixture.weights)
    share = np.exp(log_share - log_share.max(axis=1, keepdims=True))
    return np.asarray(share / share.sum(axis=1, keepdims=True))
