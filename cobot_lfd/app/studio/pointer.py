"""From the mouse on the page to the place in the world where a person wants the tool."""

import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.arrays import Array

_STEEP = 0.05  # sine of the angle between ray and plane below which the ray counts as parallel to it
_FAR = 2.0  # [m] from the camera beyond which a ray is not followed


def on_plane(camera: ArrayLike, through: ArrayLike, height: float) -> Array | None:
    """Where the ray from the camera through a point meets the horizontal plane at a height.

    Args:
        camera: The camera's centre [m], shape (3,).
        through: A point on the ray [m], shape (3,).
        height: Of the plane [m].

    Returns:
        The place [m], shape (3,); None where the ray looks along the plane, away from it or too far.
    """
    start = np.asarray(camera, dtype=np.float64)
    ray = np.asarray(through, dtype=np.float64) - start
    ray /= np.linalg.norm(ray)
    if abs(ray[2]) < _STEEP:
        return None
    length = (height - start[2]) / ray[2]
    if not 0.0 < length < _FAR + abs(start[2]) + float(np.linalg.norm(start[:2])):
        return None
    return np.asarray(start + length * ray)


class Grab:
    """A drag, from the press of the button to its release.

    Attributes:
        tab: Who drags.
        grabbed: The point that was taken hold of [m], shape (3,).
    """

    def __init__(self, tab: int, grabbed: ArrayLike, tool: Array) -> None:
        """Remember where the tool was taken hold of.

        Args:
            tab: Number of the tab.
            grabbed: The point under the pointer [m], shape (3,).
            tool: Where the tool was [m], shape (3,).
        """
        self.tab = tab
        self.grabbed = np.asarray(grabbed, dtype=np.float64)
        self._offset = self.grabbed - tool

    def goal(self, camera: ArrayLike, pointer: ArrayLike, *, guide: bool) -> Array:
        """Where the tool is wanted [m], shape (3,).

        Args:
            camera: The page's camera [m], shape (3,).
            pointer: The pointer on the plane through the grabbed point that faces the camera [m], shape (3,).
            guide: Whether the tool keeps its height, so that the pointer is taken to move in that plane.
        """
        place = on_plane(camera, pointer, self.grabbed[2]) if guide else None
        return np.asarray(pointer if place is None else place, dtype=np.float64) - self._offset
