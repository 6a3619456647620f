"""Finds objects by their colour and the shape of their outline."""

from collections.abc import Sequence

import cv2
import numpy as np

from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen, ObjectModel
from cobot_lfd.frame import Frame
from perception.coarse_pose import guess_poses
from perception.mixture import Mixture
from perception.outline_fit import OutlineFit, fit_outline
from perception.picture import Picture, check_picture
from perception.segmentation import Region, Segmentation, segment
from perception.silhouette import silhouette_hull

_LEAST_AREA, _MOST_AREA = 0.3, 1.7  # Of the expected area; less is covered or something else.
_LEAST_FOUND = 0.55  # Share of the outline that must be seen.
_MOST_RESIDUAL = 1.0  # Root mean square distance of the edges from the outline [px].
_N_REGIONS, _N_STARTS = 4, 2  # The largest regions and the likeliest poses that are tried.
_COARSE_SIZE = 8.0  # Least size of an object in the picture in which regions are looked for [px].


def detect(
    picture: Picture, camera: Camera, models: Sequence[ObjectModel]
) -> tuple[Detection | NotSeen, ...]:
    """Find objects in a picture, each by its colour and its outline.

    Args:
        picture: Red, green, blue, shape (height, width, 3).
        camera: The camera that took it.
        models: What to look for.

    Returns:
        For each model what was seen, or why not, in the models' order.

    Raises:
        ValueError: If the picture is not one of this camera.
    """
    check_picture(picture, camera)
    if not models:
        return ()
    segmentation = segment(picture, models, _scale(models, camera))
    if segmentation is None:
        return tuple(NotSeen(m.name, "the picture is too dark; is the camera covered?") for m in models)
    return tuple(
        _detect_one(picture, camera, model, segmentation, regions)
        for model, regions in zip(models, segmentation.regions, strict=True)
    )


def _scale(models: Sequence[ObjectModel], camera: Camera) -> int:
    """How many pixels may be averaged so that the smallest object is still seen as a shape."""
    middle = camera.to_plane([0.5 * (camera.width - 1), 0.5 * (camera.height - 1)], 0.0)
    sizes = [np.ptp(silhouette_hull(model, Frame(middle, 0.0), camera), axis=0).min() for model in models]
    return int(np.clip(min(sizes) // _COARSE_SIZE, 1, 4))


def _detect_one(
    picture: Picture,
    camera: Camera,
    model: ObjectModel,
    segmentation: Segmentation,
    regions: Sequence[Region],
) -> Detection | NotSeen:
    """The best fit among the regions of the object's colour."""
    fits, reason = [], f"nothing in the picture has the colour of the {model.name}."
    for region in regions[:_N_REGIONS]:
        starts = guess_poses(region, model, camera, segmentation.scale, _N_STARTS)
        expected = cv2.contourArea(silhouette_hull(model, starts[0], camera).astype(np.float32))
        if not _LEAST_AREA * expected < region.area < _MOST_AREA * expected:
            if region is regions[0]:
                reason = _wrong_size(model, region, expected)
            continue
        mixture = Mixture.of(region.colour, segmentation.table)
        tried = (fit_outline(picture, camera, model, mixture, start) for start in starts)
        fit = max((f for f in tried if f is not None), key=_quality, default=None)
        fault = _fault(model, region, fit)
        if fit is not None and fault is None:
            fits.append(fit)
        elif fault is not None:
            reason = fault
    if not fits:
        return NotSeen(model.name, reason)
    return _detection(model, camera, max(fits, key=_quality))


def _quality(fit: OutlineFit) -> float:
    return fit.found / (0.1 + fit.residual)


def _wrong_size(model: ObjectModel, region: Region, expected: float) -> str:
    size = f"{100 * region.area / expected:.0f} % of the size of the {model.name}"
    where = "cut off by the picture's edge" if region.at_border else "covered, or something else"
    return f"what has its colour has {size}; it is {where}."


def _fault(model: ObjectModel, region: Region, fit: OutlineFit | None) -> str | None:
    """Why a fit is not to be believed."""
    found = 0.0 if fit is None else fit.found
    if found < _LEAST_FOUND:
        where = "cut off by the picture's edge" if region.at_border else "covered, or something else"
        return f"only {100 * found:.0f} % of the outline of the {model.name} is seen; it is {where}."
    if fit is not None and fit.residual > _MOST_RESIDUAL:
        return f"what has its colour differs from the {model.name}'s outline by {fit.residual:.1f} px."
    return None


def _detection(model: ObjectModel, camera: Camera, fit: OutlineFit) -> Detection:
    frame = Frame(fit.frame.position, _representative(fit.frame.angle, model.symmetry))
    corners = np.column_stack([frame.apply(model.outline), np.full(len(model.outline), model.z)])
    return Detection(
        name=model.name,
        frame=frame,
        symmetry=model.symmetry,
        covariance=fit.covariance,
        confidence=fit.found,
        contour=camera.project(corners),
    )


def _representative(angle: float, symmetry: int) -> float:
    """The angle among those that look the same that is in (-pi / symmetry, pi / symmetry] [rad]."""
    turn = 2 * np.pi / symmetry
    return float(turn / 2 - np.mod(turn / 2 - angle, turn))
