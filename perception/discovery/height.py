"""How high a thing's upper side is above the table, told by how much of the walls below it is seen.

Whatever the outline, what is seen of an upright thing is its upper side and that side's images at all heights
below it, down to the table. So the height is the one at which these images together cover the whole region.
"""

from collections.abc import Callable, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.frame import Frame
from perception.discovery.propose import Thing
from perception.discovery.template import common_silhouette, drawn, half_side

_HEIGHTS = (0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09, 0.1, 0.11, 0.12)
"""That are tried first [m]."""
_FINER = (0.005, 0.0025)  # Steps to either side of the best that are tried then [m].
_N_LEVELS = 6  # Of the walls, from the upper side down to the table.
_MARGIN = 4  # Around a region [px].
_NO_WORSE = 1.02  # The lowest of the heights that explain the regions as well but for this factor is taken.


def height(tops: Sequence[Thing], whole: Sequence[Thing], camera: Camera) -> tuple[float, float]:
    """The height of upper sides.

    Args:
        tops: The upper sides of a thing in several pictures.
        whole: The regions that show the thing in the same pictures.
        camera: The camera.

    Returns:
        The height [m], and how much of the regions it does not explain, as a share of their area.
    """
    pairs = list(zip(tops, whole, strict=True))
    z, wrong = _best(lambda z: sum(_unexplained(top, thing, camera, z) for top, thing in pairs))
    return z, wrong / sum(thing.region.area for thing in whole)


def height_of_outline(whole: Sequence[Thing], frames: Sequence[Frame], camera: Camera) -> float:
    """The height of upper sides that no brightness tells from the walls, as something is printed on them.

    The walls are seen on another side wherever the thing lies. So what the regions have in common, laid on
    one another at the right height, is the upper side; it and its walls explain all regions there.

    Args:
        whole: The regions that show the thing in several pictures.
        frames: Where it is in each of them, as it looks on the table's plane.
        camera: The camera.
    """
    half = half_side(whole, frames, camera)

    def unexplained(z: float) -> float:
        raised = [lifted(frame, camera, 0.0, by=z) for frame in frames]
        upper = common_silhouette(whole, camera, raised, z, half)
        return sum(
            _unexplained(drawn(upper, thing, camera, frame, _MARGIN), thing, camera, z)
            for thing, frame in zip(whole, raised, strict=True)
        )

    return _best(unexplained)[0]


def lifted(frame: Frame, camera: Camera, z: float, *, by: float) -> Frame:
    """The frame that is ``by`` [m] higher than one at height ``z`` and looks the same."""
    return Frame(camera.to_plane(camera.project([*frame.position, z]), z + by), frame.angle)


def _best(unexplained: Callable[[float], float]) -> tuple[float, float]:
    """The lowest of the heights that explain about as much as any, and how much that leaves unexplained."""
    wrong: dict[float, float] = {}
    heights: tuple[float, ...] = _HEIGHTS
    for step in (*_FINER, None):
        wrong |= {z: unexplained(z) for z in heights if z >= 0}
        best = min(wrong, key=wrong.__getitem__)
        heights = () if step is None else (best - step, best + step)
    lowest = min(z for z, value in wrong.items() if value <= _NO_WORSE * wrong[best] + 1e-9)
    return lowest, wrong[lowest]


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
