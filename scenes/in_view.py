"""What can be told from boxes alone: whether anything of them, or of their shadows, is in a picture."""

from itertools import product

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from scenes.imperfections import ideal_camera
from scenes.view import CameraDescription, Light

_MARGIN = 0.01  # [m] by which what is drawn may be larger than its box
_LOWEST = -0.01  # [m]; what a shadow can be seen on lies above this: the table's top and what stands on it
_BORDER = 2.0  # [px] around the picture


def could_be_seen(boxes: Array, seen: CameraDescription, light: Light) -> bool:
    """Whether something inside of boxes, or its shadow, could be in a picture; where in doubt it could.

    Args:
        boxes: Two opposite corners of each box, whose sides are parallel to the world's axes [m], (K, 2, 3).
        seen: The camera.
        light: The light.
    """
    camera = ideal_camera(seen.camera)
    grown = boxes + _MARGIN * np.array([[-1.0], [1.0]])
    return any(not _outside(camera, np.vstack([c, *_shadows(c, light)])) for c in map(_corners, grown))


def _corners(box: Array) -> Array:
    """The corners of a box, shape (8, 3)."""
    return np.array([[box[i, 0], box[j, 1], box[k, 2]] for i, j, k in product((0, 1), repeat=3)])


def _shadows(corners: Array, light: Light) -> tuple[Array, ...]:
    """Where corners throw their shadows, by a lamp that is far away, and by one at its distance."""
    if not light.shadow:
        return ()
    direction = np.array(light.direction)
    lamp = light.distance * direction / np.linalg.norm(direction)
    height = (corners[:, 2:] - _LOWEST).clip(min=0.0)
    by_sun = corners - height / direction[2] * direction
    above = np.maximum(lamp[2] - corners[:, 2:], 1e-3)  # what is as high as the lamp throws an endless shadow
    return by_sun, corners + height / above * (corners - lamp)


def _outside(camera: Camera, points: Array) -> bool:
    """Whether all points lie on the far side of one of the planes that bound what a camera sees."""
    x, y, z = camera.world_from_camera.inverse().apply(points).T
    (fx, _, cx), (_, fy, cy), _ = camera.matrix
    left, top = fx * x + (cx + _BORDER) * z, fy * y + (cy + _BORDER) * z
    right, bottom = fx * x + (cx - camera.width - _BORDER) * z, fy * y + (cy - camera.height - _BORDER) * z
    return any(bool(side.all()) for side in (left < 0, top < 0, right > 0, bottom > 0, z < 0))
