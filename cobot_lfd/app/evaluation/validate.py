"""Cross-validation: how near a method's path comes to a demonstration that it has not seen."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cobot_lfd.app.evaluation.contender import fit_method
from cobot_lfd.app.evaluation.measures import resampled
from cobot_lfd.arrays import Array
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.errors import DataError
from cobot_lfd.learning.metrics import Distances, distances


@dataclass(frozen=True, slots=True, eq=False)
class Validation:
    """Leave-one-out distances of one method.

    Attributes:
        method: Name of the method.
        folds: The distances with each demonstration left out, in the demonstrations' order.
    """

    method: str
    folds: tuple[Distances, ...]

    @property
    def mean(self) -> Distances:
        """The mean over all demonstrations [m]."""
        return Distances(*np.mean(self._table(), axis=0).tolist())

    @property
    def standard_error(self) -> Distances:
        """Standard error of the mean [m]."""
        table = self._table()
        return Distances(*(np.std(table, axis=0, ddof=1) / np.sqrt(len(table))).tolist())

    def _table(self) -> Array:
        return np.array([[fold.total, fold.start, fold.end] for fold in self.folds])


def cross_validate(method: str, demonstrations: Sequence[Demonstration]) -> Validation:
    """Leave out each demonstration in turn, learn from the others, and compare (paper, Table 5).

    Args:
        method: Name of the method.
        demonstrations: At least three.

    Raises:
        DataError: If there are fewer.
        ModelError: If the method cannot learn from them.
    """
    if len(demonstrations) < 3:
        raise DataError(
            f"there are {len(demonstrations)} demonstrations; leaving one out needs at least 3. Record more."
        )
    folds = []
    for left_out, truth in enumerate(demonstrations):
        others = [d for i, d in enumerate(demonstrations) if i != left_out]
        path = fit_method(method, others).reproduce(truth.frames).mean
        folds.append(distances(path[None], _at_even_times(truth, len(path))[None]))
    return Validation(method, tuple(folds))


def _at_even_times(demonstration: Demonstration, n_steps: int) -> Array:
    """The demonstration at equal steps of time, shape (n_steps, 2) [m]."""
    times = np.linspace(demonstration.times[0], demonstration.times[-1], 4 * n_steps)
    even = [np.interp(times, demonstration.times, column) for column in demonstration.path.T]
    return resampled(np.column_stack(even), n_steps)
