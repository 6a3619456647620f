"""The learnt frames in a new picture, each by its parts."""

import numpy as np

from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.recognition import LearntFrame, Recognition
from perception.discovery.recognise import recognise
from perception.picture import Picture


def recognise_frames(
    picture: Picture, camera: Camera, recognition: Recognition
) -> tuple[Detection | NotSeen, ...]:
    """Find learnt frames in a picture.

    Args:
        picture: Red, green, blue, shape (height, width, 3).
        camera: The camera that took it; it need not be the one that took the demonstrations' pictures.
        recognition: How the frames are recognised.

    Returns:
        For each frame what was seen, or why not, in the frames' order; a frame that never moves is known.

    Raises:
        ValueError: If the picture is not one of this camera.
    """
    models = [part.model for frame in recognition.frames for part in frame.parts] + [*recognition.others]
    seen = {item.name: item for item in recognise(picture, camera, models)}
    return tuple(_find(frame, camera, seen) for frame in recognition.frames)


def _find(frame: LearntFrame, camera: Camera, seen: dict[str, Detection | NotSeen]) -> Detection | NotSeen:
    """One frame: where it always is, or where the first of its parts that is seen says."""
    if frame.fixed is not None:
        place = camera.project([[*frame.fixed.position, 0.0]])
        return Detection(frame.name, frame.fixed, 1, np.zeros((3, 3)), 1.0, place)
    first = seen[frame.parts[0].model.name]
    for part in frame.parts:
        found = seen[part.model.name]
        # Seen from a part that looks the same when turned, the frame might be on either side of it.
        if isinstance(found, Detection) and (part is frame.parts[0] or part.model.symmetry == 1):
            pose = found.frame @ part.thing_from_frame
            return Detection(
                frame.name, pose, found.symmetry, found.covariance, found.confidence, found.contour
            )
    return NotSeen(frame.name, first.reason if isinstance(first, NotSeen) else "none of its parts was seen.")
