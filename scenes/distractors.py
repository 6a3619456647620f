"""Things on the table that nobody was told of: the detector does not know them, nothing avoids them."""

from collections.abc import Iterator, Mapping

import numpy as np
from pybullet_utils.bullet_client import BulletClient

from cobot_lfd.arrays import Array
from cobot_lfd.errors import DescriptionError
from cobot_lfd.frame import Frame
from scenes.bodies import add_object
from scenes.colours import NAMED_COLOURS, Colour
from scenes.description import SceneDescription
from scenes.shapes import Box, Placement

_LENGTHS = (0.02, 0.06)  # [m] least and largest extent along each axis
_DENSITY = 400.0  # [kg/m³] of wood
_APART = 0.10  # [m] least distance of their middles from one another
_INSIDE = 0.85  # share of the picture in which they stand
_MOST_ATTEMPTS = 10_000


def add_distractors(
    client: BulletClient,
    description: SceneDescription,
    placed: Mapping[str, Frame],
    generator: np.random.Generator,
) -> tuple[int, ...]:
    """Add as many as the scene asks for, where they are seen and leave room; returns their body numbers.

    They are boxes of random size, in colours that no object of the scene has.

    Args:
        client: The simulation.
        description: The scene.
        placed: Where its objects stand.
        generator: Where the chance comes from.

    Raises:
        DescriptionError: If the table has no room for them.
    """
    colours = _other_colours(description)
    bodies = []
    for frame in _places(description, placed, generator):
        length, width, height = generator.uniform(*_LENGTHS, 3)
        box = Box(
            shape="box",
            size=(length, width, height),
            mass=_DENSITY * length * width * height,
            colour=colours[generator.integers(len(colours))],
            place=Placement(x=(0.0, 0.0), y=(0.0, 0.0)),
        )
        bodies.append(add_object(client, box, frame))
    return tuple(bodies)


def _other_colours(description: SceneDescription) -> list[Colour]:
    taken = {item.colour for item in description.objects.values()} | {description.table.colour}
    return [colour for colour in NAMED_COLOURS.values() if colour not in taken]


def _places(
    description: SceneDescription, placed: Mapping[str, Frame], generator: np.random.Generator
) -> Iterator[Frame]:
    """Frames that keep the scene's distance from its objects, and their own from one another."""
    others = [frame.position for frame in placed.values()]
    found: list[Array] = []
    attempts = 0
    while len(found) < description.distractors:
        attempts += 1
        if attempts > _MOST_ATTEMPTS:
            raise DescriptionError(
                f"scene '{description.title}': {description.distractors} distractors find no place on the "
                "table; ask for fewer."
            )
        point = _in_picture(description, generator)
        if _far_from(others, point, description.centre_distance) and _far_from(found, point, _APART):
            found.append(point)
            yield Frame(point, generator.uniform(-np.pi, np.pi))


def _in_picture(description: SceneDescription, generator: np.random.Generator) -> Array:
    """A point of the table that the camera sees, away from the picture's border [m]."""
    camera = description.camera.camera
    middle = 0.5 * (np.array([camera.width, camera.height]) - 1)
    return camera.to_plane(middle * (1 + _INSIDE * generator.uniform(-1.0, 1.0, 2)), 0.0)


def _far_from(points: list[Array], point: Array, distance: float) -> bool:
    return all(np.linalg.norm(point - other) >= distance for other in points)
