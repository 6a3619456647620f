"""The errors of edges that are sampled at points are those that the sampled spectrum predicts."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.arrays import Array
from perception.edge_noise import EdgeNoise, stair_waves

_REACH, _STEP = 2.5, 0.05  # Of the samples across the edge [px].


def edge_offsets(normal: Array, offset: float, places: Array) -> Array:
    """Where an edge ``x . normal = offset`` seems to be at places along it, of a picture sampled at points.

    Between the pixels the picture is interpolated, as the detector does; the offsets are added up across.
    """
    along = np.array([-normal[1], normal[0]])
    across = np.arange(-_REACH + _STEP / 2, _REACH, _STEP)
    points = offset * normal + places[:, None, None] * along + across[:, None] * normal
    corner = np.floor(points)
    x, y = np.moveaxis(points - corner, -1, 0)
    covered = sum(
        ((corner + np.array([i, j])) @ normal < offset) * np.abs(1 - i - x) * np.abs(1 - j - y)
        for i in (0, 1)
        for j in (0, 1)
    )
    return np.asarray(np.sum(covered, axis=1) * _STEP - _REACH)


@pytest.mark.parametrize("degrees", [1.0, 2.0, 5.0, 26.6, 44.0, 45.3, 46.5])
def test_stairs_hang_together_along_an_edge_as_sampling_makes_them(degrees: float) -> None:
    """The covariance over a distance that leaves short waves out is the one of edges with random phases."""
    normal = np.array([np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))])
    generator, distance = np.random.default_rng(0), np.array([0.0, 5.0, 12.0, 30.0])
    seen = np.array(
        [
            edge_offsets(normal, offset, start + distance)
            for offset, start in generator.uniform(-50.0, 50.0, (500, 2))
        ]
    )
    variances, frequencies = stair_waves(normal)
    told = np.cos(2 * np.pi * distance[:, None] * frequencies) @ variances
    assert_allclose((seen[:, :1] * seen).mean(axis=0), told, atol=0.018)  # [px²]; that of a pixel is 0.083.


def test_an_edge_along_the_grid_has_the_sawtooth_s_variance() -> None:
    """It is 1/12 px² of a uniform phase, less what the waves beyond the sum have."""
    variances, _ = stair_waves(np.array([0.0, 1.0]))
    assert 1 / 12 - 0.006 < variances.sum() < 1 / 12


def test_pixels_that_average_have_no_stairs_and_a_blur_hides_whether_they_had() -> None:
    sampled = EdgeNoise.seen_in(np.array([0.0, 1.0, 1.0, 0.0]), 0.0, 0.0)
    averaged = EdgeNoise.seen_in(np.linspace(0.0, 1.0, 1001), 0.0, 0.0)
    blurred = EdgeNoise.seen_in(np.linspace(0.4, 0.6, 101), 0.0, 0.0)
    assert sampled.stairs == 1.0
    assert averaged.stairs == pytest.approx(0.0, abs=2e-3)
    assert blurred.stairs == 1.0
