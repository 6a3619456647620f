"""Packed symmetric matrices against numpy's whole ones."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import special_ortho_group

from cobot_lfd.arrays import Array
from cobot_lfd.learning.product import symmetric


def matrices(d: int) -> Array:
    roots = np.random.default_rng(d).normal(size=(4, 6, d, d))
    return np.asarray(roots @ np.swapaxes(roots, -1, -2) + 0.1 * np.eye(d))


@pytest.mark.parametrize("d", [1, 2, 3])
def test_unpacking_undoes_packing(d: int) -> None:
    assert_allclose(symmetric.unpack(symmetric.pack(matrices(d)), d), matrices(d))


@pytest.mark.parametrize("d", [1, 2, 3])
def test_inverses_are_numpys(d: int) -> None:
    inverse = symmetric.inverse(symmetric.pack(matrices(d)), d)
    assert_allclose(symmetric.unpack(inverse, d), np.linalg.inv(matrices(d)), rtol=1e-8)


@pytest.mark.parametrize("d", [2, 3])
def test_the_rotation_map_turns_the_matrix(d: int) -> None:
    rotation = special_ortho_group(d, seed=1).rvs()
    turned = symmetric.rotation_map(rotation) @ symmetric.pack(matrices(d))
    assert_allclose(symmetric.unpack(turned, d), rotation @ matrices(d) @ rotation.T, atol=1e-12)


@pytest.mark.parametrize("d", [1, 2, 3])
def test_times_vector_is_the_matrix_product(d: int) -> None:
    vectors = np.random.default_rng(0).normal(size=(4, d, 6))
    expected = np.einsum("stij,sjt->sit", matrices(d), vectors)
    assert_allclose(symmetric.times_vector(symmetric.pack(matrices(d)), vectors), expected, atol=1e-12)
