"""Frames that matter are found in pictures and paths alone, and models find them again by themselves."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from cobot_lfd.app.cli import main
from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.store import save_episode
from cobot_lfd.app.discovery.decisions import Fate
from cobot_lfd.app.discovery.discover import Discovery, discover
from cobot_lfd.app.discovery.picture import draw_discovery
from cobot_lfd.app.discovery.recognised import demonstrations_of
from cobot_lfd.app.discovery.told import told
from cobot_lfd.app.perceive import perceive
from cobot_lfd.app.recording.sketch import sketch_episode
from cobot_lfd.detection import Detection
from cobot_lfd.errors import DataError
from cobot_lfd.frame import FrameKind
from cobot_lfd.learning.model import TaskParameterisedGMM
from scenes import World, load_scene

pytestmark = pytest.mark.simulator

CLUTTERED = "pick_and_place@clutter"
SCENE = load_scene(CLUTTERED)
CAMERA = SCENE.camera.camera


@cache
def shown(scene_name: str, n: int = 3) -> tuple[RecordedEpisode, ...]:
    scene = load_scene(scene_name)
    return tuple(sketch_episode(scene_name, scene, "panda", seed)[0] for seed in range(n))


@cache
def found() -> Discovery:
    return discover(shown(CLUTTERED), CAMERA)


def test_part_and_container_are_kept_and_distractors_dropped() -> None:
    assert set(found().kept) == {"red", "blue"}
    dropped = {item.name for item in found().decisions if item.fate is Fate.DROPPED}
    assert dropped == {"base", "black", "white", "yellow"}
    assert all("left-out demonstrations" in item.reason for item in found().decisions)


def test_a_goal_that_the_camera_does_not_see_is_told_by_the_base() -> None:
    sorting = discover(shown("sorting"), load_scene("sorting").camera.camera)
    assert set(sorting.kept) == {"base", "blue_2"}  # The smaller of the two boards of one colour.
    models = sorting.candidates.models
    assert (
        np.ptp(models["blue_2"].outline, axis=0).max() < 0.07 < np.ptp(models["blue_1"].outline, axis=0).max()
    )
    assert sorting.kinds["base"] is FrameKind.ORIENTED


def test_a_moving_thing_that_one_picture_hides_is_dropped_with_the_reason() -> None:
    episodes = list(shown(CLUTTERED))
    yellow = found().candidates.tracks["yellow"].sightings[1]
    assert isinstance(yellow, Detection)
    low, high = yellow.contour.min(axis=0).astype(int) - 8, yellow.contour.max(axis=0).astype(int) + 8
    picture = episodes[1].picture.copy()
    picture[low[1] : high[1], low[0] : high[0]] = picture[low[1], low[0]]
    episodes[1] = replace(episodes[1], picture=picture)
    hidden = discover(episodes, CAMERA)
    assert set(hidden.kept) == {"red", "blue"}
    (reason,) = (item.reason for item in hidden.decisions if item.name == "yellow")
    assert "in demonstration 2" in reason


def test_the_model_file_carries_how_its_frames_are_recognised(tmp_path: Path) -> None:
    for episode in shown(CLUTTERED):
        save_episode(tmp_path / "demos", episode)
    file = tmp_path / "model.npz"
    assert main(["fit", str(tmp_path / "demos"), "--frames", "auto", "--out", str(file)]) == 0
    model = TaskParameterisedGMM.load(file)
    assert set(model.names) == {"red", "blue"}
    with World(SCENE, 77) as world:
        view = perceive(world, recognition=model.recognition)
        covered = perceive(world, covered=True, recognition=model.recognition)
        truth = world.true_frames()
    for name, thing in (("red", "cube"), ("blue", "container")):
        seen = view.find_for(model)[name]
        assert isinstance(seen, Detection), seen
        assert np.linalg.norm(seen.frame.position - truth[thing].position) < 0.002  # [m]
    assert not any(isinstance(item, Detection) for item in covered.find_for(model).values())
    again = demonstrations_of(model, shown(CLUTTERED))
    for ours, theirs in zip(again, found().demonstrations, strict=True):
        assert ours.frames.keys() == theirs.frames.keys()
        for name in ours.frames:
            assert np.linalg.norm(ours.frames[name].position - theirs.frames[name].position) < 1e-6


def test_the_decision_is_told_and_drawn(tmp_path: Path) -> None:
    text = told(found())
    assert "kept    red" in text
    assert "2 frames matter" in text
    file = draw_discovery(found(), shown(CLUTTERED), CAMERA, tmp_path / "frames.png")
    assert file.stat().st_size > 10_000


def test_what_cannot_be_learnt_from_is_refused() -> None:
    episodes = shown(CLUTTERED)
    with pytest.raises(DataError, match="2 demonstrations are too few"):
        discover(episodes[:2], CAMERA)
    blind = replace(episodes[0], picture=np.zeros((0, 0, 3), np.uint8))
    with pytest.raises(DataError, match="has no picture"):
        discover([blind, *episodes[1:]], CAMERA)
    bare = [replace(e, picture=np.full_like(e.picture, 180)) for e in episodes]
    with pytest.raises(DataError, match="nothing that stands out from the table"):
        discover(bare, CAMERA)
    small = replace(episodes[0], picture=episodes[0].picture[::2, ::2])
    with pytest.raises(DataError, match="320 x 240 px; the camera's are 640 x 480"):
        discover([small, *episodes[1:]], CAMERA)
