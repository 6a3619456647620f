"""Things that nothing but their texture tells from the table: local features that move rigidly together.

Features of one picture are looked for in the others. Where many of them agree on one motion of the table's
plane, and other pictures agree on motions of the same features, these lie on one thing. What does not move is
left out: the table's own texture and the parked arm are no candidates beside the base.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen, ObjectModel
from cobot_lfd.frame import Frame
from perception.discovery.propose import Thing
from perception.feature_detector import FeatureDetector
from perception.foreground import foreground_parts
from perception.keypoints import FeatureKind, Keypoints, find_keypoints, nearest
from perception.picture import Picture
from perception.pose_votes import vote
from perception.reference import learn_appearance

_KIND: FeatureKind = "sift"  # ORB takes one of many alike corners for another too often.
_MOST_RATIO = 0.85  # Of the distances to the two features that are most like one; above, it is like any.
_TOLERANCE = 0.002  # How far a feature may be from where the motion of its thing puts it [m].
_FEWEST = 8  # Features that agree on a motion; fewer may do so by chance.
_N_THINGS = 6  # Motions that are looked for in a pair of pictures.
_LEAST_SHARED = 0.5  # Of a motion's features, with those of another picture's, if they are of one thing.
_STILL = 0.002  # What moves less does not move [m].
_MARGIN = 7  # Around things that are known already; their edges have features, too [px].
_MIDDLE_HALF = (25, 75)  # Percentiles of a thing's colours between which its mean is taken.


@dataclass(frozen=True, slots=True, eq=False)
class _Points:
    """The features of a picture that lie on nothing known, and where they are on the table."""

    found: Keypoints
    world: Array
    ahead: Array

    def take(self, chosen: NDArray[np.bool_]) -> "_Points":
        found = self.found
        kept = Keypoints(found.places[chosen], found.directions[chosen], found.descriptors[chosen])
        return _Points(kept, self.world[chosen], self.ahead[chosen])


def textured(
    pictures: Sequence[Picture],
    camera: Camera,
    known: Sequence[Sequence[Thing]],
) -> list[ObjectModel]:
    """The moving things that are told by features alone, each as at least two pictures show it.

    Args:
        pictures: A picture of each demonstration.
        camera: The camera that took them.
        known: What is known already in each picture; features on it are left out.

    Returns:
        Their faces, taken to lie on the table; in the order in which they were found.
    """
    points = [_unknown(picture, camera, things) for picture, things in zip(pictures, known, strict=True)]
    models = []
    for n, picture in enumerate(pictures[:-1]):
        for members in _things(points[n], points[n + 1 :]):
            model = _model(picture, camera, points[n].found.places[members])
            if model is not None and model.appearance is not None:
                detector = FeatureDetector((model.appearance,), _KIND)
                seen = [detector.detect(other, camera)[0] for other in pictures[n + 1 :]]
                if any(isinstance(item, Detection) for item in seen):
                    models.append(model)
                    points[n + 1 :] = map(_off, points[n + 1 :], seen)
    return models


def _unknown(picture: Picture, camera: Camera, things: Sequence[Thing]) -> _Points:
    grey = np.asarray(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY), np.uint8)
    covered = np.zeros(grey.shape, np.uint8)
    for thing in things:
        (x, y), (rows, columns) = thing.corner, thing.mask.shape
        covered[y : y + rows, x : x + columns] |= thing.mask.astype(np.uint8)
    covered = np.asarray(cv2.dilate(covered, np.ones((2 * _MARGIN + 1,) * 2, np.uint8)))
    parts = [part for part in foreground_parts(grey) if not covered[part].all()]
    found = find_keypoints(grey, _KIND, parts)
    world = camera.to_plane(found.places, 0.0)
    ahead = camera.to_plane(found.places + found.directions, 0.0) - world
    ahead /= np.maximum(np.linalg.norm(ahead, axis=-1, keepdims=True), 1e-12)
    columns, rows = np.rint(found.places).astype(int).T
    inside = covered[np.clip(rows, 0, camera.height - 1), np.clip(columns, 0, camera.width - 1)] > 0
    return _Points(found, world, ahead).take(~inside)


def _things(here: _Points, others: Sequence[_Points]) -> list[NDArray[np.int_]]:
    """Numbers of the features of each thing that moved from one picture to at least one of the others."""
    groups: list[set[int]] = []
    for motion in sorted((m for other in others for m in _motions(here, other)), key=len, reverse=True):
        mate = next((g for g in groups if len(g & motion) > _LEAST_SHARED * len(motion)), None)
        if mate is None:
            groups.append(motion)
        else:
            mate |= motion
    return [np.array(sorted(group)) for group in groups]


def _motions(here: _Points, there: _Points) -> list[set[int]]:
    """The features, by their numbers in the first picture, that moved together to the second; each once."""
    number, ratios = nearest(there.found.descriptors, here.found.descriptors, _KIND)
    chosen = ratios < _MOST_RATIO
    if chosen.sum() < _FEWEST:
        return []
    number, world, ahead = number[chosen], there.world[chosen], there.ahead[chosen]
    start = here.world[number]
    motions = []
    for pose in vote(start, here.ahead[number], world, ahead, tolerance=_TOLERANCE, most=_N_THINGS):
        agree = np.linalg.norm(pose.apply(start) - world, axis=1) < _TOLERANCE
        moved = bool(agree.any()) and _moves(pose, start[agree])
        if moved and len(set(number[agree])) >= _FEWEST:
            motions.append({int(i) for i in number[agree]})
    return motions


def _moves(pose: Frame, points: Array) -> bool:
    return bool(np.linalg.norm(pose.apply(points) - points, axis=1).max() > _STILL)


def _off(points: _Points, seen: Detection | NotSeen) -> _Points:
    """A picture's features without those on a thing that is found already."""
    if isinstance(seen, NotSeen):
        return points
    contour = seen.contour.astype(np.float32)
    outside = [cv2.pointPolygonTest(contour, place, measureDist=True) for place in points.found.places]
    return points.take(np.array(outside) < -_MARGIN)


def _model(picture: Picture, camera: Camera, places: Array) -> ObjectModel | None:
    """A face as the hull of its features, in the middle of its frame; None if there is too little of it."""
    region = np.asarray(cv2.convexHull(places.astype(np.float32))[::-1, 0], np.float64)
    try:
        face = learn_appearance("thing", picture, camera, 0.0, region)
    except ValueError:  # The region is too small, or not all of it is in the picture.
        return None
    low, high = np.percentile(face.image.reshape(-1, 3), _MIDDLE_HALF, axis=0)
    return ObjectModel(
        name="thing",
        outline=face.outline,
        z=0.0,
        colour=0.5 * (low + high) / 255.0,
        symmetry=1,
        base_z=np.zeros(len(face.outline)),
        found_by="features",
        appearance=face,
    )
