"""Dynamic movement primitives, by the library movement_primitives."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.baselines.endpoints import AnchoredPoint
from cobot_lfd.baselines.extra import explained
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.frame import Frame

_N_STEPS = 200


@dataclass(frozen=True, slots=True, eq=False)
class MovementPrimitive:
    """A spring towards the goal with the demonstrated shape as its forcing term (Ijspeert et al. 2013).

    Shapes are learnt and replayed relative to the line from start to goal, turned and scaled with it; in
    the world's axes the mean of demonstrations in different directions would have no meaning.

    Attributes:
        primitive: The library's primitive, from (0, 0) to (1, 0).
        start: Where the path starts.
        end: Where the path ends.
    """

    primitive: Any
    start: AnchoredPoint
    end: AnchoredPoint

    @classmethod
    def fit(cls, demonstrations: Sequence[Demonstration], *, n_weights: int = 30) -> Self:
        """Imitate the mean of the demonstrations' shapes.

        Raises:
            CobotError: If the library is not installed.
        """
        with explained("dmp"):
            from movement_primitives.dmp import DMP
        steps = np.linspace(0.0, 1.0, _N_STEPS)
        shapes = [_shape(_resampled(demonstration, steps)) for demonstration in demonstrations]
        primitive: Any = DMP(2, execution_time=1.0, dt=steps[1], n_weights_per_dim=n_weights)
        primitive.imitate(steps, np.mean(shapes, axis=0))
        primitive.configure(start_y=np.array([0.0, 0.0]), goal_y=np.array([1.0, 0.0]))
        return cls(primitive, AnchoredPoint.of(demonstrations, 0), AnchoredPoint.of(demonstrations, -1))

    def reproduce(self, frames: Mapping[str, Frame]) -> Array:
        """The path from the scene's start to its goal [m], shape (T, 2)."""
        _, shape = self.primitive.open_loop()
        start, end = self.start.at(frames), self.end.at(frames)
        return np.asarray(start + shape @ _along(end - start))


def _along(step: Array) -> Array:
    """Takes rows (1, 0) to ``step`` and (0, 1) to its left [m], shape (2, 2)."""
    return np.array([step, [-step[1], step[0]]])


def _shape(path: Array) -> Array:
    """The path as seen from its own start and goal, which are (0, 0) and (1, 0), shape (T, 2)."""
    return np.asarray((path - path[0]) @ np.linalg.inv(_along(path[-1] - path[0])))


def _resampled(demonstration: Demonstration, steps: Array) -> Array:
    times = demonstration.times
    share = (times - times[0]) / (times[-1] - times[0])
    return np.column_stack([np.interp(steps, share, column) for column in demonstration.path.T])
