"""Walls stand on the table or on the floors beside them."""

import numpy as np
from numpy.testing import assert_array_equal

from scenes.feet import with_feet
from scenes.union import union_outlines

WALLS = [(-0.08, -0.08, 0.05, -0.06), (-0.08, 0.06, 0.05, 0.08), (0.05, -0.08, 0.07, 0.08)]
(U,) = union_outlines(WALLS)


def heights_of_sides(
    floors: list[tuple[tuple[float, float, float], tuple[float, float, float]]],
) -> dict[str, float]:
    """The length of the outline's sides at each height of their foot; what climbs has no length."""
    corners, heights = with_feet(U, floors)
    following = np.roll(corners, -1, axis=0)
    lengths = np.linalg.norm(following - corners, axis=1)
    level = heights == np.roll(heights, -1)
    assert_array_equal(lengths[~level], 0.0)
    return {f"{z:g}": round(float(lengths[level & (heights == z)].sum()), 9) for z in np.unique(heights)}


def test_without_floors_all_stand_on_the_table() -> None:
    corners, heights = with_feet(U, [])
    assert_array_equal(corners, U)
    assert_array_equal(heights, 0.0)


def test_walls_around_a_floor_stand_on_it() -> None:
    inner, all_around = 2 * 0.13 + 0.12, 2 * 0.13 + 0.12 + 2 * 0.02 + 2 * 0.15 + 0.16
    floor = ((-0.08, -0.06, 0.0), (0.05, 0.06, 0.006))
    assert heights_of_sides([floor]) == {"0": round(all_around - inner, 9), "0.006": round(inner, 9)}


def test_a_floor_beside_a_part_of_a_wall_counts_there() -> None:
    low, high = ((-0.08, -0.06, 0.0), (-0.03, 0.06, 0.01)), ((-0.03, -0.06, 0.0), (0.0, 0.06, 0.02))
    lengths = heights_of_sides([low, high])
    assert (lengths["0.01"], lengths["0.02"]) == (0.1, 0.06)


def test_what_does_not_touch_the_walls_changes_nothing() -> None:
    corners, heights = with_feet(U, [((-0.05, -0.02, 0.0), (0.0, 0.02, 0.01))])
    assert_array_equal(corners, U)
    assert_array_equal(heights, 0.0)
