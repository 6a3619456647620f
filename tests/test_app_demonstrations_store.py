"""Episodes on disk: nothing is lost, nothing is overwritten, damage is told."""

import multiprocessing
import os
import resource
import shutil
import signal
import tempfile
import time
from collections.abc import Iterator
from dataclasses import fields, replace
from multiprocessing.connection import Connection
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
    require_writable,
    save_episode,
)
from cobot_lfd.camera import Camera
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Outcome
from tests.app_examples import episode

FORK = multiprocessing.get_context("fork")


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


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"cannot read .*episode_000000.h5: No such file or directory"):
        load_episode(tmp_path / "episode_000000.h5")


def test_every_damaged_bit_is_found(tmp_path: Path) -> None:
    path = save_episode(tmp_path, episode())
    whole = path.read_bytes()
    rng = np.random.default_rng(0)
    for place in [100, 511, 512, len(whole) - 1, *rng.integers(512, len(whole), 100)]:
        damaged = bytearray(whole)
        damaged[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(damaged)
        with pytest.raises(DataError, match="is damaged: its contents do not match its checksum"):
            load_episode(path)


@pytest.mark.parametrize("length", [90, 512, 5000, -1])
def test_a_file_that_was_cut_is_told(tmp_path: Path, length: int) -> None:
    path = save_episode(tmp_path, episode())
    path.write_bytes(path.read_bytes()[:length])
    with pytest.raises(DataError, match="is damaged"):
        load_episode(path)


@pytest.mark.parametrize("contents", [b"", b"\x89HDF\r\n\x1a\n" + bytes(2000), b"half of something else"])
def test_a_foreign_file_is_told(tmp_path: Path, contents: bytes) -> None:
    path = tmp_path / "episode_000000.h5"
    path.write_bytes(contents)
    with pytest.raises(DataError, match="is no cobot-lfd episode file; move it to another folder"):
        load_episode(path)


def test_another_version_is_told(tmp_path: Path) -> None:
    path = tmp_path / "episode_000000.h5"
    path.write_bytes(seal(b"from the future", title="cobot-lfd episode", version=3))
    with pytest.raises(
        DataError, match=r"has version 3 of the cobot-lfd episode format; .* reads version 1 and 2"
    ):
        load_episode(path)


def test_a_sealed_file_that_holds_no_episode_is_told(tmp_path: Path) -> None:
    path = tmp_path / "episode_000000.h5"
    path.write_bytes(seal(b"no HDF5", title="cobot-lfd episode", version=1))
    with pytest.raises(DataError, match="holds no valid episode"):
        load_episode(path)


def test_a_full_disk_is_told_and_leaves_nothing_behind(tmp_path: Path) -> None:
    kept = save_episode(tmp_path, episode())
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, hard))
    try:
        with pytest.raises(DataError, match=r"cannot save an episode in .*: File too large.*is safe"):
            save_episode(tmp_path, episode())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert {path.name for path in tmp_path.iterdir()} == {".lock", kept.name}
    assert load_episode(kept).seed == 3


@pytest.fixture
def read_only_folder() -> Iterator[Path]:
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o555)
    user = os.geteuid()
    if user == 0:
        os.seteuid(65534)  # root may write everywhere; an ordinary user may not
    yield folder
    os.seteuid(user)
    shutil.rmtree(folder)


def test_a_read_only_folder_is_told(read_only_folder: Path) -> None:
    with pytest.raises(DataError, match=r"cannot save an episode in .*: Permission denied\. Choose a folder"):
        save_episode(read_only_folder, episode())


def test_a_read_only_folder_is_told_before_anything_is_recorded(read_only_folder: Path) -> None:
    with pytest.raises(DataError, match=r"cannot save episodes in .*: Permission denied\. Choose a folder"):
        require_writable(read_only_folder)


def test_a_folder_that_can_be_written_is_left_empty(tmp_path: Path) -> None:
    require_writable(tmp_path / "new" / "demos")
    assert list((tmp_path / "new" / "demos").iterdir()) == []


def test_a_file_in_place_of_the_folder_is_told(tmp_path: Path) -> None:
    (tmp_path / "demos").write_text("not a folder")
    with pytest.raises(DataError, match=r"cannot save an episode in .*demos: File exists"):
        save_episode(tmp_path / "demos", episode())


def _save_for_ever(folder: Path, kept: Connection) -> None:
    for seed in range(10**6):
        save_episode(folder, episode(seed))
        kept.send(seed)


def _save_some(folder: Path, first_seed: int) -> None:
    for seed in range(first_seed, first_seed + 10):
        save_episode(folder, episode(seed))


def test_what_was_kept_survives_a_kill_at_any_moment(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    for repetition in range(12):
        folder = tmp_path / str(repetition)
        receiver, sender = FORK.Pipe(duplex=False)
        recorder = FORK.Process(target=_save_for_ever, args=(folder, sender))
        recorder.start()
        sender.close()
        receiver.poll(10)  # the first one is on the disk
        time.sleep(rng.uniform(0.0, 0.05))
        os.kill(recorder.pid or 0, signal.SIGKILL)
        recorder.join()
        reported = _received(receiver)
        assert [load_episode(path).seed for path in list_episodes(folder)][: len(reported)] == reported
        assert load_episode(save_episode(folder, episode(77))).seed == 77
        assert not list(folder.glob(".*.partial"))


def _received(receiver: Connection) -> list[int]:
    reported = []
    try:
        while receiver.poll():
            reported.append(receiver.recv())
    except EOFError:
        pass
    return reported


def test_only_unfinished_episodes_are_tidied_up(tmp_path: Path) -> None:
    for name in (".0123.episode.partial", ".0123.partial", "notes.txt"):
        (tmp_path / name).write_bytes(b"half")
    save_episode(tmp_path, episode())
    assert {path.name for path in tmp_path.iterdir()} == {
        ".lock",
        ".0123.partial",
        "notes.txt",
        "episode_000000.h5",
    }


def test_two_recorders_at_once_lose_nothing(tmp_path: Path) -> None:
    recorders = [FORK.Process(target=_save_some, args=(tmp_path, 10 * i)) for i in range(4)]
    for recorder in recorders:
        recorder.start()
    for recorder in recorders:
        recorder.join()
    assert sorted(load_episode(path).seed for path in list_episodes(tmp_path)) == list(range(40))
