"""How high a thing's upper side is above the table, told by how much of the walls below it is seen.

Whatever the outline, what is seen of an upright thing is its upper side and that side's images at all heights
below it, down to the table. So the height is the one at which these images together cover the whole region.
"""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from perception.discovery.propose import Thing

_HEIGHTS = np.arange(0.0, 0.1201, 0.0025)  # That are tried [m].
_N_LEVELS = 6  # Of the walls, from the upper side down to the table.
_MARGIN = 4  # Around a region [px].
_NO_WORSE = (
    1.02  # Of several heights that explain the regions as well but for this factor the lowest is taken.
)


def height(tops: Sequence[Thing], whole: Sequence[Thing], camera: Camera) -> tuple[float, float]:
    """The height of upper sides.

    Args:
        tops: The upper sides of a thing in several pictures.
        whole: The regions that show the thing in the same pictures.
        camera: The camera.

    Returns:
        The height [m], and how much of the regions it does not explain, as a share of their area.
    """
    wrong = np.array(
        [sum(_unexplained(t, w, camera, z) for t, w in zip(tops, whole, strict=True)) for z in _HEIGHTS]
    )
    lowest = int(np.flatnonzero(wrong <= _NO_WORSE * wrong.min() + 1e-9)[0])
    return float(_HEIGHTS[lowest]), float(wrong[lowest] / sum(thing.region.area for thing in whole))


def _unexplained(top: Thing, whole: Thing, camera: Camera, z: float) -> float:
    """Pixels of a region that an upper side at a height with walls below it does not cover, or too many."""
    corner = whole.corner - _MARGIN
    rows, columns = np.array(whole.mask.shape) + 2 * _MARGIN
    square = np.array([[0, 0], [columns - 1, 0], [columns - 1, rows - 1], [0, rows - 1]], dtype=np.float64)
    upper, region = (_in_box(thing, corner, rows, columns) for thing in (top, whole))
    covered = upper.copy()
    if z > 0:
        on_top = camera.to_plane(square + corner, z)
        for level in np.linspace(0.0, z, _N_LEVELS, endpoint=False):
            below = camera.project(np.column_stack([on_top, np.full(4, level)])) - corner
            covered |= _moved(upper, square, below)
    return float(np.count_nonzero(covered != region))


def _in_box(thing: Thing, corner: NDArray[np.int_], rows: int, columns: int) -> NDArray[np.uint8]:
    """A thing's mask in a larger box, given by the picture's place of its first pixel and its size."""
    box = np.zeros((rows, columns), np.uint8)
    x, y = thing.corner - corner
    height, width = thing.mask.shape
    box[y : y + height, x : x + width] = thing.mask
    return box


def _moved(mask: NDArray[np.uint8], square: Array, moved: Array) -> NDArray[np.uint8]:
    """The mask as four corners of its box move."""
    change = cv2.getPerspectiveTransform(square.astype(np.float32), moved.astype(np.float32))
    rows, columns = mask.shape
    return np.asarray(
        cv2.warpPerspective(mask, change, (columns, rows), flags=cv2.INTER_NEAREST), dtype=np.uint8
    )
