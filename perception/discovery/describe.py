"""What a thing looks like, learnt from several pictures of it: outline, height, colour and symmetry.

Nothing is told about the thing. Two readings of its pictures are tried: that all of the region is one flat
outline, and that only the faces that are as bright as most of it are its upper side, at one of several
heights, and the rest walls below. The reading is taken whose outline lies best on the edges in all pictures.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import cv2
import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame
from perception.assignment import quality
from perception.discovery.polygon import outline, symmetry
from perception.discovery.propose import Thing
from perception.discovery.template import Template, align, mean_silhouette
from perception.mixture import Mixture
from perception.outline_fit import OutlineFit, fit_outline
from perception.picture import Picture

_HEIGHTS = (0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08)
"""Of the upper side above the table, those that are tried first [m]."""
_FINER = (-0.005, 0.005)  # Those that are tried around the best of them [m].
_CLEARLY_BETTER = 1.05  # Another reading must fit better by this factor: height is told by seen walls only.
_BRIGHT = 0.85  # Of the usual brightness; a face that is darker is a wall.
_LEAST_TOP = 0.35  # Of a region's area that its upper side covers at least.


@dataclass(frozen=True, slots=True, eq=False)
class Description:
    """What was learnt about a thing.

    Attributes:
        model: What it looks like.
        fit: How well that lies on the edges of its pictures; larger is better.
    """

    model: ObjectModel
    fit: float


@dataclass(frozen=True, slots=True, eq=False)
class _Reading:
    """What comes out at one height: the description, if any, and where the thing is in each picture."""

    z: float
    description: Description | None
    frames: tuple[Frame, ...]

    @property
    def fit(self) -> float:
        return self.description.fit if self.description else 0.0


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
    middle = 0.5 * np.array([camera.width, camera.height])
    order = np.argsort([np.linalg.norm(thing.region.centroid - middle) for thing in things])
    pictures, whole = [pictures[i] for i in order], [things[i] for i in order]
    tops = [_upper_side(picture, thing) for picture, thing in zip(pictures, whole, strict=True)]
    readings: list[tuple[list[Thing], tuple[float, ...]]] = [(whole, _HEIGHTS[:1])]
    if all(t.region.area > _LEAST_TOP * w.region.area for t, w in zip(tops, whole, strict=True)):
        readings.append((tops, _HEIGHTS))
    best: Description | None = None
    for regions, heights in readings:
        found = _best_height(name, pictures, regions, camera, heights)
        if found is not None and (best is None or found.fit > _CLEARLY_BETTER * best.fit):
            best = found
    return best


def _best_height(
    name: str, pictures: Sequence[Picture], things: list[Thing], camera: Camera, heights: Sequence[float]
) -> Description | None:
    """The height that fits best; walls that are seen tell it, or nothing does and the lowest is taken."""
    frames, half = align(things, camera)
    read = partial(_read, name, pictures, things, camera, half)
    tried = [read(frames, heights[0], heights[0])]
    for before, z in pairwise((heights[0], *heights)):
        tried.append(read(tried[-1].frames, before, z))
    best = _better(tried)
    if len(heights) > 1:
        finer = [best.z + step for step in _FINER if best.z + step > 0]
        best = _better([best, *(read(best.frames, best.z, z) for z in finer)])
    settled = read(best.frames, best.z, best.z)
    return read(settled.frames, best.z, best.z).description


def _better(readings: Sequence[_Reading]) -> _Reading:
    """The one that fits best; a later one must do so clearly."""
    best = readings[0]
    for reading in readings[1:]:
        if reading.fit > _CLEARLY_BETTER * best.fit:
            best = reading
    return best


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


def _read(
    name: str,
    pictures: Sequence[Picture],
    things: Sequence[Thing],
    camera: Camera,
    half: float,
    frames: Sequence[Frame],
    before: float,
    z: float,
) -> _Reading:
    """The outline at height ``z`` from poses that held at height ``before``."""
    starts = [_lifted(frame, camera, before, z) for frame in frames]
    model = _model(name, mean_silhouette(things, camera, starts, z, half), things)
    if model is None:
        return _Reading(z, None, tuple(starts))
    fits = [_fit(p, t, model, camera, s) for p, t, s in zip(pictures, things, starts, strict=True)]
    moved = tuple(fit.frame if fit else start for fit, start in zip(fits, starts, strict=True))
    return _Reading(z, Description(model, float(np.mean([quality(f) if f else 0.0 for f in fits]))), moved)


def _fit(
    picture: Picture, thing: Thing, model: ObjectModel, camera: Camera, start: Frame
) -> OutlineFit | None:
    return fit_outline(picture, camera, model, Mixture.of(thing.region.colour, thing.table), start)


def _lifted(frame: Frame, camera: Camera, z: float, new_z: float) -> Frame:
    """The frame whose image at another height is that of one at this height."""
    return Frame(camera.to_plane(camera.project([*frame.position, z]), new_z), frame.angle)


def _model(name: str, template: Template, things: Sequence[Thing]) -> ObjectModel | None:
    corners = outline(template)
    if corners is None:
        return None
    corners = corners - _middle(corners)
    colour = np.median([thing.region.colour for thing in things], axis=0) / 255.0
    return ObjectModel(
        name=name,
        outline=corners,
        z=template.z,
        colour=colour,
        symmetry=symmetry(corners),
        base_z=0.0,
    )


def _middle(corners: Array) -> Array:
    """The centre of a polygon's area, shape (2,)."""
    x, y = corners.T
    nx, ny = np.roll(corners, -1, axis=0).T
    cross = x * ny - nx * y
    return np.asarray([((x + nx) * cross).sum(), ((y + ny) * cross).sum()]) / (3 * float(cross.sum()))
