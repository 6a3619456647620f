"""The path as a sum of vectors of the scene, whose shares vary smoothly along the task.

The product of the frames' Gaussians (paper, eq. 11) is, where their covariances are round,

    x(u) = sum_j w_j(u) b_j + A_j m_j(u) + r_j(u) d_j,   sum_j w_j = 1,

with w_j the share of frame j's precision, m_j that share of its mean for an oriented frame (origin b_j,
axes A_j), and r_j that share of the radius of a ring that looks in direction d_j. The shares do not depend
on the scene. So they need not be guessed from the covariances of each frame by itself: they are regressed
on the demonstrations jointly, with a penalty on the curves' jerk and on their size. Time is replaced by
phase.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh
from scipy.ndimage import gaussian_filter1d

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course.features import FeatureSet, scene_features
from cobot_lfd.learning.course.splines import even_basis, fine_derivative, roughness_penalty
from cobot_lfd.learning.data import Scenes

N_FUNCTIONS = 36
"""Spline functions along the task: enough for features of 3 % of the way."""
SIZE_WEIGHTS = (1e-4, 1e-2, 1e-1)
"""Penalties on size that are tried, in units of the median variance; leave-one-out chooses."""
TOLERANCE = 0.05
"""Of penalties whose scores differ by less, the strongest on roughness is taken."""
FLOOR = 4e-3
"""Smallest standard deviation that a residual is believed to have, in units of the task's size."""
END_TRUST = 200.0
"""How many points' worth the first and the last point are: a pick or a place is where a path is exact."""
STRAIGHT_ROUNDS = 2
"""How often the penalty on bends is adapted to where the path bends."""
STRAIGHT_FLOOR = 0.01
"""How far the penalty may fall where the path bends most, relative to the mean."""


@dataclass(frozen=True, slots=True)
class Roughness:
    """What is smooth: which derivative is penalised, and how strongly.

    Attributes:
        derivative: 2 penalises bends, 3 jerk.
        weights: Strengths that are tried; leave-one-out chooses.
        adaptive: Whether the penalty is moved to where the path does not bend, so that straight parts become
            straight and bends stay.
    """

    derivative: int
    weights: tuple[float, ...]
    adaptive: bool


MINIMUM_JERK = Roughness(3, tuple(10.0**e for e in range(-9, -2)), adaptive=False)
STRAIGHT_PARTS = Roughness(2, tuple(10.0**e for e in range(-6, 1)), adaptive=True)


@dataclass(frozen=True, slots=True, eq=False)
class SceneRegression:
    """The fitted shares.

    Attributes:
        features: Which vectors the path is made of.
        coefficients: Spline coefficients of each vector's share, shape (F, B).
        inverse: Inverse of the penalised second moments of the vectors, shape (F, F) [1/m²].
        variance: Variance of the residuals along the task, per axis [m²], shape (U,).
        held_out: Residuals of each demonstration predicted from the others [m], shape (N, d, U).
        rough_weight: The chosen penalty on roughness.
        size_weight: The chosen penalty on size.
    """

    features: FeatureSet
    coefficients: Array
    inverse: Array
    variance: Array
    held_out: Array
    rough_weight: float
    size_weight: float

    def predict(self, scenes: Scenes) -> Array:
        """Positions along the task [m], shape (S, U, d)."""
        vectors = scene_features(scenes, self.features)
        shares = self.coefficients @ even_basis(self.coefficients.shape[1], len(self.variance)).T
        return np.swapaxes(vectors @ shares, 1, 2) + scenes.positions[:, None, 0]

    def spread(self, scenes: Scenes) -> Array:
        """Factor on the residual variance for scenes unlike the demonstrated ones, shape (S, d, d)."""
        vectors = scene_features(scenes, self.features)
        return np.asarray(np.eye(vectors.shape[1]) + vectors @ self.inverse @ np.swapaxes(vectors, 1, 2))

    def spread_after(self, scenes: Scenes) -> Array:
        """Mean variance factor over the scenes if one of them were demonstrated next, shape (S,)."""
        vectors = scene_features(scenes, self.features)
        second = np.swapaxes(vectors, 1, 2) @ vectors
        after = np.linalg.inv(np.linalg.inv(self.inverse) + second)
        return np.asarray(np.einsum("sfg,gf->s", after, second.mean(axis=0)))

    @property
    def score(self) -> float:
        """Mean logarithm of the held-out mean square along the task; smaller is better."""
        floor = (FLOOR * self.features.unit) ** 2
        return float(np.log((self.held_out**2).mean(axis=(0, 1)) + floor).mean())


@dataclass(frozen=True, slots=True, eq=False)
class _Problem:
    """The demonstrations in units of the task's size."""

    vectors: Array  # (N, d, F)
    targets: Array  # (N, d, U)
    basis: Array  # (U, B)
    moments: Array  # (N, F, F)


@dataclass(frozen=True, slots=True, eq=False)
class _Candidate:
    """One choice of penalties, and how it predicts what was left out."""

    score: float
    rough_weight: float
    size_weight: float
    coefficients: Array
    residuals: Array


def fit_scene_regression(
    paths: Array, scenes: Scenes, features: FeatureSet, roughness: Roughness = MINIMUM_JERK
) -> SceneRegression:
    """Regress paths told by phase on the vectors of their scenes.

    Both penalties are chosen by leaving each demonstration out in turn. The first round takes all parts of
    the task for equally sure; the second weighs them by how well the first predicted them.

    Args:
        paths: Positions at equally spaced phases [m], shape (N, U, d).
        scenes: The N scenes.
        features: Which vectors to use.
        roughness: What is smooth.
    """
    problem = _problem(paths, scenes, features)
    penalty = roughness_penalty(N_FUNCTIONS, roughness.derivative)
    best = _best(problem, _with_sure_ends(np.full(paths.shape[1], (5 * FLOOR) ** 2)), penalty, roughness)
    best = _best(problem, _with_sure_ends(_residual_variance(best.residuals)), penalty, roughness)
    for _ in range(STRAIGHT_ROUNDS if roughness.adaptive else 0):
        penalty = _adapted_penalty(best.coefficients, roughness.derivative)
        best = _best(problem, _with_sure_ends(_residual_variance(best.residuals)), penalty, roughness)
    n_vectors = problem.vectors.shape[2]
    moments = problem.moments.sum(axis=0) + max(best.size_weight, 1e-3) * np.eye(n_vectors)
    return SceneRegression(
        features,
        best.coefficients,
        np.linalg.inv(moments) / features.unit**2,
        _residual_variance(best.residuals) * features.unit**2,
        best.residuals * features.unit,
        best.rough_weight,
        best.size_weight,
    )


def _problem(paths: Array, scenes: Scenes, features: FeatureSet) -> _Problem:
    """Scale, and gather what does not depend on the penalties."""
    vectors = scene_features(scenes, features) / features.unit
    targets = np.swapaxes(paths - scenes.positions[:, None, 0], 1, 2) / features.unit
    moments = np.swapaxes(vectors, 1, 2) @ vectors
    return _Problem(vectors, targets, even_basis(N_FUNCTIONS, paths.shape[1]), moments)


def _best(problem: _Problem, variance: Array, penalty: Array, roughness: Roughness) -> _Candidate:
    """The penalties that predict best what was left out; of nearly equal ones, the smoothest."""
    candidates = [
        _candidate(problem, variance, penalty, rough, size)
        for rough in roughness.weights
        for size in SIZE_WEIGHTS
    ]
    if len(problem.vectors) == 1:
        return candidates[0]  # With nothing to leave out, the one demonstration is followed.
    limit = min(candidate.score for candidate in candidates) + TOLERANCE
    return max((c for c in candidates if c.score <= limit), key=lambda c: (c.rough_weight, -c.score))


def _candidate(problem: _Problem, variance: Array, penalty: Array, rough: float, size: float) -> _Candidate:
    """Solve for all demonstrations, and for all but one.

    In the generalised eigenvectors V of penalty and data weight the curves' coefficients decouple into one
    small system per eigenvector, whose matrix is the sum of second moments and of the eigenvalue.
    """
    n_phases = len(variance)
    weighted = problem.basis / variance[:, None] / n_phases
    total_penalty = (rough * penalty + size * problem.basis.T @ problem.basis / n_phases) / np.median(
        variance
    )
    values, vectors = eigh(total_penalty, problem.basis.T @ weighted)
    own = np.swapaxes(problem.vectors, 1, 2) @ (problem.targets @ (weighted @ vectors))
    ridge = np.maximum(values, 1e-9)[:, None, None] * np.eye(problem.vectors.shape[2])
    total, moments = own.sum(axis=0), problem.moments.sum(axis=0)

    def solve(matrix: Array, right: Array) -> Array:
        solution = np.linalg.solve(matrix[..., None, :, :] + ridge, np.swapaxes(right, -1, -2)[..., None])
        return np.asarray(np.swapaxes(solution[..., 0], -1, -2) @ vectors.T)

    left_out = solve(moments - problem.moments, total - own)
    residuals = problem.targets - problem.vectors @ (left_out @ problem.basis.T)
    score = float(np.log((residuals**2).mean(axis=(0, 1)) + FLOOR**2).mean())
    return _Candidate(score, rough, size, solve(moments, total), residuals)


def _adapted_penalty(coefficients: Array, derivative: int) -> Array:
    """A penalty that is weak where the curves are rough and strong where they are not."""
    values = fine_derivative(N_FUNCTIONS, derivative)
    rough = ((values @ coefficients.T) ** 2).sum(axis=1)
    rough = gaussian_filter1d(rough, 0.02 * len(rough), mode="nearest")
    weights = 1.0 / (rough + STRAIGHT_FLOOR * rough.mean() + np.finfo(float).tiny)
    return roughness_penalty(N_FUNCTIONS, derivative, weights / weights.mean())


def _with_sure_ends(variance: Array) -> Array:
    """The variance with more weight on the very ends, which no other point holds in place."""
    sure = variance.copy()
    sure[[0, -1]] /= END_TRUST
    return sure


def _residual_variance(residuals: Array) -> Array:
    """Variance along the task, smoothed and kept above the floor."""
    raw = (residuals**2).mean(axis=(0, 1))
    return np.asarray(gaussian_filter1d(raw, 0.015 * len(raw), mode="nearest") + FLOOR**2)
