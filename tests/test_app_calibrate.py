"""A camera is calibrated by a board that the arm holds, and scenes are then seen by it."""

from pathlib import Path

import numpy as np
import pytest

from cobot_lfd.app.calibrate import calibrate
from cobot_lfd.app.cli import main
from cobot_lfd.app.perceive import perceive
from cobot_lfd.camera_file import save_camera
from cobot_lfd.errors import DescriptionError
from robots import load_robot
from scenes import SceneDescription, World, load_scene

SCENE = load_scene("pick_and_place")
DISTORTION = (-0.2, 0.05, 0.001, -0.001, 0.0)


def distorted() -> SceneDescription:
    content = SCENE.model_dump()
    content["camera"]["lens"] = {"distortion": DISTORTION, "blur": 0.4}
    content["camera"]["sensor"]["noise"] = 2.0
    return SceneDescription.model_validate(content)


@pytest.mark.simulator
def test_a_distorted_noisy_camera_is_found_out_by_a_board_in_the_hand(tmp_path: Path) -> None:
    """From eight pictures only; then a scene that knows no more of its camera finds its objects."""
    session = calibrate(distorted(), load_robot("panda"), n_views=8, seed=0)
    errors = session.errors()
    assert session.found.residual < 0.3  # [px]
    assert errors.focal_percent < 0.2
    assert errors.principal_point_px < 1.0
    assert errors.position_mm < 2.0
    assert errors.angle_deg < 0.2

    save_camera(session.found.camera, tmp_path / "camera.toml")
    content = distorted().model_dump()
    content["camera"]["calibration"] = tmp_path / "camera.toml"
    scene = SceneDescription.model_validate(content)
    assert (scene.camera.true_camera.distortion == DISTORTION).all()
    with World(scene, 1) as world:
        view, truth = perceive(world), world.true_frames()
    for name, frame in view.frames.items():
        assert np.linalg.norm(frame.position - truth[name].position) < 2e-3
    assert not view.missing


def test_a_scenes_file_names_its_camera_relative_to_itself(tmp_path: Path) -> None:
    save_camera(SCENE.camera.camera, tmp_path / "camera.toml")
    source = (Path(__file__).parents[1] / "scenes" / "pick_and_place.toml").read_text(encoding="utf-8")
    named = source.replace("[camera]", '[camera]\ncalibration = "camera.toml"')
    (tmp_path / "mine.toml").write_text(named, encoding="utf-8")
    assert load_scene(tmp_path / "mine.toml").camera.calibration == tmp_path / "camera.toml"


def test_a_camera_of_another_resolution_is_told(tmp_path: Path) -> None:
    other = SCENE.camera.model_copy(update={"width": 320, "height": 240}).camera
    save_camera(other, tmp_path / "camera.toml")
    with pytest.raises(
        DescriptionError, match=r"camera\.toml is of a camera of 320 x 240 px, but this one takes 640 x 480"
    ):
        load_scene("pick_and_place", calibration=tmp_path / "camera.toml")


def test_a_camera_file_that_is_not_there_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["look", "--scene", "sorting", "--out", str(tmp_path / "p.png"), "--camera", "none.toml"]
    assert main(command) == 2
    assert "none.toml: cannot be read" in capsys.readouterr().err


@pytest.mark.simulator
def test_look_draws_and_tells_what_is_detected(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "picture.png"
    assert main(["look", "--scene", "sorting@clutter", "--seed", "3", "--out", str(file)]) == 0
    told = capsys.readouterr().out
    assert all(name in told for name in ("small_board", "large_board", "clutter_white", str(file)))
    assert file.read_bytes().startswith(b"\x89PNG")
