"""Responsibilities shared between demonstrations."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from cobot_lfd.arrays import Array
from cobot_lfd.learning.mixtures.sharing import SharedQuantity, Sharing, share, smooth_over_time


def log_joint(seed: int) -> Array:
    return np.random.default_rng(seed).normal(0, 5, (3 * 20, 4))


def softmax(values: Array) -> Array:
    exponential = np.exp(values - values.max(axis=1, keepdims=True))
    return np.asarray(exponential / exponential.sum(axis=1, keepdims=True))


@given(st.integers(0, 99), st.sampled_from(SharedQuantity), st.floats(0, 1), st.integers(0, 8))
def test_shared_responsibilities_sum_to_one(
    seed: int, quantity: SharedQuantity, strength: float, half_width: int
) -> None:
    shared = share(log_joint(seed), 3, Sharing(strength, half_width, quantity))
    assert_allclose(shared.sum(axis=1), 1.0, rtol=1e-12)
    assert (shared >= 0).all()


@pytest.mark.parametrize("quantity", list(SharedQuantity))
def test_strength_zero_leaves_plain_responsibilities(quantity: SharedQuantity) -> None:
    assert_allclose(share(log_joint(0), 3, Sharing(0.0, 5, quantity)), softmax(log_joint(0)), rtol=1e-10)


def test_strength_one_gives_all_demonstrations_the_same() -> None:
    shared = share(log_joint(0), 3, Sharing(1.0, 4)).reshape(3, 20, 4)
    assert_allclose(shared[0], shared[1], atol=1e-14)
    assert_allclose(shared[0], shared[2], atol=1e-14)


def test_strength_one_without_kernel_is_the_mean() -> None:
    shared = share(log_joint(0), 3, Sharing(1.0, 0)).reshape(3, 20, 4)
    assert_allclose(shared[0], softmax(log_joint(0)).reshape(3, 20, 4).mean(axis=0), rtol=1e-10)


@given(st.integers(0, 9))
def test_averaging_over_time_keeps_constants_also_at_the_ends(half_width: int) -> None:
    """The paper's zero padding would let the ends fade."""
    assert_allclose(smooth_over_time(np.full((12, 2), 0.3), half_width), 0.3, rtol=1e-12)


def test_the_kernel_is_the_papers_triangle() -> None:
    """For S = 3: [0.25, 0.5, 0.75, 1, 0.75, 0.5, 0.25], divided by its mass 4 (eqs. 13-14)."""
    impulse = np.zeros((21, 1))
    impulse[10] = 1.0
    smooth = smooth_over_time(impulse, 3)
    assert_allclose(smooth[7:14, 0], np.array([0.25, 0.5, 0.75, 1, 0.75, 0.5, 0.25]) / 4, rtol=1e-12)


def test_a_strength_beyond_one_is_refused() -> None:
    with pytest.raises(ValueError, match=r"strength is 1.5; it must lie in 0..1"):
        Sharing(strength=1.5)
