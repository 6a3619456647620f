"""A face is found wherever it lies and however it is turned, whatever noise and blur leave of it."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from cobot_lfd.frame import Frame, wrap_angle
from perception.brightness import brightness, noise_of
from perception.face_search import Search
from perception.foreground import foreground_parts, without
from tests.test_perception_features import CAMERA, TABLE, appearance, picture_of

SEARCH = Search.of(appearance("small"))


@pytest.mark.parametrize("angle", np.linspace(-3.0, 3.0, 7))
def test_the_likeliest_pose_is_the_right_one(angle: float) -> None:
    frame, generator = Frame(np.array([0.47, 0.05]), angle), np.random.default_rng(0)
    smooth = gaussian_filter(picture_of({"a": ("small", frame)}).astype(float), (1.5, 1.5, 0.0))
    noisy = 0.6 * smooth + generator.normal(scale=8.0, size=smooth.shape)
    image = brightness(np.clip(np.rint(noisy), 0, 255).astype(np.uint8))
    first = SEARCH.poses(image, CAMERA, foreground_parts(image), 3)[0]
    assert np.linalg.norm(first.position - frame.position) < SEARCH.step
    assert abs(wrap_angle(first.angle - frame.angle)) < np.deg2rad(7.5)  # A step between angles.


def test_an_empty_table_is_like_no_face() -> None:
    image = brightness(TABLE)
    assert not foreground_parts(image)
    assert not SEARCH.poses(image, CAMERA, [(slice(100, 300), slice(100, 300))], 3)


def test_a_shadow_across_the_picture_is_followed_and_not_framed() -> None:
    row, column = np.indices(TABLE.shape[:2])
    shadow = np.where((row < column)[..., None], TABLE // 2, TABLE).astype(np.uint8)
    parts = foreground_parts(brightness(shadow))
    covered = np.zeros(TABLE.shape[:2], bool)
    for part in parts:
        covered[part] = True
    assert covered[row == column].all()
    assert covered.mean() < 0.4


def test_what_is_explained_is_looked_at_no_more() -> None:
    left, right = Frame(np.array([0.47, 0.1]), 0.3), Frame(np.array([0.5, -0.1]), 2.0)
    image = brightness(picture_of({"a": ("small", left), "b": ("small", right)}))
    parts = foreground_parts(image)
    corners = left.apply(appearance("small").outline)
    rest = without(parts, CAMERA.project(np.column_stack([corners, np.full(len(corners), SEARCH.z)])))
    assert len(parts) == 2
    (pose,) = SEARCH.poses(image, CAMERA, rest, 1)
    assert np.linalg.norm(pose.position - right.position) < SEARCH.step


def test_noise_is_measured_where_neighbours_should_agree() -> None:
    even = np.full((200, 200), 120.0) + np.random.default_rng(0).normal(scale=5.0, size=(200, 200))
    assert noise_of(even) == pytest.approx(5.0, rel=0.05)


def test_every_colour_counts_alike() -> None:
    picture = np.array([[[90, 0, 0], [0, 90, 0], [0, 0, 90]]], dtype=np.uint8)
    assert brightness(picture).tolist() == [[30, 30, 30]]
