"""The pinhole camera: rays and pixels belong together."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.camera import Camera

CAMERA = Camera.looking_at(
    [0.5, -0.3, 1.1], [0.45, 0.1, 0.0], up=[1, 0, 0], field_of_view=np.deg2rad(40), width=320, height=200
)


def test_the_target_is_in_the_middle_of_the_picture() -> None:
    """Pixel centres lie at whole numbers, so the middle of 320 x 200 px is at (159.5, 99.5)."""
    assert_allclose(CAMERA.project([0.45, 0.1, 0.0]), [159.5, 99.5], atol=1e-9)


def test_up_is_up_and_right_is_right() -> None:
    up, right = CAMERA.project([[0.5, 0.1, 0.0], [0.45, 0.05, 0.0]]) - [159.5, 99.5]
    assert up[1] < -5
    assert abs(up[0]) < 1
    assert right[0] > 5


@pytest.mark.parametrize("z", [-0.1, 0.0, 0.3])
def test_a_ray_comes_back_to_its_pixel(z: float) -> None:
    pixels = np.random.default_rng(0).uniform([0, 0], [319, 199], size=(20, 2))
    points = np.column_stack([CAMERA.to_plane(pixels, z), np.full(20, z)])
    assert_allclose(CAMERA.project(points), pixels, atol=1e-9)


def test_the_field_of_view_ends_at_the_picture_edges() -> None:
    """Half the opening angle down is the lower edge, half a pixel below the last row's centres."""
    down = CAMERA.world_from_camera.rotation[:, 1]
    forward = CAMERA.world_from_camera.rotation[:, 2]
    edge = (
        CAMERA.world_from_camera.position + np.cos(np.deg2rad(20)) * forward + np.sin(np.deg2rad(20)) * down
    )
    assert_allclose(CAMERA.project(edge), [159.5, 199.5], atol=1e-9)


def test_many_points_are_projected_like_each_of_them() -> None:
    points = np.random.default_rng(1).uniform([0.3, -0.2, 0.0], [0.6, 0.2, 0.1], size=(4, 3, 3))
    together = CAMERA.project(points)
    assert together.shape == (4, 3, 2)
    assert_allclose(together[2, 1], CAMERA.project(points[2, 1]))


def test_a_picture_without_pixels_is_told() -> None:
    with pytest.raises(ValueError, match=r"the picture is 0 x 200 px; both must be at least 1"):
        Camera(0, 200, CAMERA.matrix, CAMERA.world_from_camera)
