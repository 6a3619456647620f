"""What a thing looks like, learnt from several pictures of it: outline, height, colour and symmetry.

Nothing is told about the thing. It is read as an upright one, whose upper side is as bright as most of it
and has walls below, if that explains the regions that show it; else as a rounded one, whose silhouette lies
at half the height that explains them best. Its outline is that of the mean silhouette over all pictures;
outline and poses are found from one another.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame
from perception.discovery.face import with_face
from perception.discovery.height import height, lifted
from perception.discovery.polygon import middle, outline, symmetry
from perception.discovery.propose import Thing
from perception.discovery.template import Template, align, mean_silhouette
from perception.mixture import Mixture
from perception.outline_fit import OutlineFit, fit_outline, quality
from perception.picture import Picture

_BRIGHT = 0.85  # Of the usual brightness; a face that is darker is a wall.
_LEAST_TOP = 0.35  # Of a region's area that its upper side covers at least.
_MOST_UNEXPLAINED = 0.06  # Of the regions' area; what an upright thing explains worse is rounded.
_N_ROUNDS = 2  # In which outline and poses are found from one another.


@dataclass(frozen=True, slots=True, eq=False)
class Description:
    """What was learnt about a thing.

    Attributes:
        model: What it looks like.
        fit: How well that lies on the edges of its pictures; larger is better.
    """

    model: ObjectModel
    fit: float


def describe(
    name: str, pictures: Sequence[Picture], things: Sequence[Thing], camera: Camera
) -> Description | None:
    """Learn what a thing looks like.

    Args:
        name: What it is to be called.
        pictures: Pictures that show it.
        things: The region that shows it in each of them.
        camera: The camera.

    Returns:
        The description; None if no outline fits.
    """
    centre = 0.5 * np.array([camera.width, camera.height])
    order = np.argsort([np.linalg.norm(thing.region.centroid - centre) for thing in things])
    pictures, things = [pictures[i] for i in order], [things[i] for i in order]
    tops = [_upper_side(picture, thing) for picture, thing in zip(pictures, things, strict=True)]
    z, unexplained = height(tops, things, camera)
    small = any(t.region.area < _LEAST_TOP * w.region.area for t, w in zip(tops, things, strict=True))
    upright = unexplained < _MOST_UNEXPLAINED and not small
    if upright:
        return _outlined(name, pictures, tops, camera, z, 0.0)
    return _outlined(name, pictures, things, camera, 0.5 * z, 0.5 * z)


def _outlined(
    name: str, pictures: Sequence[Picture], things: Sequence[Thing], camera: Camera, z: float, base_z: float
) -> Description | None:
    """The outline at a height, walls below it down to another, found from poses and they from it, in turn."""
    frames, half = align(things, camera)
    frames = [lifted(frame, camera, 0.0, by=z) for frame in frames]
    description = None
    for _ in range(_N_ROUNDS):
        model = _model(name, mean_silhouette(things, camera, frames, z, half), things, base_z)
        if model is None:
            break
        fits = [_fit(p, t, model, camera, f) for p, t, f in zip(pictures, things, frames, strict=True)]
        frames = [fit.frame if fit else frame for fit, frame in zip(fits, frames, strict=True)]
        description = Description(model, float(np.mean([quality(fit) if fit else 0.0 for fit in fits])))
    if description is None:
        return None
    model, turn = _straightened(description.model)
    turned = [frame @ turn for frame in frames]
    return replace(description, model=with_face(model, pictures, things, turned, camera))


def _upper_side(picture: Picture, thing: Thing) -> Thing:
    """The largest part of a region that is as bright as most of it, without holes."""
    x, y = thing.corner
    height, width = thing.mask.shape
    brightness = picture[y : y + height, x : x + width].astype(np.float64).mean(axis=2)
    usual = float(np.median(brightness[thing.mask]))
    bright = thing.mask & (brightness > _BRIGHT * usual)
    contours, _ = cv2.findContours(bright.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    filled = np.zeros(thing.mask.shape, np.uint8)
    if contours:
        cv2.drawContours(filled, [max(contours, key=cv2.contourArea)], -1, 1, cv2.FILLED)
    mask = (filled > 0) & thing.mask
    return replace(thing, mask=mask, region=replace(thing.region, area=float(mask.sum())))


def _fit(
    picture: Picture, thing: Thing, model: ObjectModel, camera: Camera, start: Frame
) -> OutlineFit | None:
    return fit_outline(picture, camera, model, Mixture.of(thing.region.colour, thing.table), (start,))


def _model(name: str, template: Template, things: Sequence[Thing], base_z: float) -> ObjectModel | None:
    corners = outline(template)
    if corners is None:
        return None
    corners = corners - middle(corners)
    colour = np.median([thing.region.colour for thing in things], axis=0) / 255.0
    return ObjectModel(
        name=name,
        outline=corners,
        z=template.z,
        colour=colour,
        symmetry=symmetry(corners),
        base_z=np.full(len(corners), base_z),
    )


def _straightened(model: ObjectModel) -> tuple[ObjectModel, Frame]:
    """The same thing with its longest side along the frame's x axis, and the new frame in the old one."""
    sides = np.roll(model.outline, -1, axis=0) - model.outline
    x, y = sides[int(np.linalg.norm(sides, axis=1).argmax())]
    turn = Frame(np.zeros(2), float(np.arctan2(y, x)))
    return replace(model, outline=turn.localise(model.outline)), turn
