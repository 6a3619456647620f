"""Episodes on a disk that is full, read-only, or used by recorders that are killed: nothing is lost."""

import multiprocessing
import os
import resource
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np
import pytest

from cobot_lfd.app.demonstrations.folder import look_at_episodes, trash_episode
from cobot_lfd.app.demonstrations.store import (
    list_episodes,
    load_episode,
    require_writable,
    save_episode,
)
from cobot_lfd.errors import DataError
from tests.app_examples import episode

FORK = multiprocessing.get_context("fork")


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


@contextmanager
def mounted(folder: Path, options: str) -> Iterator[None]:
    """A disk of its own in a folder, where that is permitted."""
    words = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)]
    if os.geteuid() != 0 or subprocess.run(words, capture_output=True, check=False).returncode != 0:
        pytest.skip("mounting is not permitted here")
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)


def _save_until_it_fails(folder: Path, kept: list[Path]) -> None:
    for seed in range(1000):
        kept.append(save_episode(folder, episode(seed)))  # noqa: PERF401 -- what was kept before is needed


def test_a_disk_that_fills_up_is_told_and_keeps_what_was_saved(tmp_path: Path) -> None:
    with mounted(tmp_path, "size=200k"):
        folder, kept = tmp_path / "demos", list[Path]()
        with pytest.raises(DataError, match=r"cannot save an episode in .*: No space left.*Free some space"):
            _save_until_it_fails(folder, kept)
        assert len(kept) > 1
        assert list_episodes(folder) == kept
        assert [load_episode(path).seed for path in kept] == list(range(len(kept)))
        assert not list(folder.glob(".*.partial"))
        kept.pop().unlink()
        assert load_episode(save_episode(folder, episode(77))).seed == 77


def test_a_disk_that_is_mounted_read_only_is_told_and_can_be_read(tmp_path: Path) -> None:
    with mounted(tmp_path, "size=1m"):
        folder = tmp_path / "demos"
        kept = save_episode(folder, episode())
        subprocess.run(["mount", "-o", "remount,ro", str(tmp_path)], check=True)
        only = r": Read-only file system\. Choose a folder that you may write to"
        with pytest.raises(DataError, match=f"cannot save episodes in .*{only}"):
            require_writable(folder)
        with pytest.raises(DataError, match=f"cannot save an episode in .*{only}"):
            save_episode(folder, episode())
        with pytest.raises(DataError, match=f"cannot write in .*{only}"):
            trash_episode(folder, 0)
        assert load_episode(kept).seed == 3
        assert [file.path for file in look_at_episodes(folder)] == [kept]


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
