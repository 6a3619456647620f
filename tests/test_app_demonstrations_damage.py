"""Episodes that are damaged, cut, foreign or missing: each is told, with what to do."""

from pathlib import Path

import numpy as np
import pytest

from cobot_lfd.app.demonstrations.seal import seal
from cobot_lfd.app.demonstrations.store import load_episode, save_episode
from cobot_lfd.errors import DataError
from tests.app_examples import episode


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
