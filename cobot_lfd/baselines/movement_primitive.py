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

    Attributes:
        primitive: The library's primitive, imitating the mean of the demonstrations' shapes.
        start: Where the path starts.
        end: Where the path ends.
    """

    primitive: Any
    start: AnchoredPoint
    end: AnchoredPoint

    @classmethod
    def fit(cls, demonstrations: Sequence[Demonstration], *, n_weights: int = 30) -> Self:
        """Imitate the demonstrations: the mean of their forcing terms' weights.

        Raises:
            CobotError: If the library is not installed.
        """
        with explained("dmp"):
            from movement_primitives.dmp import DMP
        steps = np.linspace(0.0, 1.0, _N_STEPS)
        weights = []
        for demonstration in demonstrations:
            primitive: Any = DMP(2, execution_time=1.0, dt=steps[1], n_weights_per_dim=n_weights)
            primitive.imitate(steps, _resampled(demonstration, steps))
            weights.append(primitive.get_weights())
        primitive.set_weights(np.mean(weights, axis=0))
        return cls(primitive, AnchoredPoint.of(demonstrations, 0), AnchoredPoint.of(demonstrations, -1))

    def reproduce(self, frames: Mapping[str, Frame]) -> Array:
        """The path from the scene's start to its goal [m], shape (T, 2)."""
        self.primitive.configure(start_y=self.start.at(frames), goal_y=self.end.at(frames))
        _, path = self.primitive.open_loop()
        return np.asarray(path)


def _resampled(demonstration: Demonstration, steps: Array) -> Array:
    times = demonstration.times
    share = (times - times[0]) / (times[-1] - times[0])
    return np.column_stack([np.interp(steps, share, column) for column in demonstration.path.T])
