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
from perception.discovery.height import height_of_outline, lifted
from perception.discovery.polygon import middle, outline
from perception.discovery.propose import Thing, whole
from perception.discovery.template import common_silhouette, half_side
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
    agree = {0: frames[0]} | {
        n: item.frame
        for n, item in enumerate(found, start=1)
        if isinstance(item, Detection) and _same(item.frame, frames[n], model.symmetry)
    }
    if len(agree) - 1 < _LEAST_SEEN * len(found):
        return model
    turned = replace(model, symmetry=1, found_by="features", appearance=face)
    return _upright(
        turned, pictures[0], [(whole(pictures[n], things[n]), f) for n, f in agree.items()], camera
    )


def _upright(
    model: ObjectModel, picture: Picture, seen: Sequence[tuple[Thing, Frame]], camera: Camera
) -> ObjectModel:
    """The model with the height and the outline that its face and the walls below it have together.

    Args:
        model: As the face was found.
        picture: The first picture.
        seen: In the pictures in which it was found, the first among them, all that belongs to the thing and
            where the face is.
        camera: The camera.
    """
    things = [thing for thing, _ in seen]
    frames = [lifted(frame, camera, model.z, by=-model.z) for _, frame in seen]
    z = height_of_outline(things, frames, camera)
    frames = [lifted(frame, camera, 0.0, by=z) for frame in frames]
    corners = outline(common_silhouette(things, camera, frames, z, half_side(things, frames, camera)))
    if corners is None:
        return model
    shift = Frame(middle(corners), 0.0)
    corners, frame = shift.localise(corners), frames[0] @ shift
    try:
        face = learn_appearance(
            model.name, picture, camera, z, camera.project(on_plane(frame.apply(corners), z)), frame=frame
        )
    except ValueError:  # Not all of it is in the picture.
        return model
    feet = np.full(len(corners), model.base_z.min())
    return replace(model, outline=corners, z=z, base_z=feet, appearance=face)


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
