"""Ring Gaussians: regression on a known ring, and which way rings look."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import Scenes, TaskData
from cobot_lfd.learning.mixtures.em import EMSettings
from cobot_lfd.learning.mixtures.encoding import MixtureEncoding, fit_rings, tabulate
from cobot_lfd.learning.mixtures.mixture import Mixture
from cobot_lfd.learning.product.directions import nearest_directions, sequence_directions, unit_carried_on


def spiral_data(noise: float) -> TaskData:
    """Paths at radius 0.5 - 0.3 t around a frame, starting in any direction."""
    rng = np.random.default_rng(0)
    times = np.linspace(0, 1, 150)
    radius = 0.5 - 0.3 * times + rng.normal(0, noise, (40, 150))
    angle = rng.uniform(-np.pi, np.pi, (40, 1)) + times
    paths = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    scenes = Scenes(np.zeros((40, 1, 2)), np.tile(np.eye(2), (40, 1, 1, 1)))
    return TaskData(("ring",), times, paths, scenes, 1.0)


def test_a_known_ring_is_regressed() -> None:
    """Radius 0.5 - 0.3 t with standard deviation 0.02 (paper, eqs. 16-17)."""
    data = spiral_data(0.02)
    ring = fit_rings(data, [0], EMSettings(1), np.random.default_rng(0))[0].mixture
    unused = Mixture(np.ones(1), np.zeros((1, 1, 3)), np.eye(3)[None, None])
    profile = MixtureEncoding(unused, {0: ring}).profile(data.times)
    assert_allclose(profile.radius[0], 0.5 - 0.3 * data.times, atol=2e-3)
    assert_allclose(np.sqrt(profile.radius_variance[0]), 0.02, rtol=0.05)


def test_kernel_statistics_find_the_same_ring() -> None:
    data = spiral_data(0.02)
    profile = tabulate(data, 0.02, 1e-9).profile(data.times)
    assert_allclose(profile.radius[0], 0.5 - 0.3 * data.times, atol=6e-3)


def test_a_regressed_radius_is_never_negative() -> None:
    ring = Mixture(np.ones(1), np.array([[[0.5, 0.0]]]), np.array([[[[0.1, -0.1], [-0.1, 0.2]]]]))
    unused = Mixture(np.ones(1), np.zeros((1, 1, 3)), np.eye(3)[None, None])
    profile = MixtureEncoding(unused, {0: ring}).profile(np.linspace(0, 1, 20))
    assert profile.radius.min() == 0
    assert profile.radius.max() > 0.4


def scene(*positions: tuple[float, float]) -> Scenes:
    n = len(positions)
    return Scenes(np.array([positions], dtype=float), np.tile(np.eye(2), (1, n, 1, 1)))


def constant(scenes: Scenes, n_steps: int) -> Array:
    return np.repeat(scenes.positions[..., None], n_steps, axis=-1)


def test_a_ring_looks_at_the_nearest_frame() -> None:
    scenes = scene((0, 0), (3, 0), (0, 1))
    directions = nearest_directions(scenes, constant(scenes, 4), [False, False, False], 0)
    assert_allclose(directions[0], np.tile([[0.0], [1.0]], 4))


def test_an_oriented_frame_stands_where_its_gaussian_is() -> None:
    """It comes nearer than the other frame half way."""
    scenes = scene((0, 0), (3, 0), (0, 2))
    means = constant(scenes, 2)
    means[0, 1, :, 1] = [1.0, 0.0]
    directions = nearest_directions(scenes, means, [False, True, False], 0)
    assert_allclose(directions[0], [[0, 1], [1, 0]])


def test_a_ring_looks_back_before_its_closest_approach_and_ahead_after() -> None:
    scenes = scene((0, 0), (1, 0), (1, 1))
    switch = np.array([False, False, True])
    directions = sequence_directions(scenes, scenes.positions, [0, 1, 2], switch, 1)
    assert_allclose(directions[0].T, [[-1, 0], [-1, 0], [0, 1]])


def test_without_a_direction_the_last_one_is_kept() -> None:
    vectors = np.array([[[0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 0.0, 3.0]]])
    carried = unit_carried_on(vectors, np.zeros_like(vectors))
    assert_allclose(carried[0].T, [[1, 0], [1, 0], [1, 0], [0, 1]])


def test_a_ring_alone_looks_along_its_own_x_axis() -> None:
    scenes = scene((2, 3))
    assert nearest_directions(scenes, constant(scenes, 3), [False], 0)[0, :, 0] == pytest.approx([1, 0])
