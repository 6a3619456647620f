"""Care for recorded episodes: nothing is deleted, damage is found, one bad file hides no good one."""

from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from cobot_lfd.app.demonstrations.folder import (
    UnreadableFile,
    WholeFile,
    find_damage,
    list_trash,
    look_at_episodes,
    restore_episode,
    trash_episode,
)
from cobot_lfd.app.demonstrations.store import list_episodes, save_episode
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Outcome, Verdict
from tests.app_examples import episode


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with three episodes, of seeds 10, 11 and 12."""
    for seed in (10, 11, 12):
        save_episode(tmp_path, episode(seed, Outcome.SUCCESS if seed < 12 else Outcome.TIMEOUT))
    return tmp_path


def damage(path: Path) -> None:
    contents = bytearray(path.read_bytes())
    contents[2000] ^= 1
    path.write_bytes(contents)


def test_a_list_tells_what_each_episode_was(folder: Path) -> None:
    files = look_at_episodes(folder)
    whole = [file for file in files if isinstance(file, WholeFile)]
    assert [file.seed for file in whole] == [10, 11, 12]
    assert whole[2].verdict == Verdict(Outcome.TIMEOUT)
    assert (whole[0].scene, whole[0].robot, whole[0].n_samples) == ("pick_and_place", "panda", 50)
    assert_allclose(whole[0].duration, 2.0)  # [s]


def test_a_damaged_file_hides_no_other(folder: Path) -> None:
    damage(list_episodes(folder)[1])
    kinds = [type(file) for file in look_at_episodes(folder)]
    assert kinds == [WholeFile, UnreadableFile, WholeFile]


def test_damage_is_found_in_the_trash_too(folder: Path) -> None:
    assert find_damage(folder) == []
    damage(list_episodes(folder)[0])
    damage(trash_episode(folder, 2))
    found = find_damage(folder)
    assert [file.path.name for file in found] == ["episode_000000.h5", "episode_000002.h5"]
    assert all("is damaged: its contents do not match its checksum" in file.problem for file in found)


def test_trash_and_restore_undo_each_other(folder: Path) -> None:
    before = {path.name: path.read_bytes() for path in list_episodes(folder)}
    trashed = trash_episode(folder, 1)
    assert trashed == folder / "trash" / "episode_000001.h5"
    assert [path.name for path in list_episodes(folder)] == ["episode_000000.h5", "episode_000002.h5"]
    assert [file.path for file in list_trash(folder)] == [trashed]
    assert restore_episode(folder, 1) == folder / "episode_000001.h5"
    assert {path.name: path.read_bytes() for path in list_episodes(folder)} == before


def test_a_restored_episode_finds_its_number_free(folder: Path) -> None:
    trash_episode(folder, 2)
    assert save_episode(folder, episode(13)).name == "episode_000003.h5"
    assert restore_episode(folder, 2).name == "episode_000002.h5"


def test_an_unknown_number_names_the_choices(folder: Path) -> None:
    with pytest.raises(DataError, match=r"there is no episode 7 in .*; choose one of: 0, 1, 2\."):
        trash_episode(folder, 7)


def test_restoring_what_was_not_trashed_is_told(folder: Path) -> None:
    with pytest.raises(DataError, match="has no trash, so there is nothing to restore"):
        restore_episode(folder, 0)
    trash_episode(folder, 1)
    with pytest.raises(DataError, match=r"there is no episode 0 in .*trash; choose one of: 1\."):
        restore_episode(folder, 0)


def test_restoring_overwrites_nothing(folder: Path) -> None:
    trashed = trash_episode(folder, 0)
    (folder / trashed.name).write_bytes(b"copied here by hand")
    with pytest.raises(DataError, match=r"is there already\. Rename one of the two"):
        restore_episode(folder, 0)
    assert (folder / trashed.name).read_bytes() == b"copied here by hand"


def test_a_missing_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"cannot write in .*none: No such file or directory"):
        trash_episode(tmp_path / "none", 0)
