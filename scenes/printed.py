"""The printed faces of a scene's objects, and where they are."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.pose import Pose
from scenes.artwork import Artwork, draw_artwork
from scenes.colours import Colour
from scenes.description import SceneDescription
from scenes.prints import Print
from scenes.shapes import Box


@dataclass(frozen=True, slots=True, eq=False)
class PrintedFace:
    """The upper face of a box, with what is printed on it.

    Attributes:
        name: Name of the object.
        artwork: What is printed.
        size: Extent of the box [m].
        colour: Colour of the box.
    """

    name: str
    artwork: Artwork
    size: tuple[float, float, float]
    colour: Colour

    def at(self, world_from_object: Pose) -> Print:
        """The print where the object is."""
        object_from_print = Pose(np.array([0.0, 0.0, self.size[2]]), np.eye(3))
        return Print(self.artwork, *self.size[:2], world_from_object @ object_from_print, on=self.colour)


def printed_faces(description: SceneDescription) -> tuple[PrintedFace, ...]:
    """The faces of a scene's objects that something is printed on."""
    return tuple(
        PrintedFace(name, draw_artwork(item.print, item.size[:2]), item.size, item.colour)
        for name, item in description.objects.items()
        if isinstance(item, Box) and item.print is not None
    )
