"""The only way from a scene to its frames: through the picture that its camera takes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.frame import Frame
from perception import detect
from scenes import World, object_models


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """What the camera saw of a scene.

    Attributes:
        picture: Red, green, blue, uint8, shape (height, width, 3).
        detections: The objects that were found in it.
        missing: The objects that were looked for and not found.
    """

    picture: NDArray[np.uint8]
    detections: tuple[Detection, ...]
    missing: tuple[NotSeen, ...]

    @property
    def frames(self) -> dict[str, Frame]:
        """The task parameters: name of an object to its frame."""
        return {detection.name: detection.frame for detection in self.detections}

    def find(self, name: str) -> Detection | NotSeen:
        """The detection of an object, or why there is none."""
        found: dict[str, Detection | NotSeen] = {item.name: item for item in self.detections}
        found |= {item.name: item for item in self.missing}
        return found.get(name) or NotSeen(name, "the scene has no object of this name")


def perceive(world: World, *, covered: bool = False) -> View:
    """Take a picture of the scene and find the objects in it.

    Args:
        world: The scene in the simulator.
        covered: Whether something covers the camera's lens.
    """
    picture = world.take_picture(covered=covered)
    found = detect(picture, world.description.camera.camera, object_models(world.description))
    return View(
        picture,
        tuple(item for item in found if isinstance(item, Detection)),
        tuple(item for item in found if isinstance(item, NotSeen)),
    )
