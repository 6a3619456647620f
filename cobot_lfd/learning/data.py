"""What learning works on: all demonstrations on one grid of normalised time, with their frames."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.errors import DataError, ModelError


class TaskFrame(Protocol):
    """What learning needs of a frame; ``Frame`` (planar) and ``Pose`` (spatial) both have it."""

    @property
    def position(self) -> Array:
        """Origin in the world [m], shape (d,)."""

    @property
    def rotation(self) -> Array:
        """Rotation from the frame's axes to the world's, shape (d, d)."""


class TaskDemonstration(Protocol):
    """What learning needs of a demonstration; planar and spatial ones both have it."""

    @property
    def path(self) -> Array:
        """Positions in the world [m], shape (T, d)."""

    @property
    def frames(self) -> Mapping[str, TaskFrame]:
        """The task parameters by name."""

    @property
    def times(self) -> Array:
        """Time of each position [s], shape (T,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Scenes:
    """The frames of S scenes as arrays, in the order of their names.

    Attributes:
        positions: Origins in the world [m], shape (S, J, d).
        rotations: Rotations from the frames' axes to the world's, shape (S, J, d, d).
    """

    positions: Array
    rotations: Array

    def __len__(self) -> int:
        """Number of scenes."""
        return len(self.positions)

    def take(self, frames: Sequence[int]) -> "Scenes":
        """The same scenes with these frames only."""
        return Scenes(self.positions[:, frames], self.rotations[:, frames])

    def only(self, scenes: Sequence[int] | slice) -> "Scenes":
        """These scenes only."""
        return Scenes(self.positions[scenes], self.rotations[scenes])


@dataclass(frozen=True, slots=True, eq=False)
class TaskData:
    """All demonstrations on one grid of normalised time.

    Attributes:
        names: Names of the J frames.
        times: The grid, from 0 to 1, shape (T,).
        paths: Positions in the world [m], shape (N, T, d).
        scenes: The frames of each demonstration.
        duration: Median duration of a demonstration [s].
    """

    names: tuple[str, ...]
    times: Array
    paths: Array
    scenes: Scenes
    duration: float

    @property
    def local(self) -> Array:
        """The paths as seen from each frame [m], shape (N, J, T, d) (paper, eq. 1)."""
        offsets = self.paths[:, None] - self.scenes.positions[:, :, None]
        return np.asarray(offsets @ self.scenes.rotations)

    @property
    def scale(self) -> float:
        """Root mean square distance of the paths' points from their own centres [m]."""
        centred = self.paths - self.paths.mean(axis=1, keepdims=True)
        return float(np.sqrt((centred**2).sum(axis=-1).mean()))

    def take(self, frames: Sequence[int]) -> "TaskData":
        """The same demonstrations seen with these frames only."""
        names = tuple(self.names[j] for j in frames)
        return TaskData(names, self.times, self.paths, self.scenes.take(frames), self.duration)

    def only(self, demonstrations: Sequence[int]) -> "TaskData":
        """These demonstrations only."""
        kept = list(demonstrations)
        return TaskData(self.names, self.times, self.paths[kept], self.scenes.only(kept), self.duration)

    def without(self, demonstration: int) -> "TaskData":
        """All demonstrations but one."""
        return self.only([n for n in range(len(self.paths)) if n != demonstration])


def collect(demonstrations: Sequence[TaskDemonstration], n_steps: int | None = None) -> TaskData:
    """Bring demonstrations of any length and sampling onto one grid of normalised time.

    Between its samples a path is straight.

    Args:
        demonstrations: At least one; all with the same frame names and the same dimension.
        n_steps: Number of steps of the grid; None: as many as the longest demonstration has.

    Raises:
        ValueError: If there are none, or planar and spatial ones are mixed.
        DataError: If their frames differ by name.
    """
    if not demonstrations:
        raise ValueError("demonstrations is empty; learning needs at least one, better four to six.")
    if len({demonstration.path.shape[1] for demonstration in demonstrations}) > 1:
        raise ValueError("planar and spatial demonstrations are mixed; one model learns from one sort.")
    names = _common_names(demonstrations)
    longest = max(len(demonstration.path) for demonstration in demonstrations)
    times = np.linspace(0.0, 1.0, longest if n_steps is None else n_steps)
    paths = np.stack([_resampled(demonstration, times) for demonstration in demonstrations])
    duration = float(np.median([d.times[-1] - d.times[0] for d in demonstrations]))
    return TaskData(names, times, paths, stack_scenes([d.frames for d in demonstrations], names), duration)


def stack_scenes(scenes: Sequence[Mapping[str, TaskFrame]], names: Sequence[str]) -> Scenes:
    """The named frames of each scene as arrays; further frames are left aside.

    Raises:
        ModelError: If a scene lacks a frame.
    """
    for number, scene in enumerate(scenes):
        missing = [name for name in names if name not in scene]
        if missing:
            which = f"scene {number} lacks" if len(scenes) > 1 else "the scene lacks"
            raise ModelError(
                f"{which} the frame {_quoted(missing)}; the model was learnt with {_quoted(names)}, "
                f"the scene has {_quoted(sorted(scene))}."
            )
    positions = np.array([[scene[name].position for name in names] for scene in scenes], dtype=np.float64)
    rotations = np.array([[scene[name].rotation for name in names] for scene in scenes], dtype=np.float64)
    return Scenes(positions, rotations)


def _common_names(demonstrations: Sequence[TaskDemonstration]) -> tuple[str, ...]:
    """The frame names, in the first demonstration's order, checked to be the same in all."""
    names = tuple(demonstrations[0].frames)
    for number, demonstration in enumerate(demonstrations):
        if set(demonstration.frames) != set(names):
            raise DataError(
                f"demonstration {number} has the frames {_quoted(sorted(demonstration.frames))}, "
                f"demonstration 0 has {_quoted(sorted(names))}; all of a task need the same frames."
            )
    return names


def _resampled(demonstration: TaskDemonstration, times: Array) -> Array:
    """The path at normalised times, shape (T, d)."""
    start, end = demonstration.times[0], demonstration.times[-1]
    own = (demonstration.times - start) / (end - start)
    if len(own) == len(times) and np.allclose(own, times, rtol=0, atol=1e-12):
        return demonstration.path
    return np.stack([np.interp(times, own, axis) for axis in demonstration.path.T], axis=1)


def _quoted(names: Sequence[str]) -> str:
    """Names for a message."""
    return ", ".join(f"'{name}'" for name in names)
