"""Episodes in a folder: they come back as they were, are numbered, and nothing is overwritten."""

import tempfile
from dataclasses import fields, replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.episode_file import PULL_UNITS, UNITS, episode_to_bytes
from cobot_lfd.app.demonstrations.seal import BLOCK_SIZE, seal
from cobot_lfd.app.demonstrations.store import (
    list_episodes,
    load_demonstrations,
    load_episode,
    save_episode,
)
from cobot_lfd.camera import Camera
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Outcome
from tests.app_examples import episode


def test_an_episode_comes_back_as_it_was(tmp_path: Path) -> None:
    saved = episode(detail="grüße", outcome=Outcome.GRASP_LOST)
    loaded = load_episode(save_episode(tmp_path, saved))
    assert (loaded.scene, loaded.robot, loaded.seed, loaded.verdict) == (
        saved.scene,
        saved.robot,
        saved.seed,
        saved.verdict,
    )
    for name in UNITS:
        assert_array_equal(getattr(loaded, name), getattr(saved, name))
    for name in PULL_UNITS:
        assert_array_equal(getattr(loaded.pulls, name), getattr(saved.pulls, name))
    for ours, theirs in zip(loaded.detections, saved.detections, strict=True):
        assert (ours.name, ours.symmetry, ours.confidence) == (
            theirs.name,
            theirs.symmetry,
            theirs.confidence,
        )
        assert_array_equal(ours.frame.position, theirs.frame.position)
        assert ours.frame.angle == theirs.frame.angle
        assert_array_equal(ours.covariance, theirs.covariance)
        assert_array_equal(ours.contour, theirs.contour)


def test_every_series_of_an_episode_is_written_with_its_unit(tmp_path: Path) -> None:
    path = save_episode(tmp_path, episode())
    arrays = {field.name for field in fields(RecordedEpisode)} - {
        "scene",
        "robot",
        "seed",
        "verdict",
        "detections",
        "camera",
        "pulls",
    }
    with h5py.File(path) as file:
        assert arrays == {name for name, item in file.items() if "unit" in item.attrs}
        assert file["joint_torques"].attrs["unit"] == "N m"
        assert file["detections/1"].attrs["name"] == "container"
        assert file.attrs["robot"] == "panda"


def test_the_camera_comes_back_and_may_be_missing(tmp_path: Path) -> None:
    camera = Camera.looking_at(
        [0.5, 0, 1.2], [0.5, 0, 0], up=[1, 0, 0], field_of_view=0.5, width=32, height=24
    )
    seen = load_episode(save_episode(tmp_path, replace(episode(), camera=camera))).camera
    assert seen is not None
    assert_array_equal(seen.project([0.4, 0.1, 0.02]), camera.project([0.4, 0.1, 0.02]))
    assert load_episode(save_episode(tmp_path, episode())).camera is None


def test_a_file_of_version_1_is_read_and_its_gripper_orders_are_worked_out(tmp_path: Path) -> None:
    closing = replace(episode(), gripper_openings=np.repeat([0.08, 0.03], 25))
    path = tmp_path / "episode_000000.h5"
    path.write_bytes(episode_to_bytes(closing))
    with h5py.File(path, "r+") as file:
        del file["gripper_orders"], file["pulls"]
    path.write_bytes(seal(path.read_bytes()[BLOCK_SIZE:], title="cobot-lfd episode", version=1))
    loaded = load_episode(path)
    assert_array_equal(loaded.gripper_orders, np.repeat([0.08, 0.0], 25))
    assert_array_equal(loaded.joint_positions, closing.joint_positions)
    assert len(loaded.pulls) == 0


def test_equal_episodes_give_equal_bytes() -> None:
    assert episode_to_bytes(episode()) == episode_to_bytes(episode())


def test_an_episode_without_samples_comes_back() -> None:
    nothing = {name: getattr(episode(), name)[:0] for name in UNITS if name != "picture"}
    empty = replace(episode(), **nothing, detections=())
    with tempfile.TemporaryDirectory() as folder:
        loaded = load_episode(save_episode(Path(folder), empty))
    assert loaded.joint_positions.shape == (0, 7)
    assert loaded.detections == ()


def test_saving_into_an_existing_folder_adds_to_it(tmp_path: Path) -> None:
    names = [save_episode(tmp_path / "new", episode(seed)).name for seed in range(3)]
    assert names == ["episode_000000.h5", "episode_000001.h5", "episode_000002.h5"]
    assert [load_episode(path).seed for path in list_episodes(tmp_path / "new")] == [0, 1, 2]


def test_the_number_of_a_trashed_episode_is_not_used_again(tmp_path: Path) -> None:
    path = save_episode(tmp_path, episode())
    (tmp_path / "trash").mkdir()
    path.rename(tmp_path / "trash" / path.name)
    assert save_episode(tmp_path, episode()).name == "episode_000001.h5"


def test_gaps_are_not_filled(tmp_path: Path) -> None:
    (tmp_path / "episode_000041.h5").write_bytes(episode_to_bytes(episode()))
    assert save_episode(tmp_path, episode()).name == "episode_000042.h5"


def test_foreign_and_temporary_files_are_not_listed(tmp_path: Path) -> None:
    path = save_episode(tmp_path, episode())
    for name in (".0123.partial", "notes.txt", "episode_1.h5", "episode_000001.h5.bak"):
        (tmp_path / name).write_bytes(b"half")
    assert list_episodes(tmp_path) == [path]


def test_only_successful_demonstrations_are_learnt_from(tmp_path: Path) -> None:
    save_episode(tmp_path, episode(1))
    save_episode(tmp_path, episode(2, Outcome.GRASP_LOST))
    (demonstration,) = load_demonstrations(tmp_path)
    assert_array_equal(demonstration.path, episode(1).demonstration().path)
    assert len(load_demonstrations(tmp_path, keep=lambda _: True)) == 2


def test_a_folder_without_a_successful_demonstration_is_told(tmp_path: Path) -> None:
    save_episode(tmp_path, episode(1, Outcome.TIMEOUT))
    save_episode(tmp_path, episode(2, Outcome.TIMEOUT))
    with pytest.raises(DataError, match=r"can be learnt from \(2 timeout\); record more into it"):
        load_demonstrations(tmp_path)


def test_an_empty_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"can be learnt from \(it holds no episodes\)"):
        load_demonstrations(tmp_path)


def test_a_missing_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"there is no folder .*nowhere; record demonstrations into it first"):
        list_episodes(tmp_path / "nowhere")
