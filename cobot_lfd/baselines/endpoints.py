"""Where paths start and end: each as a point in the frame that tells it best."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.frame import Frame


@dataclass(frozen=True, slots=True, eq=False)
class AnchoredPoint:
    """A point that moves with a frame.

    Attributes:
        frame: Name of the frame.
        offset: The point in this frame [m], shape (2,).
    """

    frame: str
    offset: Array

    @classmethod
    def of(cls, demonstrations: Sequence[Demonstration], index: int) -> "AnchoredPoint":
        """The mean of the demonstrations' points in the frame that is nearest to them on average.

        Args:
            demonstrations: At least one.
            index: Of the point in each path: 0 for the start, -1 for the end.
        """

        def distance(name: str) -> float:
            gaps = [d.path[index] - d.frames[name].position for d in demonstrations]
            return float(np.linalg.norm(gaps, axis=1).mean())

        nearest = min(demonstrations[0].frames, key=distance)
        local = [d.frames[nearest].localise(d.path[index]) for d in demonstrations]
        return cls(nearest, np.mean(local, axis=0))

    def at(self, frames: Mapping[str, Frame]) -> Array:
        """Where the point is in a scene [m], shape (2,)."""
        return frames[self.frame].apply(self.offset)
