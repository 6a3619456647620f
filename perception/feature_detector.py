"""Finds objects by what is on their faces: any object with some texture, learnt from one picture of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.appearance import Appearance
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen
from perception.face_fit import Face, FaceFit, blurred, fit_face
from perception.foreground import foreground_parts
from perception.keypoints import FeatureKind, Keypoints, find_keypoints, nearest
from perception.picture import Picture, check_picture
from perception.pose_votes import vote
from perception.rigid import on_plane

_MOST_RATIO = 0.9  # Of the distances to the two points that are most like one; above, it is like any.
_TOLERANCE = 3.0  # How far a point may be from where a pose puts it, in pixels of the face's map.
_N_POSES = 6  # Tried for each object, and for each that looks the same.
_LEAST_SHOWN = 0.35  # Share of a face's pixels that must look as they should.
_LEAST_CORRELATION = 0.75  # Of their brightness with the expected.
_SHOWN_IN_SHADE = 0.8  # The same two where the light is taken to be uneven, which explains much.
_CORRELATION_IN_SHADE = 0.9
_CERTAIN = 0.65  # Share times correlation from which on no other places are tried.
_SAME_PLACE = 0.3  # Two poses closer than this share of a face's size are one object.
_DARKEST = 12.0  # Mean brightness below which a picture shows nothing [0..255].


@dataclass(frozen=True, slots=True, eq=False)
class FeatureDetector:
    """Finds objects by what is on their faces.

    Points of the picture that look like points of a face vote for poses; each likely pose is then fitted to
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
        grey = np.asarray(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY), np.uint8)
        if grey.mean() < _DARKEST:
            dark = "the picture is too dark; is the camera covered?"
            return tuple(NotSeen(each.name, dark) for each in self.appearances)
        points = find_keypoints(grey, self.kind, foreground_parts(grey))
        images = blurred(grey)
        groups = _alike(self.appearances)
        tried = [_try(group, self.kind, points, images, camera) for group in groups]
        told = {
            name: item
            for group, fits, taken in zip(groups, tried, _share(groups, tried), strict=True)
            for name, item in _told(group, camera, fits, taken).items()
        }
        return tuple(told[appearance.name] for appearance in self.appearances)


@dataclass(frozen=True, slots=True, eq=False)
class _Reference:
    """A face, and the points by which it is recognised."""

    face: Face
    points: Keypoints


@lru_cache(maxsize=64)
def _reference(appearance: Appearance, kind: FeatureKind) -> _Reference:
    grey = np.asarray(cv2.cvtColor(appearance.image, cv2.COLOR_RGB2GRAY), np.uint8)
    return _Reference(Face.of(appearance), find_keypoints(grey, kind))


def _alike(appearances: Sequence[Appearance]) -> list[list[Appearance]]:
    """The appearances, those that look the same together."""
    groups: dict[tuple[object, ...], list[Appearance]] = {}
    for each in appearances:
        key = (each.image.shape, each.image.tobytes(), each.outline.tobytes(), each.z)
        groups.setdefault(key, []).append(each)
    return list(groups.values())


def _try(
    group: Sequence[Appearance],
    kind: FeatureKind,
    points: Keypoints,
    images: list[NDArray[Any]],
    camera: Camera,
) -> list[FaceFit]:
    """Fits of a face where points of the picture suggest it, until there are enough that are certain."""
    appearance = group[0]
    reference = _reference(appearance, kind)
    match, ratios = nearest(points.descriptors, reference.points.descriptors, kind)
    chosen = ratios < _MOST_RATIO
    places, directions = points.places[chosen], points.directions[chosen]
    world = camera.to_plane(places, appearance.z)
    ahead = camera.to_plane(places + directions, appearance.z) - world
    poses = vote(
        appearance.to_local(reference.points.places[match[chosen]]),
        reference.points.directions[match[chosen]] * [1.0, -1.0],
        world,
        ahead / np.linalg.norm(ahead, axis=-1, keepdims=True),
        tolerance=_TOLERANCE * appearance.metres_per_pixel,
        most=_N_POSES * len(group),
    )
    fits: list[FaceFit] = []
    for pose in poses:
        fit = fit_face(images, camera, reference.face, pose)
        if fit is None:
            continue
        shaded = fit_face(images, camera, reference.face, fit.frame, even=False)
        fits.append(fit if shaded is None or not _explains_more(shaded, fit) else shaded)
        if sum(_score(each) > _CERTAIN for each in fits) >= len(group):
            break
    return fits


def _explains_more(shaded: FaceFit, even: FaceFit) -> bool:
    """Whether uneven light explains a face, and not what covers it, which would be like it in shape only."""
    least = max(even.correlation, _CORRELATION_IN_SHADE)
    return shaded.shown > _SHOWN_IN_SHADE and shaded.correlation > least


def _score(fit: FaceFit) -> float:
    return fit.shown * fit.correlation


def _share(groups: Sequence[Sequence[Appearance]], tried: Sequence[Sequence[FaceFit]]) -> list[list[FaceFit]]:
    """For each group the fits that it keeps: each place goes to the face that fits there best."""
    kept: list[tuple[int, FaceFit]] = []
    candidates = [(i, fit) for i, fits in enumerate(tried) for fit in fits if not _fault(fit)]
    for i, fit in sorted(candidates, key=lambda candidate: -_score(candidate[1])):
        room = _SAME_PLACE * float(np.ptp(groups[i][0].outline, axis=0).min())
        near = any(np.linalg.norm(other.frame.position - fit.frame.position) < room for _, other in kept)
        if not near and sum(j == i for j, _ in kept) < len(groups[i]):
            kept.append((i, fit))
    return [[fit for j, fit in kept if j == i] for i in range(len(groups))]


def _fault(fit: FaceFit) -> str:
    """Why a fit is not to be believed; empty if it is."""
    if fit.shown < _LEAST_SHOWN:
        share = f"{100 * fit.shown:.0f} %"
        return f"only {share} of its face looks as it should; it is covered, or something else."
    if fit.correlation < _LEAST_CORRELATION:
        return f"what looks most like it differs from it (correlation {fit.correlation:.2f})."
    return ""


def _told(
    group: Sequence[Appearance], camera: Camera, tried: Sequence[FaceFit], kept: Sequence[FaceFit]
) -> dict[str, Detection | NotSeen]:
    """What is said of the objects that look the same, from left to right."""
    ordered = sorted(kept, key=lambda fit: -fit.frame.position[1])
    told: dict[str, Detection | NotSeen] = {
        each.name: _detection(each, camera, fit) for each, fit in zip(group, ordered, strict=False)
    }
    for each in group[len(ordered) :]:
        faults = [fault for fit in tried if (fault := _fault(fit))]
        if not tried:
            reason = f"nothing in the picture looks like the {each.name}."
        else:
            reason = faults[0] if faults else "what looks most like it is another object."
        told[each.name] = NotSeen(each.name, reason)
    return told


def _detection(appearance: Appearance, camera: Camera, fit: FaceFit) -> Detection:
    return Detection(
        name=appearance.name,
        frame=fit.frame,
        symmetry=1,
        covariance=fit.covariance,
        confidence=fit.shown,
        contour=camera.project(on_plane(fit.frame.apply(appearance.outline), appearance.z)),
    )
