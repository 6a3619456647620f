"""The product of the frames' Gaussians against the textbook formula, and the path that tracks it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import special_ortho_group

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import Scenes
from cobot_lfd.learning.mixtures.profile import Profile
from cobot_lfd.learning.product import symmetric
from cobot_lfd.learning.product.information import Information, oriented_information, ring_information
from cobot_lfd.learning.product.tracking import track

T = 8


def example(d: int) -> tuple[Profile, Scenes]:
    rng = np.random.default_rng(d)
    roots = rng.normal(size=(2, T, d, d))
    covariance = roots @ np.swapaxes(roots, -1, -2) + 0.1 * np.eye(d)
    profile = Profile(
        rng.normal(size=(2, T, d)), covariance, rng.uniform(1, 2, (2, T)), rng.uniform(1, 2, (2, T))
    )
    rotations = special_ortho_group(d, seed=0).rvs(6).reshape(3, 2, d, d)
    return profile, Scenes(rng.normal(size=(3, 2, d)), rotations)


def textbook(profile: Profile, scenes: Scenes) -> tuple[Array, Array]:
    """Eq. (11): precisions add, means are weighted by them."""
    mean = np.einsum("sjab,jtb->sjta", scenes.rotations, profile.mean) + scenes.positions[:, :, None]
    turned = np.einsum("sjab,jtbc,sjdc->sjtad", scenes.rotations, profile.covariance, scenes.rotations)
    precision = np.linalg.inv(turned)
    covariance = np.linalg.inv(precision.sum(axis=1))
    return np.einsum("stab,sjtbc,sjtc->sta", covariance, precision, mean), covariance


@pytest.mark.parametrize("d", [2, 3])
def test_the_product_is_the_textbooks(d: int) -> None:
    profile, scenes = example(d)
    parts = [oriented_information(profile, scenes, j) for j in range(2)]
    mean, covariance = (parts[0] + parts[1]).moments()
    expected_mean, expected_covariance = textbook(profile, scenes)
    assert_allclose(np.swapaxes(mean, 1, 2), expected_mean, atol=1e-9)
    assert_allclose(symmetric.unpack(covariance, d), expected_covariance, atol=1e-9)


@pytest.mark.parametrize("d", [2, 3])
def test_a_ring_alone_stands_at_its_radius(d: int) -> None:
    profile, scenes = example(d)
    directions = np.random.default_rng(1).normal(size=(3, d, T))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    mean, covariance = ring_information(profile, scenes, 0, directions).moments()
    expected = scenes.positions[:, 0, :, None] + profile.radius[0] * directions
    assert_allclose(mean, expected, atol=1e-12)
    round_covariance = profile.radius_variance[0][None, :, None, None] * np.eye(d)
    assert_allclose(symmetric.unpack(covariance, d), np.repeat(round_covariance, 3, axis=0), atol=1e-12)


@pytest.mark.parametrize("d", [2, 3])
def test_tracking_solves_the_dense_least_squares_problem(d: int) -> None:
    profile, scenes = example(d)
    information = oriented_information(profile, scenes, 0)
    weight = 1e-6
    difference = np.diff(np.eye(T), n=3, axis=0) * (T - 1) ** 3
    penalty = np.kron(difference.T @ difference / T, np.eye(d)) * weight
    for s in range(3):
        precision = symmetric.unpack(information.precision[s], d)
        matrix = penalty + sum(np.kron(np.diag(np.eye(T)[t]), precision[t]) for t in range(T)) / T
        expected = np.linalg.solve(matrix, information.weighted[s].T.ravel() / T).reshape(T, d)
        assert_allclose(track(information, weight)[s].T, expected, atol=1e-8)


def test_tracking_without_weight_follows_the_means() -> None:
    profile, scenes = example(2)
    information: Information = oriented_information(profile, scenes, 0)
    assert_allclose(track(information, 1e-18), information.moments()[0], atol=1e-6)
