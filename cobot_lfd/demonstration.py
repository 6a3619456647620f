"""A demonstration: one path through the task, with the frames that held while it was recorded."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.frame import Frame
from cobot_lfd.pose import Pose


@dataclass(frozen=True, slots=True, eq=False, init=False)
class Demonstration:
    """One path through the task, with the frames that held while it was recorded.

    Attributes:
        path: Positions in the world [m], shape (T, 2), in the order of time.
        frames: The task parameters: name to frame.
        times: Time of each position [s], strictly increasing, shape (T,).
    """

    path: Array
    frames: Mapping[str, Frame]
    times: Array

    def __init__(self, path: ArrayLike, frames: Mapping[str, Frame], times: ArrayLike | None = None) -> None:
        """Copy and check; without ``times`` the positions count as one second in equal steps."""
        path, times = _checked(path, frames, times, dimension=2)
        object.__setattr__(self, "path", path)
        object.__setattr__(self, "frames", MappingProxyType(dict(frames)))
        object.__setattr__(self, "times", times)


@dataclass(frozen=True, slots=True, eq=False, init=False)
class SpatialDemonstration:
    """The same in three dimensions: a path in space, its frames given as poses.

    Attributes:
        path: Positions in the world [m], shape (T, 3), in the order of time.
        frames: The task parameters: name to pose.
        times: Time of each position [s], strictly increasing, shape (T,).
    """

    path: Array
    frames: Mapping[str, Pose]
    times: Array

    def __init__(self, path: ArrayLike, frames: Mapping[str, Pose], times: ArrayLike | None = None) -> None:
        """Copy and check; without ``times`` the positions count as one second in equal steps."""
        path, times = _checked(path, frames, times, dimension=3)
        object.__setattr__(self, "path", path)
        object.__setattr__(self, "frames", MappingProxyType(dict(frames)))
        object.__setattr__(self, "times", times)


def _checked(
    path: ArrayLike, frames: Mapping[str, object], times: ArrayLike | None, *, dimension: int
) -> tuple[Array, Array]:
    """The path and its times, copied and checked."""
    path = frozen_array(path, "path", (None, dimension))
    if len(path) < 2:
        raise ValueError(f"path has {len(path)} positions; it needs at least 2.")
    if not frames:
        raise ValueError("frames is empty; a demonstration needs at least one frame.")
    times = frozen_array(np.linspace(0.0, 1.0, len(path)) if times is None else times, "times", (len(path),))
    if (np.diff(times) <= 0).any():
        raise ValueError("times must be strictly increasing; sort them and drop repeated samples.")
    return path, times
