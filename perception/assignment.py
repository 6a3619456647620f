"""Which of the things that were seen is which of the objects that were looked for."""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from cobot_lfd.detection import ObjectModel
from perception.outline_fit import OutlineFit, quality

_IMPOSSIBLE = 1e6  # Cost of giving a model a region that it does not fit.


def assign(
    models: Sequence[ObjectModel], tried: Sequence[Sequence[OutlineFit | str]]
) -> list[OutlineFit | None]:
    """One fit for each model, such that no region is given to two, and all together fit best.

    Objects that look the same cannot be told apart; they are named in the order of their places from left to
    right as the robot sees them (largest y first), so that a picture always gives the same answer.

    Args:
        models: The objects.
        tried: For each the fits to the regions of its colour, or why there is none; objects of the same
            colour have the same regions.

    Returns:
        For each model its fit, None where there is none.
    """
    chosen: list[OutlineFit | None] = [None] * len(models)
    for alike in _groups([tuple(model.colour) for model in models]):
        results = [tried[i] for i in alike]
        costs = [[-quality(r) if isinstance(r, OutlineFit) else _IMPOSSIBLE for r in row] for row in results]
        for row, column in zip(*linear_sum_assignment(np.array(costs).reshape(len(alike), -1)), strict=True):
            found = results[row][column]
            chosen[alike[row]] = found if isinstance(found, OutlineFit) else None
    for alike in _groups([_looks(model) for model in models]):
        fits = sorted((f for i in alike if (f := chosen[i]) is not None), key=lambda f: -f.frame.position[1])
        for place, i in enumerate(alike):
            chosen[i] = fits[place] if place < len(fits) else None
    return chosen


def _groups(keys: Sequence[object]) -> list[list[int]]:
    """The places of equal keys."""
    return [[i for i, key in enumerate(keys) if key == group] for group in dict.fromkeys(keys)]


def _looks(model: ObjectModel) -> tuple[object, ...]:
    """What two objects that look the same have in common."""
    return model.outline.tobytes(), model.z, model.base_z, model.colour.tobytes()
