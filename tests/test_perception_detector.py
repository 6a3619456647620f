"""Objects name the detector that finds them; one that no detector can find is told when its scene is read."""

import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import scenes
from cobot_lfd.app.perceive import perceive
from cobot_lfd.detection import Detection, DetectorKind, ObjectModel
from cobot_lfd.errors import DescriptionError
from cobot_lfd.frame import wrap_angle
from perception import ShapeDetector, detect, detector_for
from scenes import Renderer, World, load_scene, object_models
from tests.renderers import RENDERERS

CONTENT = (Path(scenes.__file__).parent / "pick_and_place.toml").read_text(encoding="utf-8")
CAMERA = load_scene("pick_and_place").camera.camera
MODEL = object_models(load_scene("pick_and_place"))[0]


def written(folder: Path, **changes: Any) -> Path:
    """The scene's file with lines added to the cube."""
    lines = "\n".join(f"{key} = {value}" for key, value in changes.items())
    file = folder / "changed.toml"
    file.write_text(CONTENT.replace("[objects.cube]", f"[objects.cube]\n{lines}"), encoding="utf-8")
    assert tomllib.loads(file.read_text(encoding="utf-8"))
    return file


def test_colour_and_outline_find_an_object_by_default() -> None:
    assert {model.found_by for model in object_models(load_scene("sorting"))} == {"shape"}
    assert isinstance(detector_for("shape", [MODEL]), ShapeDetector)


@pytest.mark.simulator
@pytest.mark.parametrize("seed", range(3))
def test_each_object_of_a_scene_is_found_by_its_own_detector(tmp_path: Path, seed: int) -> None:
    scene = load_scene(written(tmp_path, print='{ kind = "marker", number = 7 }'))
    models = object_models(scene)
    assert [model.found_by for model in models] == ["marker", "shape"]
    with World(scene, seed) as world:
        picture, truth = world.take_picture(), world.true_frames()
    cube, container = detect(picture, scene.camera.camera, models)
    assert isinstance(cube, Detection)
    assert isinstance(container, Detection)
    assert (cube.name, container.name) == ("cube", "container")
    assert np.linalg.norm(cube.frame.position - truth["cube"].position) < 1.5e-3
    assert abs(wrap_angle(cube.frame.angle - truth["cube"].angle)) < np.deg2rad(3.0)
    assert np.linalg.norm(container.frame.position - truth["container"].position) < 1e-3


@pytest.mark.simulator
@pytest.mark.parametrize("renderer", RENDERERS)
def test_an_object_with_a_print_is_found_by_what_it_looks_like(tmp_path: Path, renderer: Renderer) -> None:
    """The pipeline looks at it once, alone on the table, and knows it from then on."""
    file = written(tmp_path, print='{ kind = "circuit_board", seed = 3 }')
    larger = file.read_text(encoding="utf-8").replace(
        "size = [0.04, 0.04, 0.04]", "size = [0.08, 0.05, 0.02]"
    )
    file.write_text(larger, encoding="utf-8")
    scene = load_scene(file)
    for seed in range(2):
        with World(scene, seed, renderer=renderer) as world:
            view, truth = perceive(world), world.true_frames()
        assert not view.missing
        for name, frame in view.frames.items():
            assert np.linalg.norm(frame.position - truth[name].position) < 1e-3
        assert abs(wrap_angle(view.frames["cube"].angle - truth["cube"].angle)) < np.deg2rad(0.5)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"detector": '"features"'}, r"objects\.cube: detector is 'features', but nothing is printed on it"),
        ({"detector": '"marker"'}, r'add print = \{ kind = "marker", number = 7 \}, or choose \'shape\''),
        (
            {"detector": '"shape"', "print": '{ kind = "label" }'},
            r"'shape', which cannot find a box with a label printed on it; choose 'features'",
        ),
        (
            {"detector": '"magic"'},
            r"objects\.cube\.detector: input should be 'shape', 'features' or 'marker'",
        ),
        ({"print": '{ kind = "marker", number = 50 }'}, r"objects\.cube\.print\.number: .*less than 50"),
    ],
)
def test_an_object_that_no_detector_finds_is_told(
    tmp_path: Path, changes: dict[str, str], message: str
) -> None:
    with pytest.raises(DescriptionError, match=message):
        load_scene(written(tmp_path, **changes))


def test_what_is_no_box_cannot_be_found_by_a_print(tmp_path: Path) -> None:
    file = tmp_path / "container.toml"
    file.write_text(CONTENT.replace("[objects.container]", '[objects.container]\ndetector = "features"'))
    with pytest.raises(DescriptionError, match=r"needs a print, and only a box can have one; choose 'shape'"):
        load_scene(file)


def test_a_model_that_nobody_has_seen_is_told() -> None:
    with pytest.raises(ValueError, match=r"'cube' is to be found by features, but nobody has seen it"):
        detector_for("features", [replace(MODEL, found_by="features")])


def test_a_model_without_what_its_detector_needs_is_told() -> None:
    model: ObjectModel = replace(MODEL, found_by="marker")
    with pytest.raises(ValueError, match="'cube' is to be found by a marker, but it has none"):
        detector_for("marker", [model])


@pytest.mark.parametrize("kind", ["shape", "marker", "features"])
def test_who_looks_for_nothing_finds_nothing(kind: DetectorKind) -> None:
    assert detector_for(kind, []).detect(np.full((480, 640, 3), 180, np.uint8), CAMERA) == ()
