"""The learnt model as a whole: symmetries, exact ends, saving and reading, and errors."""

import warnings
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd import Demonstration, Frame, FrameKind, TaskParameterisedGMM
from cobot_lfd.errors import DataError, ModelError
from cobot_lfd.learning.experiments.synthetic import TASKS, demonstrations, draw_scene, planar

METHODS = ("improved", "paper", "conventional")


def fitted(method: str, task: int = 2) -> TaskParameterisedGMM:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return TaskParameterisedGMM.fit(
            demonstrations(TASKS[task], 6, np.random.default_rng(task)), method=method
        )


def new_scene(task: int = 2, seed: int = 99) -> dict[str, Frame]:
    return planar(draw_scene(TASKS[task], np.random.default_rng(seed)))


def moved(motion: Frame, frames: Mapping[str, Frame]) -> dict[str, Frame]:
    return {name: motion @ frame for name, frame in frames.items()}


@pytest.mark.parametrize("task", [1, 2, 3])
@pytest.mark.parametrize("method", METHODS)
def test_reproduction_moves_with_its_frames(method: str, task: int) -> None:
    """Moving all frames by one rigid motion moves the path and its covariance by the same motion."""
    model, scene = fitted(method, task), new_scene(task)
    motion = Frame(np.array([0.3, -1.2]), 2.1)
    here, there = model.reproduce(scene), model.reproduce(moved(motion, scene))
    assert_allclose(there.mean, motion.apply(here.mean), atol=1e-8)
    turned = motion.rotation @ here.covariance @ motion.rotation.T
    assert_allclose(there.covariance, turned, rtol=1e-5, atol=1e-9)


def test_turning_an_orientation_less_frame_changes_nothing() -> None:
    model, scene = fitted("improved"), new_scene()
    assert model.frame_kinds["end"] is FrameKind.ORIENTATION_LESS
    turned = scene | {"end": Frame(scene["end"].position, scene["end"].angle + 1.0)}
    assert_allclose(model.reproduce(turned).mean, model.reproduce(scene).mean, atol=1e-9)


def test_improved_paths_start_and_end_at_the_frames() -> None:
    """Where the demonstrations do within 1 mm, so does the path within 2 mm."""
    task = replace(TASKS[2], noise=(0.0009, 0.001))
    scene = new_scene()
    path = TaskParameterisedGMM.fit(demonstrations(task, 6, np.random.default_rng(4))).reproduce(scene)
    assert np.linalg.norm(path.mean[0] - scene["start"].position) < 0.002
    assert np.linalg.norm(path.mean[-1] - scene["end"].position) < 0.002


@pytest.mark.parametrize("method", METHODS)
def test_a_saved_model_gives_the_same_path(method: str, tmp_path: Path) -> None:
    model, scene = fitted(method), new_scene()
    model.save(tmp_path / "model.npz")
    again = TaskParameterisedGMM.load(tmp_path / "model.npz")
    assert again.frame_kinds == model.frame_kinds
    assert_allclose(again.reproduce(scene).mean, model.reproduce(scene).mean, atol=0)


def test_a_damaged_model_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "model.npz"
    fitted("improved").save(path)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(ModelError, match="damaged or no model file"):
        TaskParameterisedGMM.load(path)


def test_a_missing_model_file_is_told(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="there is no model file"):
        TaskParameterisedGMM.load(tmp_path / "nothing.npz")


def test_another_npz_file_is_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    with pytest.raises(ModelError, match="no model file"):
        TaskParameterisedGMM.load(tmp_path / "other.npz")


def test_a_scene_that_lacks_a_frame_is_refused_by_name() -> None:
    with pytest.raises(ModelError, match="lacks the frame 'end'"):
        fitted("improved").reproduce({"start": Frame(np.zeros(2), 0.0)})


def test_demonstrations_with_unequal_frame_names_are_refused() -> None:
    path = np.linspace([0.0, 0.0], [1.0, 0.0], 50)
    frame = Frame(np.zeros(2), 0.0)
    demos = [Demonstration(path, {"cube": frame}), Demonstration(path, {"box": frame})]
    with pytest.raises(DataError, match="demonstration 1 has the frames 'box'"):
        TaskParameterisedGMM.fit(demos)


def test_an_unknown_method_is_refused_with_the_choices() -> None:
    demos = demonstrations(TASKS[3], 2, np.random.default_rng(0))
    with pytest.raises(ValueError, match="choose one of: improved, paper, conventional"):
        TaskParameterisedGMM.fit(demos, method="best")


def test_lengths_and_sampling_may_differ() -> None:
    """The same path, sampled otherwise, gives the same model up to interpolation."""
    rng = np.random.default_rng(5)
    demos = demonstrations(TASKS[2], 6, rng)
    other = []
    for number, demo in enumerate(demos):
        assert isinstance(demo, Demonstration)
        times = np.sort(np.concatenate([[0, 1], rng.uniform(0, 1, 300 + 20 * number)]))
        path = np.stack([np.interp(times, demo.times, axis) for axis in demo.path.T], axis=1)
        other.append(Demonstration(path, demo.frames, times=5 + 3 * times))
    first = TaskParameterisedGMM.fit(demos).reproduce(new_scene())
    second = TaskParameterisedGMM.fit(other).reproduce(new_scene())
    assert_allclose(first.mean, second.mean, atol=0.01)
    assert second.times[-1] == pytest.approx(3.0)


def test_a_planar_model_refuses_spatial_frames() -> None:
    spatial = draw_scene(TASKS[2], np.random.default_rng(1))
    with pytest.raises(ModelError, match="have 3 dimensions, the model was learnt in 2"):
        fitted("improved").reproduce(spatial)
