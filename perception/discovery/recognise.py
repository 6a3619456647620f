"""Where known things are in a new picture; what is not seen is said not to be, with a reason."""

from collections.abc import Sequence

import cv2
import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen, ObjectModel
from cobot_lfd.frame import Frame
from perception.assignment import best_together, named_from_the_left
from perception.coarse_pose import Comparison
from perception.discovery.propose import Thing, propose
from perception.feature_detector import FeatureDetector
from perception.mixture import Mixture
from perception.outline_fit import OutlineFit, fit_outline
from perception.picture import Picture
from perception.silhouette import silhouette_hull
from perception.table import shares

_MOST_UNLIKE = 0.12  # In the plane of the shares of red, green and blue: another colour.
_BRIGHTNESS = 2.2  # Factor between two brightnesses from where on they are two colours: black is no white.
_LEAST_AREA, _MOST_AREA = 0.6, 1.5  # Of the expected area.
_LEAST_FOUND = 0.5  # Share of the outline that must be seen.
_MOST_RESIDUAL = 1.2  # Root mean square distance of the edges from the outline [px].


def recognise(
    picture: Picture,
    camera: Camera,
    models: Sequence[ObjectModel],
    things: Sequence[Thing] | None = None,
) -> tuple[Detection | NotSeen, ...]:
    """Find things in a picture that were described before.

    Args:
        picture: Red, green, blue, shape (height, width, 3).
        camera: The camera that took it.
        models: What the things look like; their colours are those of pictures, in shares of 255.
        things: What stands out in the picture, where that is known; by default it is looked for.

    Returns:
        For each model what was seen, or why not, in the models' order.

    Raises:
        ValueError: If the picture is not one of this camera.
    """
    things = propose(picture, camera) if things is None else things
    outlined = [model for model in models if model.appearance is None]
    faces = tuple(model.appearance for model in models if model.appearance is not None)
    found = {item.name: item for item in _by_outline(picture, camera, outlined, things)}
    if faces:
        found |= {item.name: item for item in FeatureDetector(faces).detect(picture, camera)}
    return tuple(found[model.name] for model in models)


def _by_outline(
    picture: Picture, camera: Camera, models: Sequence[ObjectModel], things: Sequence[Thing]
) -> list[Detection | NotSeen]:
    """For each model what was seen, or why not."""
    if not models:
        return []
    tried = [[_try(picture, camera, model, thing) for thing in things] for model in models]
    chosen = named_from_the_left(models, best_together(tried))
    return [
        _detection(model, camera, fit) if fit is not None else NotSeen(model.name, _why_not(things, results))
        for model, fit, results in zip(models, chosen, tried, strict=True)
    ]


def _try(picture: Picture, camera: Camera, model: ObjectModel, thing: Thing) -> OutlineFit | str:
    """The best fit of a thing's outline to a region, or why there is none; empty for another colour."""
    region = thing.region
    if not _same_colour(region.colour, 255.0 * model.colour, thing.table):
        return ""
    starts = Comparison.of(region, model, camera, 1).poses()
    expected = cv2.contourArea(silhouette_hull(model, starts[0], camera).astype(np.float32))
    seen = cv2.contourArea(region.hull.astype(np.float32))
    if not _LEAST_AREA * expected < seen < _MOST_AREA * expected:
        edge = "; it is cut off by the picture's edge" if region.at_border else ""
        return f"what has its colour has {100 * seen / expected:.0f} % of its size{edge}."
    mixture = Mixture.of(region.colour, thing.table)
    best = fit_outline(picture, camera, model, mixture, starts)
    if best is None or best.found < _LEAST_FOUND:
        return f"only {100 * (best.found if best else 0.0):.0f} % of its outline is seen."
    if best.residual > _MOST_RESIDUAL:
        return f"what has its colour differs from its outline by {best.residual:.1f} px."
    return best


def _same_colour(seen: Array, expected: Array, table: Array) -> bool:
    """Whether two colours are the same, give or take the light's."""
    ratio = (seen.mean() + 8.0) / (expected.mean() + 8.0)
    unlike = float(np.linalg.norm(shares(seen) - shares(expected)))
    allowed = min(_MOST_UNLIKE, 0.5 * float(np.linalg.norm(shares(expected) - shares(table))) + 0.01)
    return unlike < allowed and 1 / _BRIGHTNESS < ratio < _BRIGHTNESS


def _why_not(things: Sequence[Thing], tried: Sequence[OutlineFit | str]) -> str:
    if not things:
        return "nothing stands out from the table; is the camera covered?"
    faults = [result for result in tried if isinstance(result, str) and result]
    return [*faults, "nothing in the picture has its colour, or it is taken by another."][0]


def _detection(model: ObjectModel, camera: Camera, fit: OutlineFit) -> Detection:
    turn = 2 * np.pi / model.symmetry
    frame = Frame(fit.frame.position, turn / 2 - np.mod(turn / 2 - fit.frame.angle, turn))
    corners = np.column_stack([frame.apply(model.outline), np.full(len(model.outline), model.z)])
    return Detection(model.name, frame, model.symmetry, fit.covariance, fit.found, camera.project(corners))
