"""Expectation maximisation: theory's promises, and agreement with scikit-learn."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.stats import multivariate_normal
from sklearn.mixture import GaussianMixture

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import collect
from cobot_lfd.learning.experiments.synthetic import TASKS, demonstrations
from cobot_lfd.learning.mixtures.em import EMFit, EMSettings, expect, fit_mixture, quadratic_features
from cobot_lfd.learning.mixtures.mixture import Mixture


def example(seed: int = 0) -> tuple[Array, Array]:
    data = collect(demonstrations(TASKS[2], 5, np.random.default_rng(seed), n_steps=120))
    return data.local, data.times


def stacked(points: Array, times: Array) -> Array:
    """[t, points of all frames] of every sample, as scikit-learn wants it."""
    n, j, t, d = points.shape
    flat = np.moveaxis(points, 1, 2).reshape(n * t, j * d)
    return np.concatenate([np.tile(times, n)[:, None], flat], axis=1)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 1000), st.integers(1, 6))
def test_plain_em_never_lowers_the_likelihood(seed: int, n_components: int) -> None:
    points, times = example(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fit = fit_mixture(points, times, EMSettings(n_components, tol=0, max_iter=40, reg_covar=0))
    assert (np.diff(fit.log_likelihood) > -1e-9).all()


def reached(points: Array, times: Array, n_components: int) -> EMFit:
    return fit_mixture(points, times, EMSettings(n_components, tol=1e-10, max_iter=3000, reg_covar=0))


def test_one_frame_gives_scikit_learns_optimum() -> None:
    """Same data, same start: the same weights, means, covariances and likelihood."""
    points, times = example()
    ours = reached(points[:, :1], times, 3)
    data = stacked(points[:, :1], times)
    start = np.tile(np.arange(len(times)) * 3 // len(times), len(points))
    parts = [data[start == k] for k in range(3)]
    theirs = GaussianMixture(
        3,
        tol=1e-12,
        max_iter=3000,
        reg_covar=0,
        weights_init=[len(p) / len(data) for p in parts],
        means_init=[p.mean(axis=0) for p in parts],
        precisions_init=[np.linalg.inv(np.cov(p.T, bias=True)) for p in parts],
    ).fit(data)
    assert_allclose(ours.mixture.weights, theirs.weights_, atol=1e-4)
    assert_allclose(ours.mixture.means[:, 0], theirs.means_, atol=1e-4)
    assert_allclose(ours.mixture.covariances[:, 0], theirs.covariances_, atol=1e-4)
    assert ours.log_likelihood[-1] == pytest.approx(theirs.score(data), abs=1e-6)


def test_the_log_joint_is_the_sum_of_the_frames_log_densities() -> None:
    rng = np.random.default_rng(1)
    roots = rng.normal(size=(3, 2, 3, 3))
    mixture = Mixture(np.full(3, 1 / 3), rng.normal(size=(3, 2, 3)), roots @ np.swapaxes(roots, -1, -2))
    z = rng.normal(size=(7, 2, 3))
    expected = np.log(1 / 3) + sum(
        np.stack([multivariate_normal(mixture.means[k, j], mixture.covariances[k, j]).logpdf(z[:, j])
                  for k in range(3)], axis=1)
        for j in range(2)
    )  # fmt: skip
    assert_allclose(expect(mixture, quadratic_features(z)), expected, rtol=1e-8)


def test_turning_a_frames_axes_turns_its_gaussians() -> None:
    points, times = example()
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    first = fit_mixture(points, times, EMSettings(3)).mixture
    second = fit_mixture(points @ turn.T, times, EMSettings(3)).mixture
    assert_allclose(second.means[..., 1:], first.means[..., 1:] @ turn.T, atol=1e-8)


@given(st.floats(1e-3, 1e3))
@settings(max_examples=10, deadline=None)
def test_the_unit_of_length_does_not_matter(unit: float) -> None:
    points, times = example()
    first = fit_mixture(points, times, EMSettings(3))
    second = fit_mixture(points * unit, times, EMSettings(3))
    assert second.n_iterations == first.n_iterations
    assert_allclose(
        second.mixture.means[..., 1:], first.mixture.means[..., 1:] * unit, rtol=1e-6, atol=1e-9 * unit
    )


def test_32_frames_and_a_far_outlier_do_not_underflow() -> None:
    points, times = example()
    many = np.repeat(points, 16, axis=1)
    many[0, :, 50] += 1e4
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fit = fit_mixture(many, times, EMSettings(3, max_iter=20))
    assert np.isfinite(fit.log_likelihood).all()
    assert np.isfinite(fit.mixture.means).all()


def test_k_means_gives_the_same_result_for_the_same_generator() -> None:
    points, times = example()
    chosen = EMSettings(3, init="kmeans", n_init=2)
    fits = [fit_mixture(points, times, chosen, np.random.default_rng(7)) for _ in range(2)]
    assert_allclose(fits[0].mixture.means, fits[1].mixture.means, atol=0)
    assert fits[0].log_likelihood[-1] > fits[0].log_likelihood[0]


def test_a_collapsed_component_is_told_with_the_remedy() -> None:
    points, times = example()
    same = np.repeat(np.zeros_like(points[:1]), 5, axis=0)
    with pytest.warns(UserWarning, match="collapsed; lower n_components, raise reg_covar"):
        fit_mixture(same, times, EMSettings(3))


def test_too_few_points_are_refused() -> None:
    with pytest.raises(ValueError, match="10 points are too few for 4 components"):
        fit_mixture(np.zeros((1, 1, 10, 2)), np.linspace(0, 1, 10), EMSettings(4))


def test_an_unknown_initialisation_is_refused_with_the_choices() -> None:
    with pytest.raises(ValueError, match="choose one of: time, kmeans"):
        EMSettings(init="random")
