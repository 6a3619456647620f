"""The only way from a scene to its frames: through the picture that its camera takes."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.app.sought import sought
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.frame import Frame
from cobot_lfd.method import PathModel
from cobot_lfd.recognition import Recognition
from perception import detect
from perception.discovery import recognise_frames
from scenes import SceneDescription, World, object_model


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """What the camera saw of a scene.

    Attributes:
        picture: Red, green, blue, uint8, shape (height, width, 3).
        detections: The objects that were found in it.
        missing: The objects that were looked for and not found.
        others: Objects that were found, but have nothing to do with the task.
        learnt: The frames that a model recognises by itself, or why not; none where it knows none.
    """

    picture: NDArray[np.uint8]
    detections: tuple[Detection, ...]
    missing: tuple[NotSeen, ...]
    others: tuple[Detection, ...] = ()
    learnt: tuple[Detection | NotSeen, ...] = ()

    @property
    def frames(self) -> dict[str, Frame]:
        """The task parameters: name of an object to its frame."""
        return {detection.name: detection.frame for detection in self.detections}

    def find(self, name: str) -> Detection | NotSeen:
        """The detection of an object, or why there is none."""
        found: dict[str, Detection | NotSeen] = {item.name: item for item in self.detections}
        found |= {item.name: item for item in self.missing}
        return found.get(name) or NotSeen(name, "the scene has no object of this name")

    def find_for(self, model: PathModel) -> dict[str, Detection | NotSeen]:
        """What was seen of each frame of a model: by its own recognition, or as an object of the scene."""
        if model.recognition is None:
            return {name: self.find(name) for name in model.frame_kinds}
        recognised = {item.name: item for item in self.learnt}
        return {name: recognised[name] for name in model.frame_kinds}


def perceive(world: World, *, covered: bool = False, recognition: Recognition | None = None) -> View:
    """Take a picture of the scene and find the objects in it; what stands outside its view is known.

    Args:
        world: The scene in the simulator.
        covered: Whether something covers the camera's lens.
        recognition: How a model recognises its frames by itself; None where it does not.
    """
    scene = world.description
    picture = world.take_picture(covered=covered)
    found = detect(picture, scene.camera.camera, sought(scene, world.renderer))
    task_relevant = [item for item in found if scene.objects[item.name].frame]
    return View(
        picture,
        (*(item for item in task_relevant if isinstance(item, Detection)), *_known(scene)),
        tuple(item for item in task_relevant if isinstance(item, NotSeen)),
        tuple(item for item in found if isinstance(item, Detection) and item not in task_relevant),
        () if recognition is None else recognise_frames(picture, scene.camera.camera, recognition),
    )


def _known(scene: SceneDescription) -> Iterator[Detection]:
    """The objects out of the camera's view, which stand where the scene's file says."""
    for name, frame in scene.known_frames.items():
        model = object_model(name, scene.objects[name])
        corners = np.column_stack([frame.apply(model.outline), np.full(len(model.outline), model.z)])
        contour = scene.camera.camera.project(corners)
        yield Detection(name, frame, 1, np.zeros((3, 3)), 1.0, contour)
