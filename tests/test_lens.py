"""Lens distortion: its closed form, and its inverse."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.camera import Camera
from cobot_lfd.lens import distort, undistort
from cobot_lfd.pose import Pose

STRONG = np.array([-0.3, 0.12, 0.002, -0.003, -0.02])
RAYS = np.random.default_rng(0).uniform(-0.4, 0.4, size=(50, 2))


def test_no_coefficients_move_nothing() -> None:
    assert_allclose(distort(RAYS, np.zeros(5)), RAYS)


def test_a_barrel_pulls_points_towards_the_centre_by_the_square_of_their_distance() -> None:
    moved = distort(np.array([0.3, 0.4]), np.array([-0.2, 0.0, 0.0, 0.0, 0.0]))
    assert_allclose(moved, np.array([0.3, 0.4]) * (1 - 0.2 * 0.25))


def test_a_tilted_lens_moves_points_on_the_axes_as_its_formula_says() -> None:
    assert_allclose(
        distort(np.array([0.2, 0.0]), np.array([0, 0, 0.01, 0.02, 0])), [0.2 + 0.06 * 0.04, 0.01 * 0.04]
    )


def test_undistorting_undoes_distorting() -> None:
    assert_allclose(undistort(distort(RAYS, STRONG), STRONG), RAYS, atol=1e-9)


@pytest.mark.parametrize("distortion", [np.zeros(5), STRONG])
def test_a_camera_with_a_lens_takes_pixels_to_rays_and_back(distortion: np.ndarray) -> None:
    matrix = np.array([[600.0, 1.5, 310.0], [0.0, 590.0, 250.0], [0.0, 0.0, 1.0]])
    camera = Camera(640, 480, matrix, Pose.identity(), distortion)
    pixels = np.random.default_rng(1).uniform([0, 0], [639, 479], size=(30, 2))
    assert_allclose(camera.to_pixels(camera.to_rays(pixels)), pixels, atol=1e-6)
    assert_allclose(camera.project([0.0, 0.0, 2.0]), [310.0, 250.0], atol=1e-9)
