"""Expectation maximisation for a mixture shared by frames, in log space (paper, section 3.2).

Both steps are one matrix product each: the log density of a Gaussian is linear in the features
[1, z, vech(z z')] of a point, and the sums that the maximisation needs are the features' averages. Frames are
stacked side by side, so that the product of their densities (paper, eq. 6) is the same matrix product.
"""

import warnings
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2

from cobot_lfd.arrays import Array
from cobot_lfd.learning.mixtures.mixture import Mixture
from cobot_lfd.learning.mixtures.sharing import Sharing, share


@dataclass(frozen=True, slots=True)
class EMSettings:
    """How a mixture is fitted; names and meanings as in scikit-learn where it has them.

    Attributes:
        n_components: Number of Gaussians K.
        tol: Gain of the mean log-likelihood per point below which the fit has converged.
        max_iter: Limit for the number of iterations.
        reg_covar: Added to the covariances' diagonals, in units of the data's mean square size, so that the
            result does not depend on the unit of length.
        init: "time" splits each path into K equal spans, "kmeans" clusters the points of [t, x].
        n_init: Number of starts with "kmeans"; the likeliest is kept.
        sharing: Exchange of responsibilities between demonstrations; None is plain EM.
    """

    n_components: int = 4
    tol: float = 1e-4
    max_iter: int = 200
    reg_covar: float = 1e-6
    init: str = "time"
    n_init: int = 1
    sharing: Sharing | None = None

    def __post_init__(self) -> None:
        """Check."""
        if self.n_components < 1:
            raise ValueError(f"n_components is {self.n_components}; it must be at least 1.")
        if self.init not in ("time", "kmeans"):
            raise ValueError(f"init is '{self.init}'; choose one of: time, kmeans.")
        if self.max_iter < 1 or self.n_init < 1:
            raise ValueError("max_iter and n_init must be at least 1.")
        if self.tol < 0 or self.reg_covar < 0:
            raise ValueError("tol and reg_covar must not be negative.")


@dataclass(frozen=True, slots=True, eq=False)
class EMFit:
    """A fitted mixture, and how the fit went.

    Attributes:
        mixture: The mixture.
        log_likelihood: Mean log-likelihood per point before each update, in the data's own units.
        converged: Whether the last gain was below ``tol``.
    """

    mixture: Mixture
    log_likelihood: Array
    converged: bool

    @property
    def n_iterations(self) -> int:
        """Number of updates made."""
        return len(self.log_likelihood)


def fit_mixture(
    points: Array, times: Array, settings: EMSettings, rng: np.random.Generator | None = None
) -> EMFit:
    """Fit a mixture jointly to all frames and demonstrations.

    Args:
        points: Paths as seen from each frame [m], shape (N, J, T, d).
        times: Normalised times, shape (T,).
        settings: The settings.
        rng: For ``init="kmeans"``; a fixed one if None.

    Raises:
        ValueError: If there are fewer points than the components need.
    """
    n, _, t, d = points.shape
    if n * t < settings.n_components * (d + 2):
        raise ValueError(
            f"{n * t} points are too few for {settings.n_components} components of dimension {d + 1}; "
            "lower n_components or record more samples."
        )
    rng = np.random.default_rng(0) if rng is None else rng
    whitened, centre, scale = _whiten(points, times)
    starts = settings.n_init if settings.init == "kmeans" else 1
    fits = [_climb(whitened, _initial(whitened, n, settings, rng), n, settings) for _ in range(starts)]
    best = max(fits, key=lambda fit: fit.log_likelihood[-1])
    _warn_of_collapse(best, settings)
    return _restore(best, centre, scale)


def expect(mixture: Mixture, features: Array) -> Array:
    """Logarithm of weight times density for each point and component, shape (M, K) (paper, eqs. 6-7)."""
    return np.asarray(features @ _coefficients(mixture))


def maximise(responsibilities: Array, features: Array, n_frames: int, reg_covar: float) -> Mixture:
    """Weights, means and covariances that fit the responsibilities best (paper, eqs. 8-10)."""
    k = responsibilities.shape[1]
    mass = responsibilities.sum(axis=0) + 10 * np.finfo(float).tiny
    averages = ((responsibilities.T @ features) / mass[:, None]).reshape(k, n_frames, -1)
    size = _dimension(averages.shape[-1])
    means = averages[..., 1 : 1 + size]
    second = averages[..., 1 + size :][..., _entries(size)]
    covariances = second - means[..., :, None] * means[..., None, :]
    covariances[..., np.arange(size), np.arange(size)] += reg_covar
    return Mixture(mass / mass.sum(), means, covariances)


def quadratic_features(z: Array) -> Array:
    """[1, z, vech(z z')] of each frame side by side: (M, J, D) -> (M, J F)."""
    m, j, size = z.shape
    rows, columns = np.triu_indices(size)
    out = np.empty((m, j, 1 + size + len(rows)))
    out[..., 0] = 1.0
    out[..., 1 : 1 + size] = z
    np.multiply(z[..., rows], z[..., columns], out=out[..., 1 + size :])
    return out.reshape(m, -1)


def _climb(z: Array, responsibilities: Array, n: int, settings: EMSettings) -> EMFit:
    """Alternate the two steps until the likelihood no longer gains."""
    features = quadratic_features(z)
    mixture = maximise(responsibilities, features, z.shape[1], settings.reg_covar)
    trace: list[float] = []
    converged = False
    for _ in range(settings.max_iter):
        log_joint = expect(mixture, features)
        responsibilities, log_likelihood = _posterior(log_joint)
        trace.append(log_likelihood)
        if settings.sharing is not None:
            responsibilities = share(log_joint, n, settings.sharing)
        mixture = maximise(responsibilities, features, z.shape[1], settings.reg_covar)
        if len(trace) > 1 and abs(trace[-1] - trace[-2]) < settings.tol:
            converged = True
            break
    return EMFit(mixture, np.array(trace), converged)


def _posterior(log_joint: Array) -> tuple[Array, float]:
    """Responsibilities, and the mean log-likelihood per point."""
    peak = log_joint.max(axis=1, keepdims=True)
    joint = np.exp(log_joint - peak)
    total = joint.sum(axis=1, keepdims=True)
    joint /= total
    return joint, float((np.log(total) + peak).mean())


def _coefficients(mixture: Mixture) -> Array:
    """The log joint density as a linear function of the features, shape (J F, K)."""
    k, _, size = mixture.means.shape
    precision = np.linalg.inv(mixture.covariances)
    linear = (precision @ mixture.means[..., None])[..., 0]
    _, log_determinant = np.linalg.slogdet(mixture.covariances)
    constant = -0.5 * ((linear * mixture.means).sum(-1) + log_determinant + size * np.log(2 * np.pi))
    constant[:, 0] += np.log(mixture.weights)
    rows, columns = np.triu_indices(size)
    quadratic = precision[..., rows, columns] * np.where(rows == columns, -0.5, -1.0)
    return np.concatenate([constant[..., None], linear, quadratic], axis=-1).reshape(k, -1).T


def _whiten(points: Array, times: Array) -> tuple[Array, Array, Array]:
    """Points [t, x] centred and scaled per frame, shape (N T, J, 1 + d), with the centres and the scales.

    One scale serves all directions of a frame, so that turning the frame's axes turns the result.
    """
    n, j, t, d = points.shape
    z = np.empty((n, t, j, 1 + d))
    z[..., 0] = times[None, :, None]
    z[..., 1:] = np.moveaxis(points, 1, 2)
    flat = z.reshape(n * t, j, 1 + d)
    centre = flat.mean(axis=0)
    flat = flat - centre
    variance = (flat**2).mean(axis=0)
    scale = np.empty_like(centre)
    scale[:, 0] = np.sqrt(variance[:, 0])
    scale[:, 1:] = np.sqrt(variance[:, 1:].mean(axis=1, keepdims=True))
    scale = np.where(scale > 1e-12, scale, 1.0)
    return flat / scale, centre, scale


def _restore(fit: EMFit, centre: Array, scale: Array) -> EMFit:
    """The same mixture in the data's own units."""
    mixture = Mixture(
        fit.mixture.weights,
        fit.mixture.means * scale + centre,
        fit.mixture.covariances * scale[:, :, None] * scale[:, None, :],
    )
    return EMFit(mixture, fit.log_likelihood - np.log(scale).sum(), fit.converged)


def _initial(z: Array, n: int, settings: EMSettings, rng: np.random.Generator) -> Array:
    """Responsibilities of 0 or 1 to start with, shape (N T, K)."""
    k = settings.n_components
    if settings.init == "time":
        t = len(z) // n
        labels: NDArray[np.intp] = np.tile((np.arange(t) * k) // t, n)
    else:
        flat = np.concatenate([z[:, :1, 0], z[..., 1:].reshape(len(z), -1)], axis=1)
        _, labels = kmeans2(flat, k, minit="++", rng=rng)
    return np.asarray(np.eye(k)[labels])


def _warn_of_collapse(fit: EMFit, settings: EMSettings) -> None:
    """Say so when a component has shrunk to a point or lost its share."""
    smallest = np.linalg.eigvalsh(fit.mixture.covariances).min(axis=(1, 2))
    lost = fit.mixture.weights < 1e-3 / settings.n_components
    collapsed = np.flatnonzero((smallest < 1.01 * settings.reg_covar) & (settings.reg_covar > 0) | lost)
    if len(collapsed):
        warnings.warn(
            f"component(s) {', '.join(map(str, collapsed))} of {settings.n_components} have collapsed; "
            f"lower n_components, raise reg_covar (now {settings.reg_covar:g}) or vary the demonstrations.",
            stacklevel=3,
        )


@cache
def _entries(size: int) -> NDArray[np.intp]:
    """Where each matrix entry stands among the packed ones, shape (D, D)."""
    out = np.empty((size, size), dtype=np.intp)
    rows, columns = np.triu_indices(size)
    out[rows, columns] = out[columns, rows] = np.arange(len(rows))
    return out


def _dimension(n_features: int) -> int:
    """D, given that there are 1 + D + D (D + 1) / 2 features."""
    return int((np.sqrt(9 + 8 * (n_features - 1)) - 3) / 2)
