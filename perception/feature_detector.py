"""Finds objects by what is on their faces: any object with some texture, learnt from one picture of it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.appearance import Appearance
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.frame import Frame
from perception.blurred_picture import BlurredPicture
from perception.brightness import brightness
from perception.face import Face
from perception.face_choice import contour, is_certain, share, told
from perception.face_fit import FaceFit, fit_face
from perception.face_search import Search
from perception.foreground import Part, foreground_parts, without
from perception.keypoints import FeatureKind, Keypoints, find_keypoints, nearest
from perception.picture import Picture, check_picture
from perception.pose_votes import vote

_MOST_RATIO = 0.9  # Of the distances to the two points that are most like one; above, it is like any.
_TOLERANCE = 3.0  # How far a point may be from where a pose puts it, in pixels of the face's map.
_CLOSER = 1.4  # How many times larger what is left is seen at a second look.
_N_VOTED = 6  # Poses tried for each object, and for each that looks the same.
_N_SEARCHED = 3  # The same where points did not find it.
_DARKEST = 12.0  # Mean brightness below which a picture shows nothing [0..255].


@dataclass(frozen=True, slots=True, eq=False)
class FeatureDetector:
    """Finds objects by what is on their faces.

    Points of the picture that look like points of a face vote for poses; where noise, blur or a cover leave
    too few of them, the whole face is looked for at all places and angles. Each likely pose is then fitted to
    all pixels of the face, which makes it precise and tells false alarms.

    Attributes:
        appearances: What to look for. Faces that look the same are told apart by their places only: they are
            named from left to right as the robot sees them (largest y first).
        kind: What describes the points.
    """

    appearances: tuple[Appearance, ...]
    kind: FeatureKind = "sift"

    def detect(self, picture: Picture, camera: Camera) -> tuple[Detection | NotSeen, ...]:
        """For each object what was seen in a picture, or why not, in the appearances' order."""
        check_picture(picture, camera)
        image = brightness(picture)
        if image.mean() < _DARKEST:
            dark = "the picture is too dark; is the camera covered?"
            return tuple(NotSeen(each.name, dark) for each in self.appearances)
        groups = _alike(self.appearances)
        tried = _Looking(image, camera, self.kind).for_all(groups)
        said = {
            name: item
            for group, fits, kept in zip(groups, tried, share(groups, tried), strict=True)
            for name, item in told(group, camera, fits, kept).items()
        }
        return tuple(said[appearance.name] for appearance in self.appearances)


def _alike(appearances: Sequence[Appearance]) -> list[list[Appearance]]:
    """The appearances, those that look the same together."""
    groups: dict[tuple[object, ...], list[Appearance]] = {}
    for each in appearances:
        key = (each.image.shape, each.image.tobytes(), each.outline.tobytes(), each.z)
        groups.setdefault(key, []).append(each)
    return list(groups.values())


class _Looking:
    """A picture in which faces are looked for."""

    def __init__(self, image: NDArray[np.uint8], camera: Camera, kind: FeatureKind) -> None:
        """Prepare a picture, given by how bright it is."""
        self._image, self._camera, self._kind = image, camera, kind
        self._parts = foreground_parts(image)
        self._blurred = BlurredPicture.of(image, self._parts, camera)

    def for_all(self, groups: Sequence[Sequence[Appearance]]) -> list[list[FaceFit]]:
        """Fits of the face of each group of faces that look the same.

        First points tell where to try; of what is left, points that are seen from closer do, then places and
        angles where the whole face is like the picture.
        """
        tried = [list[FaceFit]() for _ in groups]
        for propose in (self._by_points, partial(self._by_points, closer=_CLOSER), self._by_search):
            parts = self._unexplained(groups, tried)
            missing = [i for i, group in enumerate(groups) if not _enough(tried[i], group)]
            if missing and parts:
                proposed = propose(parts, [groups[i] for i in missing])
                for i, poses in zip(missing, proposed, strict=True):
                    tried[i] += self._fits(groups[i], tried[i], poses)
        return tried

    def _unexplained(
        self, groups: Sequence[Sequence[Appearance]], tried: Sequence[Sequence[FaceFit]]
    ) -> list[Part]:
        """The parts of the picture in which there may be more than what is found already."""
        parts = self._parts
        for group, fits in zip(groups, tried, strict=True):
            for fit in filter(is_certain, fits):
                parts = without(parts, contour(group[0], fit, self._camera))
        return parts

    def _by_points(
        self, parts: Sequence[Part], groups: Sequence[Sequence[Appearance]], closer: float = 1.0
    ) -> list[Iterable[Frame]]:
        """Where points in parts of the picture suggest each group's face."""
        points = find_keypoints(self._image, self._kind, parts, closer)
        return [self._votes(points, group, closer) for group in groups]

    def _votes(self, points: Keypoints, group: Sequence[Appearance], closer: float) -> Iterable[Frame]:
        appearance = group[0]
        reference = _reference_points(appearance, self._kind, closer)
        match, ratios = nearest(points.descriptors, reference.descriptors, self._kind)
        chosen = ratios < _MOST_RATIO
        places, directions = points.places[chosen], points.directions[chosen]
        world = self._camera.to_plane(places, appearance.z)
        ahead = self._camera.to_plane(places + directions, appearance.z) - world
        return vote(
            appearance.to_local(reference.places[match[chosen]]),
            reference.directions[match[chosen]] * [1.0, -1.0],
            world,
            ahead / np.linalg.norm(ahead, axis=-1, keepdims=True),
            tolerance=_TOLERANCE * appearance.metres_per_pixel,
            most=_N_VOTED * len(group),
        )

    def _by_search(
        self, parts: Sequence[Part], groups: Sequence[Sequence[Appearance]]
    ) -> list[Iterable[Frame]]:
        """Where each group's whole face is like parts of the picture."""
        return [
            _search(group[0]).poses(self._image, self._camera, parts, _N_SEARCHED * len(group))
            for group in groups
        ]

    def _fits(
        self, group: Sequence[Appearance], before: Sequence[FaceFit], poses: Iterable[Frame]
    ) -> list[FaceFit]:
        """Fits from poses, one after the other, until there are enough that are certain with those before."""
        face, fits = _face(group[0]), list[FaceFit]()
        for pose in poses:
            fit = fit_face(self._blurred, face, pose)
            if fit is not None:
                fits.append(fit)
            if _enough([*before, *fits], group):
                break
        return fits


def _enough(fits: Iterable[FaceFit], group: Sequence[Appearance]) -> bool:
    return sum(map(is_certain, fits)) >= len(group)


@lru_cache(maxsize=64)
def _face(appearance: Appearance) -> Face:
    return Face.of(appearance)


@lru_cache(maxsize=64)
def _search(appearance: Appearance) -> Search:
    return Search.of(appearance)


@lru_cache(maxsize=64)
def _reference_points(appearance: Appearance, kind: FeatureKind, closer: float) -> Keypoints:
    return find_keypoints(brightness(appearance.image), kind, closer=closer)
