"""A picture of one object of a scene, alone on the table: what a person takes to show what it looks like."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.frame import Frame
from scenes.description import SceneDescription
from scenes.renderer import Renderer
from scenes.rendering import Picture
from scenes.world import World

_ANGLE = 0.45  # [rad] askew, so that no edge runs along the pixels
_AWAY = 5.0  # [m] where nothing is seen
_SAMPLES = 4  # Points of a pixel that are averaged at least.


@dataclass(frozen=True, slots=True, eq=False)
class Portrait:
    """A picture of one object.

    Attributes:
        picture: Red, green, blue, shape (height, width, 3).
        frame: Where the object was put.
    """

    picture: Picture
    frame: Frame


def take_portrait(description: SceneDescription, name: str, renderer: Renderer = "tiny") -> Portrait:
    """Put an object in the middle of what the scene's camera sees, take the rest away, and take a picture."""
    camera = description.camera.camera
    middle = camera.to_plane([0.5 * (camera.width - 1), 0.5 * (camera.height - 1)], 0.0)
    frame = Frame(middle, _ANGLE)
    samples = max(_SAMPLES, description.camera.samples)
    with World(description, 0, renderer=renderer) as world:
        for number, other in enumerate(description.objects):
            world.place(other, frame if other == name else Frame(np.array([_AWAY, number]), 0.0))
        picture = world.take_picture(camera=description.camera.model_copy(update={"samples": samples}))
    return Portrait(picture, frame)
