"""What perception is told about a scene's objects: their outlines as seen from above."""

from dataclasses import replace

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.detection import ObjectModel
from cobot_lfd.marker import Marker
from scenes.artwork import MarkerPrint, marker_size
from scenes.description import SceneDescription
from scenes.feet import with_feet
from scenes.shapes import Assembly, Ball, Box, Container, ObjectDescription
from scenes.union import union_outlines

_N_CIRCLE = 8  # corners of the polygon that stands for a circle; its sides must not be too short to be seen
_SAME = 1e-9  # [m]
_SAME_HEIGHT = 1e-6  # [m]


def object_models(description: SceneDescription) -> tuple[ObjectModel, ...]:
    """One model for each object that the camera sees, in the order of the scene's file."""
    ground = np.array(description.table.colour)
    seen = {name: item for name, item in description.objects.items() if item.seen}
    return tuple(replace(object_model(name, item), ground=ground) for name, item in seen.items())


def object_model(name: str, item: ObjectDescription) -> ObjectModel:
    """What one object looks like from above."""
    outline, holes, z, base_z = _seen_from_above(item)
    return ObjectModel(
        name=name,
        outline=outline,
        z=z,
        colour=np.array(item.colour),
        symmetry=_N_CIRCLE if isinstance(item, Ball) else _symmetry(outline),
        base_z=base_z,
        is_round=isinstance(item, Ball),
        holes=tuple(holes),
        found_by=item.found_by,
        marker=_marker(name, item),
    )


def _marker(name: str, item: ObjectDescription) -> Marker | None:
    """The marker that is printed on an object, if there is one."""
    if not isinstance(item, Box) or not isinstance(item.print, MarkerPrint):
        return None
    return Marker(name, item.print.number, marker_size(item.size[:2]), item.size[2])


def _seen_from_above(item: ObjectDescription) -> tuple[Array, list[Array], float, Array]:
    """Outline [m], openings [m], height of the uppermost contour and of the foot below its corners [m]."""
    match item:
        case Box():
            return _rectangle(item.size[0], item.size[1]), [], item.size[2], np.zeros(4)
        case Container():
            rim, opening = _rectangle(*item.outer_size), _rectangle(*item.inner_size)
            return rim, [opening], item.height, np.zeros(4)
        case Ball():
            angles = 2 * np.pi * np.arange(_N_CIRCLE) / _N_CIRCLE
            radius = 0.5 * item.diameter
            same_area = radius * np.sqrt(2 * np.pi / _N_CIRCLE / np.sin(2 * np.pi / _N_CIRCLE))
            circle = same_area * np.column_stack([np.cos(angles), np.sin(angles)])
            return circle, [], radius, np.full(_N_CIRCLE, radius)
        case Assembly():
            tops = [box for box in item.boxes if box.high[2] > item.height - _SAME_HEIGHT]
            outline, *holes = union_outlines([(*box.low[:2], *box.high[:2]) for box in tops])
            floors = [(box.low, box.high) for box in item.boxes if box.colour not in (None, item.colour)]
            outline, feet = with_feet(outline, floors)
            return outline, [hole[::-1] for hole in holes], item.height, feet


def _rectangle(length: float, width: float) -> Array:
    """The corners of a rectangle about the origin, counter-clockwise, shape (4, 2)."""
    return np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) * [length / 2, width / 2]


def _symmetry(outline: Array) -> int:
    """Number of quarter or half turns within a full circle that bring an outline onto itself."""
    half, quarter = -outline, outline @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    return 4 if _same_corners(quarter, outline) else 2 if _same_corners(half, outline) else 1


def _same_corners(a: Array, b: Array) -> bool:
    distances = np.linalg.norm(a[:, None] - b, axis=2)
    return bool((distances.min(axis=1) < _SAME).all())
