"""Finds objects by their colour and the shape of their outline."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import cv2
import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen, ObjectModel
from cobot_lfd.frame import Frame
from perception.assignment import assign
from perception.coarse_pose import Comparison
from perception.mixture import Mixture
from perception.outline_fit import OutlineFit, fit_outline
from perception.picture import Picture, check_picture
from perception.region import Region
from perception.segmentation import Segmentation, segment
from perception.silhouette import silhouette_hull

_LEAST_AREA, _MOST_AREA = 0.3, 1.7  # Of the expected area; less is covered or something else.
_LEAST_FOUND = 0.4  # Share of the outline that must be seen.
_MOST_EMPTY = 0.13  # Share of the outline where only the table is seen.
_MOST_BETWEEN = 0.3  # The same where something lies across an object, whose colour may be like the table's.
_MOST_RESIDUAL = 1.0  # Root mean square distance of the edges from the outline [px].
_MOST_DEVIATION = 0.003  # Standard deviation of the position that is still worth telling [m].
_N_REGIONS = 4  # The largest regions are tried.
_COARSE_SIZE = 5.0  # Least size of an object in the picture in which regions are looked for [px].


@dataclass(frozen=True, slots=True, eq=False)
class ShapeDetector:
    """Finds objects, each by its colour and its outline.

    Attributes:
        models: What to look for.
    """

    models: tuple[ObjectModel, ...]

    def detect(self, picture: Picture, camera: Camera) -> tuple[Detection | NotSeen, ...]:
        """For each object what was seen in a picture, or why not, in the models' order."""
        check_picture(picture, camera)
        if not self.models:
            return ()
        segmentation = segment(picture, self.models, _scale(self.models, camera))
        if segmentation is None:
            dark = "the picture is too dark; is the camera covered?"
            return tuple(NotSeen(model.name, dark) for model in self.models)
        tried = [
            _try_all(picture, camera, model, segmentation, regions[:_N_REGIONS])
            for model, regions in zip(self.models, segmentation.regions, strict=True)
        ]
        return tuple(
            _told(model, camera, chosen, results)
            for model, chosen, results in zip(self.models, assign(self.models, tried), tried, strict=True)
        )


def _scale(models: Sequence[ObjectModel], camera: Camera) -> int:
    """How many pixels may be averaged so that the smallest object is still seen as a shape."""
    middle = camera.to_plane([0.5 * (camera.width - 1), 0.5 * (camera.height - 1)], 0.0)
    sizes = [np.ptp(silhouette_hull(model, Frame(middle, 0.0), camera), axis=0).min() for model in models]
    return int(np.clip(min(sizes) // _COARSE_SIZE, 1, 4))


def _told(
    model: ObjectModel, camera: Camera, chosen: OutlineFit | None, tried: Sequence[OutlineFit | str]
) -> Detection | NotSeen:
    """What is said of an object for which a fit was chosen, or none."""
    if chosen is not None:
        return _detection(model, camera, chosen)
    if not tried:
        return NotSeen(model.name, f"nothing in the picture has the colour of the {model.name}.")
    faults = [result for result in tried if isinstance(result, str)]
    return NotSeen(model.name, [*faults, "what looks like it is another object of the same colour."][0])


def _try_all(
    picture: Picture,
    camera: Camera,
    model: ObjectModel,
    segmentation: Segmentation,
    regions: Sequence[Region],
) -> list[OutlineFit | str]:
    """The best fit to each region, or why there is none.

    Something that lies across an object leaves two regions of it; so where no region is the object, pairs of
    them are tried. A fit to a pair counts as one to its larger region.
    """
    results = [_try(picture, camera, model, segmentation, region) for region in regions]
    if any(isinstance(result, OutlineFit) for result in results):
        return results
    for i, j in combinations(range(len(regions)), 2):
        if regions[i].right_colour and regions[j].right_colour:
            pair = regions[i].joined(regions[j])
            both = _try(picture, camera, model, segmentation, pair, most_empty=_MOST_BETWEEN)
            if isinstance(both, OutlineFit):
                results[i] = both
                break
    return results


def _try(
    picture: Picture,
    camera: Camera,
    model: ObjectModel,
    segmentation: Segmentation,
    region: Region,
    most_empty: float = _MOST_EMPTY,
) -> OutlineFit | str:
    """The best fit to a region, or why there is none; that something is covered is tried last."""
    here = Frame(camera.to_plane(region.centroid, model.z), 0.0)
    expected = cv2.contourArea(silhouette_hull(model, here, camera).astype(np.float32))
    if not _LEAST_AREA * expected < region.area < _MOST_AREA * expected:
        return f"what has its colour has {100 * region.area / expected:.0f} % of its size; {_where(region)}."
    if not region.right_colour:
        return f"what is most like it in colour differs by {100 * region.unlikeness:.0f} %."
    comparison = Comparison.of(region, model, camera, segmentation.scale)
    if comparison.too_wide > segmentation.scale + _MOST_RESIDUAL:
        return _stuck_out(comparison.too_wide)
    mixture = Mixture.of(region.colour, segmentation.table, segmentation.noise)
    fault = ""
    for covered in (False, True):
        best = fit_outline(picture, camera, model, mixture, comparison.poses(covered=covered))
        fault = _fault(model, camera, region, segmentation.scale, best, most_empty)
        if best is not None and not fault:
            return best
    return fault


def _where(region: Region) -> str:
    return "it is cut off by the picture's edge" if region.at_border else "it is covered, or something else"


def _fault(
    model: ObjectModel,
    camera: Camera,
    region: Region,
    scale: int,
    fit: OutlineFit | None,
    most_empty: float,
) -> str:
    """Why a fit is not to be believed; empty if it is."""
    if fit is None or fit.found < _LEAST_FOUND:
        return f"only {100 * (fit.found if fit else 0.0):.0f} % of its outline is seen; {_where(region)}."
    if fit.empty > most_empty:
        return f"the table is seen at {100 * fit.empty:.0f} % of where its outline should be."
    if fit.residual > _MOST_RESIDUAL:
        return f"what has its colour differs from its outline by {fit.residual:.1f} px."
    if np.sqrt(np.linalg.eigvalsh(fit.covariance[:2, :2]).max()) > _MOST_DEVIATION:
        return f"too little of its outline is seen to tell where it is; {_where(region)}."
    beyond = _sticks_out(region, silhouette_hull(model, fit.frame, camera))
    if beyond > scale + _MOST_RESIDUAL:
        return _stuck_out(beyond)
    return ""


def _stuck_out(beyond: float) -> str:
    return f"what has its colour sticks out of its outline by {beyond:.0f} px; it is something else."


def _sticks_out(region: Region, hull: Array) -> float:
    """How far a region reaches beyond a convex hull [px]."""
    polygon = hull.astype(np.float32)
    corners = region.hull.tolist()
    return max(-cv2.pointPolygonTest(polygon, (u, v), measureDist=True) for u, v in corners)


def _detection(model: ObjectModel, camera: Camera, fit: OutlineFit) -> Detection:
    frame = Frame(fit.frame.position, _representative(fit.frame.angle, model.symmetry))
    corners = np.column_stack([frame.apply(model.outline), np.full(len(model.outline), model.z)])
    covariance = fit.covariance.copy()
    if model.is_round:  # Its angle may be anything within a turn of the polygon that stands for it.
        covariance[2, :] = covariance[:, 2] = 0.0
        covariance[2, 2] = (2 * np.pi / model.symmetry) ** 2 / 12
    return Detection(
        name=model.name,
        frame=frame,
        symmetry=model.symmetry,
        covariance=covariance,
        confidence=fit.found,
        contour=camera.project(corners),
    )


def _representative(angle: float, symmetry: int) -> float:
    """The angle among those that look the same that is in (-pi / symmetry, pi / symmetry] [rad]."""
    turn = 2 * np.pi / symmetry
    return float(turn / 2 - np.mod(turn / 2 - angle, turn))
