"""The simplest method: from start to end along a straight line, with minimum jerk."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.baselines.endpoints import AnchoredPoint
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.frame import Frame


@dataclass(frozen=True, slots=True, eq=False)
class StraightLine:
    """A straight path from a point of one frame to a point of another.

    Attributes:
        start: Where it starts.
        end: Where it ends.
    """

    start: AnchoredPoint
    end: AnchoredPoint

    @classmethod
    def fit(cls, demonstrations: Sequence[Demonstration]) -> Self:
        """Learn where the demonstrations start and end."""
        return cls(AnchoredPoint.of(demonstrations, 0), AnchoredPoint.of(demonstrations, -1))

    def reproduce(self, frames: Mapping[str, Frame], n_steps: int = 200) -> Array:
        """The path [m], shape (n_steps, 2), with least jerk (Flash and Hogan 1985: 10 u³ - 15 u⁴ + 6 u⁵)."""
        u = np.linspace(0.0, 1.0, n_steps)[:, None]
        share = u**3 * (10.0 - 15.0 * u + 6.0 * u**2)
        start, end = self.start.at(frames), self.end.at(frames)
        return np.asarray(start + share * (end - start))
