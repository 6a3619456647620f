"""A polygon around a silhouette: its sides are lines through many points, its corners where they meet."""

import cv2
import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from perception.discovery.template import Template

_TOLERANCE = 0.0012  # Distance of the contour from a side [m]; less follows the pixels' stairs.
_SHORTEST = 0.006  # A shorter side between two others is a corner that the pixels have rounded [m].
_NEARLY_PARALLEL = 0.35  # Sine of the angle between two sides below which their corner is not moved.
_SYMMETRIES = (8, 6, 5, 4, 3, 2)  # Turns in a full circle that are tried; 8 stands for a round thing, too.
_CELL = 0.0005  # Side of the cells in which a polygon and its turned self are compared [m].
_THICK = 5  # Cells; a difference that is nowhere thicker is none: outlines are not known better.
_FARTHEST = 0.004  # By which a corner is moved at most [m].


def outline(template: Template) -> Array | None:
    """Corners of the polygon [m], counter-clockwise, shape (n, 2); None where there is no contour."""
    mask = (template.cover > 0.5).astype(np.uint8)
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    if not contours:
        return None
    cells = max(contours, key=cv2.contourArea)[:, 0].astype(np.float64)
    points = template.to_metres(_pushed_to_border(cells))
    tolerance = np.float32(_TOLERANCE)
    corners = cv2.approxPolyDP(points.astype(np.float32), float(tolerance), closed=True)[:, 0]
    if len(corners) < 3:
        return None
    chosen = [int(np.linalg.norm(points - corner, axis=1).argmin()) for corner in corners]
    sharp = _without_short_sides(_sharpened(points, chosen))
    return sharp if _signed_area(sharp) > 0 else sharp[::-1]


def middle(corners: Array) -> Array:
    """The centre of a polygon's area [m], shape (2,)."""
    x, y = corners.T
    nx, ny = np.roll(corners, -1, axis=0).T
    cross = x * ny - nx * y
    return np.asarray([((x + nx) * cross).sum(), ((y + ny) * cross).sum()]) / (3 * float(cross.sum()))


def symmetry(corners: Array) -> int:
    """Number of turns within a full circle, about the origin, that look the same."""
    return next((k for k in _SYMMETRIES if _looks_the_same(corners, 2 * np.pi / k)), 1)


def _looks_the_same(corners: Array, angle: float) -> bool:
    """Whether a polygon and its turned self differ nowhere by more than outlines are wrong."""
    half = float(np.linalg.norm(corners, axis=1).max()) + 2 * _CELL
    n = 2 * round(half / _CELL)
    drawn = []
    for turned in (corners, corners @ Frame(np.zeros(2), angle).rotation.T):
        mask = np.zeros((n, n), np.uint8)
        cells = np.rint((turned + half) / _CELL).astype(np.int32)
        drawn.append(cv2.fillPoly(mask, [cells], 1))
    difference = np.asarray(drawn[0] != drawn[1], dtype=np.uint8)
    return not cv2.erode(difference, np.ones((_THICK, _THICK), np.uint8)).any()


def _pushed_to_border(cells: Array) -> Array:
    """Middles of border cells to the border, half a cell outwards."""
    ahead, behind = np.roll(cells, -3, axis=0), np.roll(cells, 3, axis=0)
    along = ahead - behind
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    outwards = np.column_stack([along[:, 1], -along[:, 0]])
    side = 1.0 if _signed_area(cells) > 0 else -1.0
    return np.asarray(cells + 0.5 * side * outwards)


def _sharpened(points: Array, corners: list[int]) -> Array:
    """Corners as intersections of lines fitted to the points between them, shape (n, 2)."""
    n = len(corners)
    lines = [_line(_between(points, corners[i], corners[(i + 1) % n])) for i in range(n)]
    return np.array([_meeting(lines[i - 1], lines[i], points[corners[i]]) for i in range(n)])


def _without_short_sides(corners: Array) -> Array:
    """The polygon with each short side replaced by the corner at which its neighbours meet."""
    while len(corners) > 3:
        lengths = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
        met = [_beyond(corners, int(i)) for i in np.argsort(lengths) if lengths[i] < _SHORTEST]
        place = next((pair for pair in met if pair is not None), None)
        if place is None:
            break
        i, corner = place
        corners = np.roll(corners, -i, axis=0)
        corners = np.vstack([corner, corners[2:]])
    return corners


def _beyond(corners: Array, side: int) -> tuple[int, Array] | None:
    """A side's number and the corner that may stand for it; None where its neighbours do not meet near it."""
    before, start, end, after = (corners[(side + k) % len(corners)] for k in (-1, 0, 1, 2))
    first, second = (start, start - before), (end, after - end)
    u, v = (line[1] / max(float(np.linalg.norm(line[1])), 1e-12) for line in (first, second))
    middle = 0.5 * (start + end)
    met = _meeting((start, u), (end, v), middle)
    outwards = (met - start) @ u > 0 and (met - end) @ v < 0
    return (side, met) if outwards else None


def _between(points: Array, start: int, end: int) -> Array:
    """The points from one index to another around the contour, without those near the ends."""
    indices = np.arange(start, end if end > start else end + len(points)) % len(points)
    trim = min(len(indices) // 5, 6)
    return np.asarray(points[indices[trim : len(indices) - trim]])


def _line(points: Array) -> tuple[Array, Array]:
    """A point and a direction of the line through points."""
    middle = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - middle, full_matrices=False)
    return middle, axes[0]


def _meeting(first: tuple[Array, Array], second: tuple[Array, Array], corner: Array) -> Array:
    """Where two lines meet; the corner itself where they hardly do."""
    (a, u), (b, v) = first, second
    sine = u[0] * v[1] - u[1] * v[0]
    if abs(sine) < _NEARLY_PARALLEL:
        return corner
    offset = b - a
    met = a + u * (offset[0] * v[1] - offset[1] * v[0]) / sine
    return np.asarray(met if np.linalg.norm(met - corner) < _FARTHEST else corner)


def _signed_area(corners: Array) -> float:
    x, y = corners.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
