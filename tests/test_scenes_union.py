"""The outline of boxes side by side: its area, its direction, its holes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.arrays import Array
from scenes.union import Rectangle, union_outlines


def signed_area(contour: Array) -> float:
    """By the shoelace formula [m²]; positive where the contour runs counter-clockwise."""
    x, y = contour.T
    return float(0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def counted_area(rectangles: list[Rectangle], n: int = 400) -> float:
    """By counting points of a grid that some rectangle covers [m²]."""
    low, high = np.min(rectangles, axis=0)[:2], np.max(rectangles, axis=0)[2:]
    x, y = np.meshgrid(*(a + (np.arange(n) + 0.5) / n * (b - a) for a, b in zip(low, high, strict=True)))
    covered = [(r[0] < x) & (x < r[2]) & (r[1] < y) & (y < r[3]) for r in rectangles]
    return float(np.any(covered, axis=0).mean() * np.prod(high - low))


def test_one_rectangle_is_its_own_outline() -> None:
    (outline,) = union_outlines([(-1.0, -2.0, 3.0, 4.0)])
    assert sorted(map(tuple, outline)) == [(-1.0, -2.0), (-1.0, 4.0), (3.0, -2.0), (3.0, 4.0)]
    assert signed_area(outline) == pytest.approx(24.0)


def test_three_walls_make_a_u_of_eight_corners() -> None:
    walls = [(-0.08, -0.08, 0.05, -0.06), (-0.08, 0.06, 0.05, 0.08), (0.05, -0.08, 0.07, 0.08)]
    (outline,) = union_outlines(walls)
    assert len(outline) == 8
    assert signed_area(outline) == pytest.approx(2 * 0.13 * 0.02 + 0.02 * 0.16)


def test_a_ring_of_boxes_has_a_hole() -> None:
    ring = [(0.0, 0.0, 3.0, 1.0), (0.0, 2.0, 3.0, 3.0), (0.0, 1.0, 1.0, 2.0), (2.0, 1.0, 3.0, 2.0)]
    outline, hole = union_outlines(ring)
    assert signed_area(outline) == pytest.approx(9.0)
    assert signed_area(hole) == pytest.approx(-1.0)


@pytest.mark.parametrize("seed", range(8))
def test_the_contours_enclose_the_area_that_the_rectangles_cover(seed: int) -> None:
    rng = np.random.default_rng(seed)
    low, size = rng.uniform(-1.0, 1.0, (5, 2)), rng.uniform(0.3, 1.0, (5, 2))
    rectangles = [
        (float(a[0]), float(a[1]), float(a[0] + s[0]), float(a[1] + s[1]))
        for a, s in zip(low, size, strict=True)
    ]
    area = sum(signed_area(contour) for contour in union_outlines(rectangles))
    assert_allclose(area, counted_area(rectangles), rtol=0.01)
