"""A joint trajectory: where the joints are at each time."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.motion.path import JointPath
from cobot_lfd.motion.time_law import TimeLaw

SAME_POSITION = 1e-7
"""How far apart two trajectories may meet [rad]: no control loop can tell such a jump from none, and paths
leave out ways as short as this."""


@dataclass(frozen=True, slots=True, eq=False)
class JointSamples:
    """A trajectory at chosen times.

    Attributes:
        times: Time of each sample [s], shape (K,).
        positions: Joint positions [rad], shape (K, n).
        velocities: Joint velocities [rad/s], shape (K, n).
        accelerations: Joint accelerations [rad/s^2], shape (K, n).
    """

    times: Array
    positions: Array
    velocities: Array
    accelerations: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "times", frozen_array(self.times, "times", (None,)))
        shape = (len(self.times), np.shape(self.positions)[-1])
        for name in ("positions", "velocities", "accelerations"):
            object.__setattr__(self, name, frozen_array(getattr(self, name), name, shape))


@dataclass(frozen=True, slots=True, eq=False)
class TimedPath:
    """A joint path with its times: ``q(t) = p(s(t))``, from rest to rest.

    Attributes:
        path: Where the joints go.
        law: When they are where.
    """

    path: JointPath
    law: TimeLaw

    def __post_init__(self) -> None:
        """Check that the law leads from end to end of the path."""
        if not self.path.is_constant and abs(self.law(self.law.duration) - 1.0) > SAME_POSITION:
            raise ValueError(
                f"the time law ends at s = {self.law(self.law.duration)}; it must end at 1, the path's end."
            )

    def sample(self, times: Array) -> JointSamples:
        """Positions, velocities and accelerations at ``times`` [s], shape (K,), by the chain rule."""
        s, ds, dds, _ = self.law.derivatives(times)
        slope = self.path(s, 1)
        return JointSamples(
            times,
            self.path(s),
            slope * ds[:, None],
            self.path(s, 2) * ds[:, None] ** 2 + slope * dds[:, None],
        )


@dataclass(frozen=True, slots=True, eq=False)
class JointTrajectory:
    """Where the joints are at each time: timed paths, one after the other, each from rest to rest.

    Attributes:
        sections: The timed paths; each starts where the one before it ends.
    """

    sections: tuple[TimedPath, ...]

    def __post_init__(self) -> None:
        """Check that there are sections and that they meet."""
        object.__setattr__(self, "sections", tuple(self.sections))
        if not self.sections:
            raise ValueError("sections is empty; a trajectory needs at least one.")
        for before, after in zip(self.sections, self.sections[1:], strict=False):
            end, start = before.path(1.0), after.path(0.0)
            if end.shape != start.shape or not np.abs(end - start).max() <= SAME_POSITION:
                raise ValueError(
                    f"one trajectory ends at {np.round(end, 6)} rad and the next starts at "
                    f"{np.round(start, 6)} rad; they must meet."
                )

    @classmethod
    def hold(cls, position: ArrayLike, duration: float) -> "JointTrajectory":
        """Stay at ``position`` [rad], shape (n,), for ``duration`` [s]; 0 is allowed."""
        if not 0 <= duration < np.inf:
            raise ValueError(f"duration is {duration} s; it must be 0 or positive.")
        path = JointPath.through(np.atleast_2d(np.asarray(position, dtype=np.float64)))
        return cls((TimedPath(path, TimeLaw.hold(duration)),))

    @classmethod
    def concatenate(cls, trajectories: Sequence["JointTrajectory"]) -> "JointTrajectory":
        """One trajectory after the other.

        Raises:
            ValueError: If there is none, or if one does not start where the one before it ends.
        """
        return cls(tuple(section for trajectory in trajectories for section in trajectory.sections))

    @property
    def n_joints(self) -> int:
        """Number of joints."""
        return self.sections[0].path.n_joints

    @property
    def duration(self) -> float:
        """How long it takes [s]; 0 for a trajectory that goes nowhere."""
        return float(self.section_times[-1])

    @property
    def section_times(self) -> Array:
        """Start of each section, then the end of the last [s], shape (number of sections + 1,)."""
        return np.concatenate([[0.0], np.cumsum([section.law.duration for section in self.sections])])

    @property
    def start(self) -> Array:
        """Joint positions at the start [rad], shape (n,)."""
        return self.sections[0].path(0.0)

    @property
    def goal(self) -> Array:
        """Joint positions at the end [rad], shape (n,)."""
        return self.sections[-1].path(1.0)

    def sample(self, times: ArrayLike) -> JointSamples:
        """The trajectory at ``times`` [s], shape (K,), exactly; before and after it, the arm rests."""
        times = frozen_array(np.atleast_1d(np.asarray(times, dtype=np.float64)), "times", (None,))
        states = np.zeros((3, len(times), self.n_joints))
        for chosen, section, inner in self._parts(times):
            part = section.sample(inner)
            states[:, chosen] = part.positions, part.velocities, part.accelerations
        return JointSamples(times, *states)

    def positions(self, times: ArrayLike) -> Array:
        """The joint positions alone [rad], shape (K, n), at ``times`` [s], shape (K,)."""
        times = np.asarray(times, dtype=np.float64)
        positions = np.zeros((len(times), self.n_joints))
        for chosen, section, inner in self._parts(times):
            positions[chosen] = section.path(section.law(inner))
        return positions

    def _parts(self, times: Array) -> Iterator[tuple[NDArray[np.bool_], TimedPath, Array]]:
        """Which of the times fall into a section, the section, and the times counted from its start."""
        starts = self.section_times
        index = np.clip(np.searchsorted(starts, times, side="right") - 1, 0, len(self.sections) - 1)
        for i in np.unique(index):
            chosen = index == i
            yield chosen, self.sections[i], times[chosen] - starts[i]

    def every(self, period: float) -> JointSamples:
        """The trajectory at 0, period, 2 period, ... [s] up to the first time at which it rests at its end.

        A trajectory of duration 0 gives one sample.
        """
        if not 0 < period < np.inf:
            raise ValueError(f"period is {period} s; it must be positive.")
        n_steps = int(np.ceil(self.duration / period - 1e-9))
        return self.sample(period * np.arange(n_steps + 1))
