"""Gaussian mixture regression in the world frame: what is learnt without task parameters."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.baselines.extra import explained
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.frame import Frame

_N_STEPS = 200


@dataclass(frozen=True, slots=True, eq=False)
class WorldGMR:
    """A mixture over time and position, regressed on time (Calinon et al. 2007), by the library gmr.

    It does not see the frames, so it shows how much of a task can be done without them.

    Attributes:
        mean: The path [m], shape (T, 2).
    """

    mean: Array

    @classmethod
    def fit(cls, demonstrations: Sequence[Demonstration], *, n_components: int = 4) -> Self:
        """Fit a mixture to all demonstrations.

        Raises:
            CobotError: If the library is not installed.
        """
        with explained("world-gmr"):
            from gmr import GMM
        samples = np.concatenate([_timed(d) for d in demonstrations])
        mixture: Any = GMM(n_components=n_components, random_state=np.random.RandomState(0))
        mixture.from_samples(samples, init_params="kmeans++")
        times = np.linspace(0.0, 1.0, _N_STEPS)[:, None]
        return cls(np.asarray(mixture.predict(np.array([0]), times)))

    def reproduce(self, frames: Mapping[str, Frame]) -> Array:  # noqa: ARG002 - that frames are ignored is the point
        """The same path for every scene [m], shape (T, 2)."""
        return self.mean


def _timed(demonstration: Demonstration) -> Array:
    """Time in 0..1 and position, shape (T, 3), at equal steps of time."""
    times, steps = demonstration.times, np.linspace(0.0, 1.0, _N_STEPS)
    share = (times - times[0]) / (times[-1] - times[0])
    return np.column_stack([steps, *(np.interp(steps, share, column) for column in demonstration.path.T)])
