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
        tried: For each the fits to some regions, or why there is none; objects of the same colour have the
            same regions, and no region has two colours.

    Returns:
        For each model its fit, None where there is none.
    """
    chosen: list[OutlineFit | None] = [None] * len(models)
    for alike in _groups([tuple(model.colour) for model in models]):
        for i, fit in zip(alike, best_together([tried[i] for i in alike]), strict=True):
            chosen[i] = fit
    return named_from_the_left(models, chosen)


def best_together(tried: Sequence[Sequence[OutlineFit | str]]) -> list[OutlineFit | None]:
    """One fit for each of m objects to k regions, such that no region is given to two.

    Args:
        tried: The fits of each object to each region, or why there is none, m times k.
    """
    costs = [[-quality(r) if isinstance(r, OutlineFit) else _IMPOSSIBLE for r in row] for row in tried]
    chosen: list[OutlineFit | None] = [None] * len(tried)
    for row, column in zip(*linear_sum_assignment(np.array(costs).reshape(len(tried), -1)), strict=True):
        found = tried[row][column]
        chosen[row] = found if isinstance(found, OutlineFit) else None
    return chosen


def named_from_the_left(
    models: Sequence[ObjectModel], chosen: Sequence[OutlineFit | None]
) -> list[OutlineFit | None]:
    """The same fits; of several models that look the same, the first has what lies farthest to the left."""
    named = list(chosen)
    for alike in _groups([_looks(model) for model in models]):
        fits = sorted((f for i in alike if (f := chosen[i]) is not None), key=lambda f: -f.frame.position[1])
        for place, i in enumerate(alike):
            named[i] = fits[place] if place < len(fits) else None
    return named


def _groups(keys: Sequence[object]) -> list[list[int]]:
    """The places of equal keys."""
    return [[i for i, key in enumerate(keys) if key == group] for group in dict.fromkeys(keys)]


def _looks(model: ObjectModel) -> tuple[object, ...]:
    """What two objects that look the same have in common."""
    return model.outline.tobytes(), model.z, model.base_z.tobytes(), model.colour.tobytes()
