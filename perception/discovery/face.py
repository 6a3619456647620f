"""What is on a thing's upper face, where that tells its direction: local features, learnt from one picture.

An outline with symmetries does not tell which way a thing points; what is printed on it may. The face is
learnt from one picture of the thing and looked for in the others by its features. Only if it is found there,
at the places that the outline tells, the thing is recognised by it from then on.
"""

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np

from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, ObjectModel
from cobot_lfd.frame import Frame
from perception.discovery.propose import Thing
from perception.feature_detector import FeatureDetector
from perception.picture import Picture
from perception.reference import learn_appearance
from perception.rigid import on_plane

_LEAST_VARIED = 12.0  # Standard deviation of brightness on a face that may carry anything [0..255].
_MOST_APART = 0.006, np.deg2rad(4.0)  # Of what features and outline tell [m], [rad].
_LEAST_SEEN = 0.8  # Share of the pictures in which the features must agree with the outline.


def with_face(
    model: ObjectModel,
    pictures: Sequence[Picture],
    things: Sequence[Thing],
    frames: Sequence[Frame],
    camera: Camera,
) -> ObjectModel:
    """The model, recognised by its face if that tells more than its outline.

    Args:
        model: What the thing looks like as an outline.
        pictures: Pictures that show it; the face is learnt from the first.
        things: The region that shows it in each of them.
        frames: Where the outline is in each of them.
        camera: The camera.
    """
    if model.symmetry == 1 or not all(_varied(p, t) for p, t in zip(pictures, things, strict=True)):
        return model
    region = camera.project(on_plane(frames[0].apply(model.outline), model.z))
    try:
        face = learn_appearance(model.name, pictures[0], camera, model.z, region, frame=frames[0])
    except ValueError:  # The region is too small, or not all of it is in the picture.
        return model
    detector = FeatureDetector((face,))
    found = [detector.detect(picture, camera)[0] for picture in pictures[1:]]
    agree = [
        isinstance(item, Detection) and _same(item.frame, frame, model.symmetry)
        for item, frame in zip(found, frames[1:], strict=True)
    ]
    if np.mean(agree) < _LEAST_SEEN:
        return model
    return replace(model, symmetry=1, found_by="features", appearance=face)


def _varied(picture: Picture, thing: Thing) -> bool:
    """Whether there is something on the face, well inside its border."""
    x, y = thing.corner
    rows, columns = thing.mask.shape
    brightness = picture[y : y + rows, x : x + columns].astype(np.float64).mean(axis=2)
    core = cv2.erode(thing.mask.astype(np.uint8), np.ones((7, 7), np.uint8), borderValue=0) > 0
    return bool(core.any() and brightness[core].std() > _LEAST_VARIED)


def _same(frame: Frame, other: Frame, symmetry: int) -> bool:
    """Whether two poses are the same, but for turns in which the outline looks the same."""
    turn = 2 * np.pi / symmetry
    apart = np.mod(frame.angle - other.angle + turn / 2, turn) - turn / 2
    near = np.linalg.norm(frame.position - other.position) < _MOST_APART[0]
    return bool(near and abs(apart) < _MOST_APART[1])
