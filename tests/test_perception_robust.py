"""The spread of errors is told by their median, and what is far off does not count."""

import numpy as np
import pytest
from scipy.stats import median_abs_deviation

from perception.robust import robust_deviation, tukey_weights


@pytest.mark.parametrize("shape", [(1,), (2,), (7,), (100,), (9, 4)])
def test_the_deviation_is_scipys_about_zero(shape: tuple[int, ...]) -> None:
    errors = np.random.default_rng(0).normal(scale=3.0, size=shape)
    of_scipy = median_abs_deviation(np.concatenate([errors, -errors], axis=None), scale="normal")
    assert robust_deviation(errors) == pytest.approx(of_scipy, rel=1e-3)


def test_outliers_change_neither_the_deviation_nor_the_result() -> None:
    errors = np.random.default_rng(1).normal(size=1001)
    spoilt = np.concatenate([errors, np.full(100, 1e6)])
    assert robust_deviation(spoilt) == pytest.approx(robust_deviation(errors), rel=0.3)
    weights = tukey_weights(spoilt, robust_deviation(spoilt))
    assert (weights[-100:] == 0.0).all()
    assert (tukey_weights(np.zeros(3), 1.0) == 1.0).all()
