"""Where the foot of an assembly's walls is seen: on the table, or on a raised floor beside them."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from cobot_lfd.arrays import Array

Floor = tuple[tuple[float, float, float], tuple[float, float, float]]
"""Two opposite corners of a box whose upper side is a floor: the smallest and the largest coordinates [m]."""

_ASIDE = 1e-6  # Outside of a wall at which a floor is looked for [m].


def with_feet(outline: Array, floors: Sequence[Floor]) -> tuple[Array, Array]:
    """An outline whose walls stand on floors or on the table, and the height of the foot below each corner.

    A floor that is not the walls' colour hides the part of them that is below it. Where the height of the
    foot changes along the outline, there are two corners in one place.

    Args:
        outline: Corners [m], counter-clockwise, its sides along the axes, shape (n, 2).
        floors: The boxes beside it whose upper sides are floors.

    Returns:
        Corners, shape (m, 2), and heights [m], shape (m,).
    """
    sides = [
        side
        for pair in zip(outline, np.roll(outline, -1, axis=0), strict=True)
        for side in _cut(*pair, floors)
    ]
    corners, heights = list[Array](), list[float]()
    for (start, _, height), (_, _, before) in zip(sides, sides[-1:] + sides[:-1], strict=True):
        turns = any(np.array_equal(start, corner) for corner in outline)
        if height != before:
            corners += [start, start]
            heights += [before, height]
        elif turns:
            corners.append(start)
            heights.append(height)
    return np.array(corners), np.array(heights)


def _cut(start: Array, end: Array, floors: Sequence[Floor]) -> Iterator[tuple[Array, Array, float]]:
    """The parts of a side, each with the height of what is beside it [m]."""
    along = int(abs(end[1] - start[1]) > abs(end[0] - start[0]))
    bounds = {corner[along] for floor in floors for corner in floor}
    low, high = sorted((start[along], end[along]))
    places = np.array(sorted({low, high} | {bound for bound in bounds if low < bound < high}))
    if end[along] < start[along]:
        places = places[::-1]
    outwards = np.array([end[1] - start[1], start[0] - end[0]]) / (high - low)
    for a, b in pairwise(places):
        first, last = start.copy(), start.copy()
        first[along], last[along] = a, b
        yield first, last, _height(0.5 * (first + last) + _ASIDE * outwards, floors)


def _height(place: Array, floors: Sequence[Floor]) -> float:
    """Of the highest floor at a place, or of the table [m]."""
    x, y = place
    return max(
        (high[2] for low, high in floors if low[0] < x < high[0] and low[1] < y < high[1]), default=0.0
    )
