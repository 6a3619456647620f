"""cobot-lfd demos: care for recorded demonstrations."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from tyro.conf import Positional, arg, subcommand

from cobot_lfd.app.commands.exit_codes import DONE, NOT_ALL_SUCCEEDED
from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.exchange.importing import IMPORTED, import_path
from cobot_lfd.app.demonstrations.exchange.lerobot import export_lerobot
from cobot_lfd.app.demonstrations.exchange.robomimic import export_robomimic
from cobot_lfd.app.demonstrations.folder import (
    UnreadableFile,
    find_damage,
    list_trash,
    look_at_episodes,
    restore_episode,
    trash_episode,
)
from cobot_lfd.app.demonstrations.quality import Quality, assess
from cobot_lfd.app.demonstrations.store import episode_number, list_episodes, load_episode, save_episode
from cobot_lfd.app.pictures.plot_episode import plot_episode
from cobot_lfd.app.recording.replay import By
from cobot_lfd.app.recording.replay import replay as replay_episode
from cobot_lfd.arrays import Array
from cobot_lfd.errors import DataError


def list_(folder: Positional[Path]) -> int:
    """List the demonstrations in a folder, and how many are in its trash.

    Args:
        folder: Folder of demonstrations.
    """
    files = look_at_episodes(folder)
    for file in files:
        if isinstance(file, UnreadableFile):
            print(f"{episode_number(file.path):>4}  {file.problem}")
        else:
            print(_line(episode_number(file.path), load_episode(file.path)))
    print(f"{len(files)} demonstrations in {folder}, {len(list_trash(folder))} more in its trash")
    return NOT_ALL_SUCCEEDED if any(isinstance(file, UnreadableFile) for file in files) else DONE


def show(folder: Positional[Path], number: Positional[int], *, plot: Path | None = None) -> int:
    """Tell all about one demonstration.

    Args:
        folder: Folder of demonstrations.
        number: Number of the demonstration.
        plot: File (.png, .svg or .pdf) for a plot of its path, height, speed and forces.
    """
    episode = _find(folder, number)
    quality = assess(episode)
    print(f"scene {episode.scene}, robot {episode.robot}, seed {episode.seed}")
    print(f"verdict: {episode.verdict.sentence}")
    print(f"{len(episode.times)} samples, {quality.duration:.1f} s, carried {quality.carried:.2f} m")
    print(f"smoothness: {_smoothness(quality)}")
    print(f"largest force of the hand: {_largest(episode.hand_forces):.1f} N")
    for seen in episode.detections:
        x, y = seen.frame.position
        print(f"frame {seen.name}: ({x:.4f}, {y:.4f}) m, {np.rad2deg(seen.frame.angle):.1f} degrees")
    for warning in quality.warnings:
        print(f"warning: {warning}")
    if plot is not None:
        print(f"plot: {plot_episode(episode, plot)}")
    return DONE


def replay(folder: Positional[Path], number: Positional[int], *, by: By | Literal["both"] = "both") -> int:
    """Do a demonstration again in the physics, and tell how far the tool was from where it was then.

    Args:
        folder: Folder of demonstrations.
        number: Number of the demonstration.
        by: Drive the joints through their recorded states, or let the hand pull with its recorded wrenches.
    """
    episode = _find(folder, number)
    chosen: tuple[By, ...] = ("joints", "wrenches") if by == "both" else (by,)
    succeeded = []
    for one in chosen:
        result = replay_episode(episode, one)
        print(
            f"by {one}: the tool deviates by {1000 * result.mean:.2f} mm in the mean, "
            f"{1000 * result.worst:.2f} mm at most, {1000 * result.final:.2f} mm at the end; "
            f"{result.verdict.sentence}"
        )
        succeeded.append(result.verdict.succeeded)
    return DONE if all(succeeded) else NOT_ALL_SUCCEEDED


def trash(folder: Positional[Path], numbers: Positional[tuple[int, ...]]) -> int:
    """Take demonstrations out of a folder; they are moved to its trash, never deleted.

    Args:
        folder: Folder of demonstrations.
        numbers: Numbers of the demonstrations.
    """
    return _move(trash_episode, folder, numbers)


def restore(folder: Positional[Path], numbers: Positional[tuple[int, ...]]) -> int:
    """Put demonstrations back from a folder's trash.

    Args:
        folder: Folder of demonstrations.
        numbers: Numbers of the demonstrations.
    """
    return _move(restore_episode, folder, numbers)


def check(folder: Positional[Path]) -> int:
    """Check every file in a folder and its trash: checksum, version and contents.

    Args:
        folder: Folder of demonstrations.
    """
    damaged = find_damage(folder)
    for file in damaged:
        print(file.problem)
    n_files = len(list_episodes(folder)) + len(list_trash(folder))
    print(f"{n_files - len(damaged)} of {n_files} files are whole")
    return NOT_ALL_SUCCEEDED if damaged else DONE


def import_(
    paths: Positional[tuple[Path, ...]], *, frames: Path, out: Path, scene: str, robot: str = IMPORTED
) -> int:
    """Make demonstrations of paths that were recorded elsewhere, on a real cobot for instance.

    Args:
        paths: CSV files with a header (t, x, y, and perhaps z, qx, qy, qz, qw, gripper, carrying), or npz
            files with arrays of these names; seconds and metres.
        frames: TOML file with a table [frames.NAME] for each object: position = [x, y], angle_deg = 30.
        out: Folder of demonstrations that they are added to.
        scene: Name of the scene that they belong to.
        robot: What they were recorded with.
    """
    episodes = [import_path(path, frames, scene, robot=robot) for path in paths]
    for path, episode in zip(paths, episodes, strict=True):
        print(f"{path}: {save_episode(out, episode)}")
    return DONE


def export(
    folder: Positional[Path], *, to: Literal["robomimic", "lerobot"], out: Path, failed: bool = False
) -> int:
    """Write demonstrations in the layout of another project.

    Args:
        folder: Folder of demonstrations.
        to: Robomimic's HDF5 file, or a folder of LeRobot 3.0 (needs the extra 'lerobot').
        out: The file or folder to be written.
        failed: Also those that did not do the task; robomimic's file says which.
    """
    episodes = [load_episode(path) for path in list_episodes(folder)]
    chosen = [episode for episode in episodes if failed or episode.verdict.succeeded]
    if not chosen:
        raise DataError(f"{folder} holds no demonstration that can be exported.")
    if to == "robomimic":
        n_samples = export_robomimic(chosen, out)
    else:
        n_samples = export_lerobot(chosen, out, task=chosen[0].scene.replace("_", " "))
    print(f"{len(chosen)} of {len(episodes)} demonstrations, {n_samples} samples: {out}")
    return DONE


_Action = (
    Annotated[int, subcommand(name="list", constructor=list_)]
    | Annotated[int, subcommand(name="show", constructor=show)]
    | Annotated[int, subcommand(name="replay", constructor=replay)]
    | Annotated[int, subcommand(name="trash", constructor=trash)]
    | Annotated[int, subcommand(name="restore", constructor=restore)]
    | Annotated[int, subcommand(name="check", constructor=check)]
    | Annotated[int, subcommand(name="import", constructor=import_)]
    | Annotated[int, subcommand(name="export", constructor=export)]
)


def demos(action: Annotated[_Action, arg(name="")]) -> int:
    """Care for recorded demonstrations: list, show, replay, trash, restore, check, import, export."""
    return action


def _move(move: Callable[[Path, int], Path], folder: Path, numbers: tuple[int, ...]) -> int:
    for number in numbers:
        print(f"moved to {move(folder, number)}")
    return DONE


def _find(folder: Path, number: int) -> RecordedEpisode:
    by_number = {episode_number(path): path for path in list_episodes(folder)}
    if number not in by_number:
        choices = ", ".join(map(str, by_number)) or "it holds none"
        raise DataError(f"there is no demonstration {number} in {folder}; choose one of: {choices}.")
    return load_episode(by_number[number])


def _line(number: int, episode: RecordedEpisode) -> str:
    quality = assess(episode)
    facts = f"seed {episode.seed:<6} {quality.duration:5.1f} s  smoothness {_smoothness(quality):>6}"
    return f"{number:>4}  {facts}  {'; '.join([episode.verdict.sentence, *quality.warnings])}"


def _smoothness(quality: Quality) -> str:
    return "-" if quality.smoothness is None else f"{quality.smoothness:.2f}"


def _largest(vectors: Array) -> float:
    return float(np.linalg.norm(vectors, axis=1).max(initial=0.0))
