"""The outline of boxes that stand side by side, as seen from above."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array

Rectangle = tuple[float, float, float, float]
"""Smallest x, smallest y, largest x, largest y [m]."""

_SAME = 1e-9  # [m]


def union_outlines(rectangles: Sequence[Rectangle]) -> list[Array]:
    """Contours of the union of rectangles [m], each of shape (n, 2), the one with the largest extent first.

    Outer contours run counter-clockwise, those of holes clockwise. The rectangles cut the plane into cells;
    the border consists of the cells' sides that have a covered cell on the left only.
    """
    xs = np.unique([value for r in rectangles for value in (r[0], r[2])])
    ys = np.unique([value for r in rectangles for value in (r[1], r[3])])
    covered = np.zeros((len(xs) + 1, len(ys) + 1), dtype=np.bool_)
    x_middle, y_middle = 0.5 * (xs[1:] + xs[:-1]), 0.5 * (ys[1:] + ys[:-1])
    for low_x, low_y, high_x, high_y in rectangles:
        inside_x, inside_y = (
            (low_x < x_middle) & (x_middle < high_x),
            (low_y < y_middle) & (y_middle < high_y),
        )
        covered[1:-1, 1:-1] |= inside_x[:, None] & inside_y
    loops = [_corners(xs[[i for i, _ in loop]], ys[[j for _, j in loop]]) for loop in _loops(_sides(covered))]
    return sorted(loops, key=lambda loop: -float(np.ptp(loop, axis=0).sum()))


def _sides(covered: NDArray[np.bool_]) -> dict[tuple[int, int], tuple[int, int]]:
    """From each corner of the border to the next, so that what is covered lies on the left."""
    following = {}
    for i, j in np.argwhere(covered):
        if not covered[i, j - 1]:
            following[i - 1, j - 1] = (i, j - 1)
        if not covered[i + 1, j]:
            following[i, j - 1] = (i, j)
        if not covered[i, j + 1]:
            following[i, j] = (i - 1, j)
        if not covered[i - 1, j]:
            following[i - 1, j] = (i - 1, j - 1)
    return {(int(a), int(b)): (int(c), int(d)) for (a, b), (c, d) in following.items()}


def _loops(following: dict[tuple[int, int], tuple[int, int]]) -> list[list[tuple[int, int]]]:
    loops = []
    while following:
        corner, loop = next(iter(following)), []
        while corner in following:
            loop.append(corner)
            corner = following.pop(corner)
        loops.append(loop)
    return loops


def _corners(x: Array, y: Array) -> Array:
    """A contour without the points that lie on its straight sides."""
    points = np.column_stack([x, y])
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    return points[np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]) > _SAME**2]
