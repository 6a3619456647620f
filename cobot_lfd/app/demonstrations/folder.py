"""Care for a folder of episodes: look at what is there, check it, take out what is unwanted, put it back."""

import os
from dataclasses import dataclass
from pathlib import Path

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.store import TRASH, episode_number, list_episodes, load_episode
from cobot_lfd.app.disk import folder_lock, sync_folder, told
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Verdict


@dataclass(frozen=True, slots=True)
class WholeFile:
    """An episode's file that is whole, with what a list says about it.

    Attributes:
        path: The file.
        scene: Name of the scene.
        robot: Name of the robot.
        seed: Seed of the episode.
        verdict: How the episode ended.
        n_samples: Number of samples.
        duration: From the first sample to the last [s]; 0 where there are none.
    """

    path: Path
    scene: str
    robot: str
    seed: int
    verdict: Verdict
    n_samples: int
    duration: float

    @classmethod
    def of(cls, path: Path, episode: RecordedEpisode) -> "WholeFile":
        """What a list says about an episode."""
        return cls(
            path=path,
            scene=episode.scene,
            robot=episode.robot,
            seed=episode.seed,
            verdict=episode.verdict,
            n_samples=len(episode.times),
            duration=float(episode.times[-1] - episode.times[0]) if len(episode.times) else 0.0,
        )


@dataclass(frozen=True, slots=True)
class UnreadableFile:
    """A file that is named like an episode and cannot be used.

    Attributes:
        path: The file.
        problem: What is wrong with it and what to do, as a sentence.
    """

    path: Path
    problem: str


def look_at_episodes(folder: Path) -> list[WholeFile | UnreadableFile]:
    """Read and check every episode in a folder; an unreadable one does not hide the others.

    Raises:
        DataError: If there is no such folder.
    """
    return [_look_at(path) for path in list_episodes(folder)]


def find_damage(folder: Path) -> list[UnreadableFile]:
    """The files in a folder and its trash that cannot be used: foreign, damaged, cut, of another version.

    Raises:
        DataError: If there is no such folder.
    """
    found = look_at_episodes(folder) + list_trash(folder)
    return [file for file in found if isinstance(file, UnreadableFile)]


def list_trash(folder: Path) -> list[WholeFile | UnreadableFile]:
    """The episodes in a folder's trash; none if nothing was ever thrown away."""
    trash = folder / TRASH
    return look_at_episodes(trash) if trash.is_dir() else []


def trash_episode(folder: Path, number: int) -> Path:
    """Take an episode out of a folder without deleting it: it is moved to the folder's trash.

    Args:
        folder: Folder of episodes.
        number: Number of the episode, as in its file name.

    Returns:
        The file in the trash.

    Raises:
        DataError: If there is no such episode, or it cannot be moved.
    """
    return _move(number, folder, folder / TRASH, lock=folder)


def restore_episode(folder: Path, number: int) -> Path:
    """Put an episode back from a folder's trash, under the number that it had.

    The arguments, the result and the error are those of ``trash_episode``, the other way round.
    """
    if not (folder / TRASH).is_dir():
        raise DataError(f"{folder} has no trash, so there is nothing to restore.")
    return _move(number, folder / TRASH, folder, lock=folder)


def _look_at(path: Path) -> WholeFile | UnreadableFile:
    try:
        return WholeFile.of(path, load_episode(path))
    except DataError as error:
        return UnreadableFile(path, str(error))


def _move(number: int, source: Path, target: Path, *, lock: Path) -> Path:
    """Move an episode between a folder and its trash, inside the folder's lock."""
    with told(lock, "write in"), folder_lock(lock):
        target.mkdir(exist_ok=True)
        by_number = {episode_number(path): path for path in list_episodes(source)}
        if number not in by_number:
            choices = ", ".join(map(str, by_number)) or "it holds none"
            raise DataError(f"there is no episode {number} in {source}; choose one of: {choices}.")
        old, new = by_number[number], target / by_number[number].name
        if new.exists():
            raise DataError(f"cannot move {old}: {new} is there already. Rename one of the two.")
        os.rename(old, new)
        sync_folder(target)
        sync_folder(source)
        return new
