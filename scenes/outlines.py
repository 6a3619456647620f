"""What perception is told about a scene's objects: their outlines as seen from above."""

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.detection import ObjectModel
from scenes.description import SceneDescription
from scenes.shapes import Box, Container, ObjectDescription


def object_models(description: SceneDescription) -> tuple[ObjectModel, ...]:
    """One model per object, in the order of the scene's file."""
    return tuple(_model(name, item) for name, item in description.objects.items())


def _model(name: str, item: ObjectDescription) -> ObjectModel:
    size, height, holes = _seen_from_above(item)
    return ObjectModel(
        name=name,
        outline=_rectangle(size),
        z=height,
        colour=np.array(item.colour),
        symmetry=4 if np.isclose(*size) else 2,
        base_z=0.0,
        holes=tuple(_rectangle(hole) for hole in holes),
    )


def _seen_from_above(item: ObjectDescription) -> tuple[tuple[float, float], float, list[tuple[float, float]]]:
    """Size, height and the sizes of the openings of the uppermost face [m]."""
    match item:
        case Box():
            return (item.size[0], item.size[1]), item.size[2], []
        case Container():
            return item.outer_size, item.height, [item.inner_size]


def _rectangle(size: tuple[float, float]) -> Array:
    """The corners of a rectangle about the origin, counter-clockwise, shape (4, 2)."""
    return np.asarray(np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) * np.array(size) / 2)
