"""A demonstration: one path through the task, with the frames that held while it was recorded."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.frame import Frame


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
        path = frozen_array(path, "path", (None, 2))
        if len(path) < 2:
            raise ValueError(f"path has {len(path)} positions; it needs at least 2.")
        if not frames:
            raise ValueError("frames is empty; a demonstration needs at least one frame.")
        times = frozen_array(
            np.linspace(0.0, 1.0, len(path)) if times is None else times, "times", (len(path),)
        )
        if (np.diff(times) <= 0).any():
            raise ValueError("times must be strictly increasing; sort them and drop repeated samples.")
        object.__setattr__(self, "path", path)
        object.__setattr__(self, "frames", MappingProxyType(dict(frames)))
        object.__setattr__(self, "times", times)
