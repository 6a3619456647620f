"""A folder of recorded episodes: one sealed HDF5 file each, numbered, never overwritten."""

import re
from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.episode_file import episode_from_bytes, episode_to_bytes
from cobot_lfd.app.disk import folder_lock, move_into_place, sync_folder, told, write_temporary
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.errors import DataError

TRASH = "trash"
"""Folder inside a folder of episodes to which unwanted ones are moved; their numbers stay taken."""

_UNFINISHED = ".episode.partial"
_NAME = re.compile(r"episode_(\d{6,})\.h5")


def succeeded(episode: RecordedEpisode) -> bool:
    """Whether the demonstration did the task: what is learnt from by default."""
    return episode.verdict.succeeded


def save_episode(folder: Path, episode: RecordedEpisode) -> Path:
    """Keep an episode: it is safe on the disk, whatever happens next, when this returns.

    It gets the next free number; several recorders may save into one folder at once.

    Args:
        folder: Folder of episodes; made if it is missing.
        episode: What is to be kept.

    Returns:
        The new file, such as ``folder/episode_000007.h5``.

    Raises:
        DataError: If the disk is full or the folder cannot be written; nothing is left behind then.
    """
    contents = episode_to_bytes(episode)
    with told(folder, "save an episode in"):
        folder.mkdir(parents=True, exist_ok=True)
        with folder_lock(folder):
            _remove_left_over(folder)
            path = folder / f"episode_{_next_number(folder):06d}.h5"
            move_into_place(write_temporary(folder, contents, ending=_UNFINISHED), path)
        sync_folder(folder.parent)
    return path


def require_writable(folder: Path) -> None:
    """Complain before anything is recorded, rather than after, where it could not be kept.

    Raises:
        DataError: If the folder cannot be made or written.
    """
    with told(folder, "save episodes in"):
        folder.mkdir(parents=True, exist_ok=True)
        write_temporary(folder, b"", ending=_UNFINISHED).unlink()


def load_episode(path: Path) -> RecordedEpisode:
    """Read an episode, checking that no bit of it has changed since it was saved.

    Raises:
        DataError: If the file is missing, foreign, damaged, cut short or of another version.
    """
    with told(path, "read"):
        contents = path.read_bytes()
    return episode_from_bytes(contents, str(path))


def list_episodes(folder: Path) -> list[Path]:
    """The files of a folder that are episodes by their names, in the order of their numbers.

    Raises:
        DataError: If there is no such folder.
    """
    if not folder.is_dir():
        raise DataError(f"there is no folder {folder}; record demonstrations into it first.")
    with told(folder, "list"):
        return sorted((path for path in folder.iterdir() if _NAME.fullmatch(path.name)), key=episode_number)


def episode_number(path: Path) -> int:
    """The number in an episode's file name.

    Raises:
        ValueError: If the file is not named like an episode.
    """
    match = _NAME.fullmatch(path.name)
    if match is None:
        raise ValueError(f"{path.name!r} is no name of an episode; it must be like 'episode_000007.h5'.")
    return int(match[1])


def load_demonstrations(
    folder: Path, *, keep: Callable[[RecordedEpisode], bool] = succeeded
) -> list[Demonstration]:
    """The demonstrations in a folder, in the order of their numbers.

    Args:
        folder: Folder of episodes.
        keep: Which episodes to learn from; by default those that did the task.

    Raises:
        DataError: If the folder is missing, a file in it cannot be read, or no episode is kept.
    """
    return [episode.demonstration() for episode in load_kept(folder, keep=keep)]


def load_kept(folder: Path, *, keep: Callable[[RecordedEpisode], bool] = succeeded) -> list[RecordedEpisode]:
    """The episodes in a folder that can be learnt from, in the order of their numbers.

    Args:
        folder: Folder of episodes.
        keep: Which episodes to learn from; by default those that did the task.

    Raises:
        DataError: If the folder is missing, a file in it cannot be read, or no episode is kept.
    """
    episodes = [load_episode(path) for path in list_episodes(folder)]
    kept = [episode for episode in episodes if keep(episode)]
    if not kept:
        raise DataError(
            f"no demonstration in {folder} can be learnt from ({_counted(episodes)}); record more into it."
        )
    return kept


def _remove_left_over(folder: Path) -> None:
    """Remove what killed recorders left unfinished; inside the folder's lock no other one is at work."""
    for path in folder.glob(f".*{_UNFINISHED}"):
        path.unlink(missing_ok=True)


def _next_number(folder: Path) -> int:
    """One more than the highest number in use, in the trash too; call it inside the folder's lock."""
    trash = folder / TRASH
    paths = list_episodes(folder) + (list_episodes(trash) if trash.is_dir() else [])
    return max((episode_number(path) for path in paths), default=-1) + 1


def _counted(episodes: Iterable[RecordedEpisode]) -> str:
    counts = Counter(episode.verdict.outcome.kind for episode in episodes)
    return ", ".join(f"{n} {kind}" for kind, n in counts.items()) or "it holds no episodes"
