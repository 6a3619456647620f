"""Gaussian mixture regression: closed forms."""

import numpy as np
from numpy.testing import assert_allclose

from cobot_lfd.learning.mixtures.mixture import Mixture, regress


def test_one_component_regresses_as_least_squares_does() -> None:
    """With one Gaussian the mean is the regression line and the covariance that of its residuals."""
    rng = np.random.default_rng(0)
    times = np.linspace(0, 1, 400)
    points = np.stack([2 * times + rng.normal(0, 0.1, 400), 1 - times**2], axis=1)
    data = np.column_stack([times, points])
    mixture = Mixture(np.ones(1), data.mean(axis=0)[None, None], np.cov(data.T, bias=True)[None, None])
    mean, covariance = regress(mixture, times)
    lines = np.polynomial.polynomial.polyfit(times, points, 1)
    fitted = lines[0] + times[:, None] * lines[1]
    assert_allclose(mean[0], fitted, atol=1e-10)
    assert_allclose(covariance[0, 0], (points - fitted).T @ (points - fitted) / 400, atol=1e-10)


def test_far_from_the_others_a_component_speaks_alone() -> None:
    covariances = np.tile(np.diag([1e-3, 0.01, 0.02]), (2, 1, 1, 1))
    mixture = Mixture(np.array([0.5, 0.5]), np.array([[[0.0, 1, 2]], [[1.0, -1, -2]]]), covariances)
    mean, covariance = regress(mixture, np.array([0.0, 1.0]))
    assert_allclose(mean[0], [[1, 2], [-1, -2]], atol=1e-9)
    assert_allclose(covariance[0, 0], np.diag([0.01, 0.02]), atol=1e-9)


def test_between_two_components_the_moments_are_those_of_the_mixture() -> None:
    """Half way, both count the same: mean in the middle, variance within plus between."""
    covariances = np.tile(np.diag([0.1, 0.01]), (2, 1, 1, 1))
    mixture = Mixture(np.array([0.5, 0.5]), np.array([[[0.0, 1.0]], [[1.0, 3.0]]]), covariances)
    mean, covariance = regress(mixture, np.array([0.5]))
    assert_allclose(mean[0], [[2.0]], atol=1e-12)
    assert_allclose(covariance[0], [[[1.01]]], atol=1e-12)
