"""The drawn picture shows the objects where perception says they are."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from cobot_lfd.app.pictures.draw import (
    DETOUR_COLOUR,
    OUTLINE_COLOUR,
    PATH_COLOUR,
    X_COLOUR,
    Picture,
    draw_detections,
    save_picture,
)
from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.errors import DataError
from tests.app_examples import detection

CAMERA = Camera.looking_at([0.5, 0, 1.2], [0.5, 0, 0], up=[1, 0, 0], field_of_view=0.5, width=640, height=480)
GREY: Picture = np.full((480, 640, 3), 120, dtype=np.uint8)
CORNERS = 0.02 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
CUBE = ObjectModel("cube", CORNERS, 0.04, np.array([1.0, 0.0, 0.0]), symmetry=4, base_z=np.zeros(4))


def is_near(picture: Picture, pixel: Array, colour: tuple[int, int, int], scale: int = 2) -> bool:
    """Whether a colour is drawn within 2 px of a pixel of the camera's picture."""
    u, v = np.round(scale * (pixel + 0.5) - 0.5).astype(int)
    patch = picture[v - 2 * scale : v + 2 * scale + 1, u - 2 * scale : u + 2 * scale + 1].astype(int)
    return bool((np.abs(patch - colour).max(axis=2) < 30).any())


def in_picture(points: Array, z: float) -> Array:
    return CAMERA.project(np.column_stack([points, np.full(len(points), z)]))


def test_the_outline_is_drawn_at_the_detected_pose_and_height() -> None:
    seen = detection(x=0.52, y=-0.05, angle=0.4)
    drawn = draw_detections(GREY, CAMERA, [seen], models=[CUBE])
    for pixel in in_picture(seen.frame.apply(CORNERS), CUBE.z):
        assert is_near(drawn, pixel, OUTLINE_COLOUR)
    for pixel in in_picture(seen.frame.apply(2.0 * CORNERS), CUBE.z):
        assert not is_near(drawn, pixel, OUTLINE_COLOUR)


def test_the_x_axis_points_where_the_frame_does() -> None:
    seen = detection(x=0.52, y=-0.05, angle=0.4)
    drawn = draw_detections(GREY, CAMERA, [seen], models=[CUBE])
    forward, backward = in_picture(seen.frame.apply(np.array([[0.017, 0.0], [-0.01, 0.0]])), CUBE.z)
    assert is_near(drawn, forward, X_COLOUR)
    assert not is_near(drawn, backward, X_COLOUR)


def test_without_a_model_the_contour_that_was_seen_is_drawn() -> None:
    contour = np.array([[100.0, 100.0], [200.0, 110.0], [150.0, 180.0]])
    drawn = draw_detections(GREY, CAMERA, [replace(detection(), contour=contour)])
    assert all(is_near(drawn, pixel, OUTLINE_COLOUR) for pixel in contour)


def test_the_path_is_drawn_where_the_camera_would_see_it() -> None:
    path = np.linspace([0.45, -0.1], [0.55, 0.1], 30)
    drawn = draw_detections(GREY, CAMERA, [], path=path, path_z=0.1)
    assert all(is_near(drawn, pixel, PATH_COLOUR) for pixel in in_picture(path, 0.1))


def test_a_detour_is_drawn_beside_the_path_that_it_leaves() -> None:
    path = np.linspace([0.45, -0.1], [0.55, 0.1], 30)
    beside = path + np.array([0.04, 0.0])
    drawn = draw_detections(GREY, CAMERA, [], path=path, detour=beside, path_z=0.1)
    assert all(is_near(drawn, pixel, PATH_COLOUR) for pixel in in_picture(path, 0.1))
    assert all(is_near(drawn, pixel, DETOUR_COLOUR) for pixel in in_picture(beside, 0.1))


def test_a_path_from_an_object_starts_where_its_frame_is_drawn() -> None:
    seen = detection(x=0.52, y=-0.05)
    path = np.linspace(seen.frame.position, [0.5, 0.1], 30)
    drawn = draw_detections(GREY, CAMERA, [], models=[CUBE], path=path)
    assert all(is_near(drawn, pixel, PATH_COLOUR) for pixel in in_picture(path, CUBE.z))


def test_nothing_seen_leaves_the_picture_as_it_was() -> None:
    picture: Picture = np.random.default_rng(0).integers(0, 256, (480, 640, 3), dtype=np.uint8)
    assert_array_equal(draw_detections(picture, CAMERA, [], scale=1), picture)


def test_the_camera_picture_itself_is_not_drawn_on() -> None:
    original = GREY.copy()
    draw_detections(GREY, CAMERA, [detection()], models=[CUBE], scale=1)
    assert_array_equal(GREY, original)


def test_an_object_at_the_lower_edge_is_labelled_inside_the_picture() -> None:
    low = np.array([[300.0, 440.0], [340.0, 440.0], [340.0, 478.0], [300.0, 478.0]])
    x, y = CAMERA.to_plane(low.mean(axis=0), 0.0).tolist()
    drawn = draw_detections(GREY, CAMERA, [replace(detection(x=x, y=y), contour=low)])
    label_area = drawn[2 * 350 : 2 * 440, 2 * 250 : 2 * 400]
    assert (label_area == 255).all(axis=2).sum() > 100


def test_a_picture_of_another_camera_is_refused() -> None:
    with pytest.raises(
        ValueError, match=r"picture has shape \(240, 320, 3\) and type uint8; this camera takes"
    ):
        draw_detections(np.zeros((240, 320, 3), dtype=np.uint8), CAMERA, [])


def test_a_saved_picture_keeps_its_colours(tmp_path: Path) -> None:
    picture: Picture = np.random.default_rng(0).integers(0, 256, (20, 30, 3), dtype=np.uint8)
    file = save_picture(picture, tmp_path / "picture.png")
    decoded = cv2.imread(str(file))
    assert decoded is not None
    assert_array_equal(decoded[..., ::-1], picture)
    assert [path.name for path in tmp_path.iterdir()] == ["picture.png"]


def test_a_missing_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"cannot write .*picture\.png: No such file or directory"):
        save_picture(GREY, tmp_path / "none" / "picture.png")
