"""A camera is calibrated from pictures of a board to what it really is."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.camera import Camera
from cobot_lfd.camera_file import load_camera, save_camera
from cobot_lfd.errors import DataError, DescriptionError
from cobot_lfd.pose import Pose
from perception.board import Board, BoardView, find_board
from perception.calibration import calibrate_camera, calibrate_lens
from scenes import CameraDescription, World, load_scene
from scenes.prints import Print
from scenes.view import Light

SCENE = load_scene("pick_and_place")
BOARD = Board()
SEEN = CameraDescription.model_validate(
    SCENE.camera.model_dump()
    | {"lens": {"distortion": (-0.2, 0.05, 0.001, -0.001, 0.0), "blur": 0.5}, "sensor": {"noise": 2.0}}
)
CAMERA = SEEN.camera
TOOL_FROM_BOARD = Pose.from_rpy([0.02, -0.01, 0.03], [0.1, -0.05, 0.2])


def tool_poses(n: int) -> list[Pose]:
    """Poses in which the board fills a good part of the picture, tilted this way and that."""
    generator = np.random.default_rng(0)
    poses = []
    for _ in range(n):
        position = generator.uniform([0.35, -0.22, 0.2], [0.62, 0.22, 0.55])
        tilt = generator.uniform(-0.6, 0.6, size=2)
        poses.append(Pose.from_rpy(position, [*tilt, generator.uniform(-np.pi, np.pi)]))
    return poses


@cache
def views(n: int) -> tuple[BoardView, ...]:
    with World(SCENE, 0) as world:
        pictures = [
            world.take_picture(
                camera=SEEN,
                light=Light(shadow=False),
                prints=[Print(BOARD.image(), BOARD.width, BOARD.height, tool @ TOOL_FROM_BOARD)],
            )
            for tool in tool_poses(n)
        ]
    found = [find_board(picture, BOARD) for picture in pictures]
    return tuple(view for view in found if view is not None)


def ideal_view(camera: Camera, world_from_board: Pose) -> BoardView:
    """The corners exactly where they land."""
    x, y = np.meshgrid((np.arange(1, 8) - 4) * 0.03, (np.arange(1, 6) - 3) * 0.03)
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    return BoardView(points, camera.project(world_from_board.apply(points)))


@pytest.mark.simulator
def test_corners_are_found_where_they_are() -> None:
    pairs = zip(views(20), tool_poses(20), strict=True)
    off = [v.pixels - CAMERA.project((tool @ TOOL_FROM_BOARD).apply(v.points)) for v, tool in pairs]
    assert np.sqrt(np.mean(np.concatenate(off) ** 2)) < 0.15  # [px]
    assert np.abs(np.concatenate(off).mean(axis=0)).max() < 0.03


@pytest.mark.simulator
def test_a_camera_is_calibrated_from_pictures() -> None:
    found = calibrate_camera(views(20), tool_poses(20), CAMERA.width, CAMERA.height)
    camera = found.camera
    assert_allclose(np.diag(camera.matrix)[:2], np.diag(CAMERA.matrix)[:2], rtol=2e-3)
    assert_allclose(camera.matrix[:2, 2], CAMERA.matrix[:2, 2], atol=1.0)  # [px]
    assert found.residual < 0.3
    assert_allclose(camera.world_from_camera.position, CAMERA.world_from_camera.position, atol=2e-3)  # [m]
    assert camera.world_from_camera.angle_to(CAMERA.world_from_camera) < np.deg2rad(0.2)
    assert found.tool_from_board.angle_to(TOOL_FROM_BOARD) < np.deg2rad(0.2)


def test_perfect_corners_give_the_camera_back() -> None:
    tools = tool_poses(8)
    exact = [ideal_view(CAMERA, tool @ TOOL_FROM_BOARD) for tool in tools]
    found = calibrate_camera(exact, tools, CAMERA.width, CAMERA.height)
    assert found.residual < 1e-3
    assert_allclose(found.camera.matrix, CAMERA.matrix, atol=0.05)
    assert_allclose(found.camera.distortion, CAMERA.distortion, atol=1e-3)
    assert_allclose(found.camera.world_from_camera.position, CAMERA.world_from_camera.position, atol=1e-4)


def test_an_empty_picture_shows_no_board() -> None:
    assert find_board(np.full((480, 640, 3), 120, dtype=np.uint8), BOARD) is None


def test_too_few_views_are_told() -> None:
    view = ideal_view(CAMERA, tool_poses(1)[0])
    with pytest.raises(DataError, match=r"the board was seen 3 times; at least 6 views are needed"):
        calibrate_lens([view] * 3, 640, 480)


def test_a_tool_that_only_turns_about_one_axis_is_told() -> None:
    tools = [Pose.from_rpy([0.5, 0.0, 0.3], [0.0, 0.0, angle]) for angle in np.linspace(0, 2, 8)]
    with pytest.raises(DataError, match=r"about its second axis; the camera's place cannot be told\. Tilt"):
        calibrate_camera([ideal_view(CAMERA, tool) for tool in tools], tools, 640, 480)


def test_views_without_poses_are_told() -> None:
    view = ideal_view(CAMERA, tool_poses(1)[0])
    with pytest.raises(ValueError, match=r"there are 6 views and 5 poses; give one for each"):
        calibrate_camera([view] * 6, tool_poses(5), 640, 480)


def test_a_camera_survives_its_file(tmp_path: Path) -> None:
    save_camera(CAMERA, tmp_path / "camera.toml")
    loaded = load_camera(tmp_path / "camera.toml")
    points = np.random.default_rng(0).uniform([0.3, -0.3, 0.0], [0.7, 0.3, 0.1], size=(20, 3))
    assert (loaded.width, loaded.height) == (CAMERA.width, CAMERA.height)
    assert_allclose(loaded.project(points), CAMERA.project(points), atol=1e-9)


def test_a_damaged_camera_file_is_told(tmp_path: Path) -> None:
    save_camera(CAMERA, tmp_path / "camera.toml")
    text = (tmp_path / "camera.toml").read_text(encoding="utf-8").replace("width = 640", "width = 0")
    (tmp_path / "camera.toml").write_text(text, encoding="utf-8")
    with pytest.raises(
        DescriptionError, match=r"camera\.toml: width: .*greater than or equal to 1; given: 0"
    ):
        load_camera(tmp_path / "camera.toml")
