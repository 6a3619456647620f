"""The mean silhouette of a thing over several pictures, seen from above in the thing's own frame."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.frame import Frame
from perception.discovery.propose import Thing

_CELL = 0.00075  # Side of a cell [m]; about half a pixel.
_COARSE = 3  # Cells to a side of the squares that angles are looked for with.
_MARGIN = 0.008  # Around the thing [m].
_N_ANGLES = 72


@dataclass(frozen=True, slots=True, eq=False)
class Template:
    """A silhouette: for each cell of a square the share of pictures in which the thing covers it.

    Attributes:
        cover: Shares in 0..1, shape (n, n); row and column grow with y and x, the middle is the origin.
        z: Height of the plane in which it lies [m].
    """

    cover: Array
    z: float

    @property
    def half(self) -> float:
        """Half the side of the square [m]."""
        return 0.5 * _CELL * len(self.cover)

    def to_metres(self, cells: Array) -> Array:
        """Places given by column and row, shape (n, 2), in the thing's frame [m]."""
        return np.asarray((cells + 0.5) * _CELL - self.half)

    def to_cells(self, metres: Array) -> Array:
        """The inverse of ``to_metres``, shape (..., 2)."""
        return np.asarray((metres + self.half) / _CELL - 0.5)


def silhouette(thing: Thing, camera: Camera, frame: Frame, z: float, half: float) -> Template:
    """What one picture shows of a thing, from above, in a frame.

    Args:
        thing: The thing.
        camera: The camera.
        frame: Where the thing is taken to be.
        z: Height of the plane in which it is drawn [m].
        half: Half the side of the square around the frame's origin that is drawn [m].
    """
    n = 2 * round(half / _CELL)
    line = (np.arange(n) + 0.5) * _CELL - 0.5 * n * _CELL
    columns, rows = np.meshgrid(line, line)
    points = frame.apply(np.stack([columns, rows], axis=-1))
    pixels = camera.project(np.concatenate([points, np.full((n, n, 1), z)], axis=-1)) - thing.corner
    cover = cv2.remap(
        thing.mask.astype(np.float32),
        pixels[..., 0].astype(np.float32),
        pixels[..., 1].astype(np.float32),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_CONSTANT,
        borderValue=0,
    )
    return Template(np.asarray(cover, dtype=np.float64), z)


def mean_silhouette(
    things: Sequence[Thing], camera: Camera, frames: Sequence[Frame], z: float, half: float
) -> Template:
    """The mean over several pictures."""
    covers = [silhouette(t, camera, f, z, half).cover for t, f in zip(things, frames, strict=True)]
    return Template(np.asarray(np.mean(covers, axis=0)), z)


def drawn(template: Template, thing: Thing, camera: Camera, frame: Frame, margin: int) -> Thing:
    """A thing as a picture would show it that had the template's silhouette.

    Args:
        template: The silhouette.
        thing: What the picture shows; its box, a little larger, is drawn in.
        camera: The camera.
        frame: Where the silhouette lies.
        margin: By how much the box is larger [px].
    """
    corner = thing.corner - margin
    rows, columns = np.array(thing.mask.shape) + 2 * margin
    pixels = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1) + corner
    cells = template.to_cells(frame.localise(camera.to_plane(pixels, template.z))).astype(np.float32)
    cover = cv2.remap(template.cover.astype(np.float32), cells[..., 0], cells[..., 1], cv2.INTER_LINEAR)
    mask = np.asarray(cover) > 0.5
    return replace(thing, mask=mask, corner=corner, region=replace(thing.region, area=float(mask.sum())))


def half_side(things: Sequence[Thing], frames: Sequence[Frame], camera: Camera) -> float:
    """Half the side of a square around a frame's origin on the table that holds all silhouettes [m]."""
    reach = [
        float(np.linalg.norm(camera.to_plane(thing.region.hull, 0.0) - frame.position, axis=1).max())
        for thing, frame in zip(things, frames, strict=True)
    ]
    return max(reach) + _MARGIN


def common_silhouette(
    things: Sequence[Thing], camera: Camera, frames: Sequence[Frame], z: float, half: float
) -> Template:
    """What all pictures have in common: walls are seen on another side in each."""
    covers = [silhouette(t, camera, f, z, half).cover for t, f in zip(things, frames, strict=True)]
    return Template(np.asarray(np.min(covers, axis=0)), z)


def align(things: Sequence[Thing], camera: Camera) -> tuple[list[Frame], float]:
    """Rough poses that lay silhouettes on one another, and half the side of a square that holds them [m].

    The first thing's frame lies in the middle of its silhouette, along the world's axes.
    """
    middles = [_middle(thing, camera) for thing in things]
    half = half_side(things, [Frame(middle, 0.0) for middle in middles], camera)
    reference = silhouette(things[0], camera, Frame(middles[0], 0.0), 0.0, half).cover
    frames = [Frame(middles[0], 0.0)]
    for thing, middle in zip(things[1:], middles[1:], strict=True):
        own = silhouette(thing, camera, Frame(middle, 0.0), 0.0, half).cover
        frames.append(Frame(middle, _best_turn(_shrunk(reference), _shrunk(own))))
    return frames, half


def overlap(a: Array, b: Array) -> float:
    """Common part of two silhouettes, as a share of what either covers."""
    return float(np.minimum(a, b).sum() / max(np.maximum(a, b).sum(), 1e-9))


def _middle(thing: Thing, camera: Camera) -> Array:
    """The middle of what the thing covers of the table [m]."""
    rows, columns = np.nonzero(thing.mask)
    pixels = np.column_stack([columns, rows]) + thing.corner
    return np.asarray(camera.to_plane(pixels, 0.0).mean(axis=0))


def _shrunk(cover: Array) -> Array:
    n = len(cover) // _COARSE
    return np.asarray(cv2.resize(cover, (n, n), interpolation=cv2.INTER_AREA), dtype=np.float64)


def _best_turn(reference: Array, own: Array) -> float:
    """The angle of a thing whose silhouette along the world's axes is known [rad]."""
    middle = 0.5 * (len(own) - 1)
    best = 0.0, -1.0
    for angle in np.arange(_N_ANGLES) * 2 * np.pi / _N_ANGLES:
        turn = cv2.getRotationMatrix2D((middle, middle), float(np.rad2deg(angle)), 1.0)
        turned = np.asarray(cv2.warpAffine(own, turn, own.shape[::-1]), dtype=np.float64)
        value = overlap(reference, turned)
        best = max(best, (float(angle), value), key=lambda item: item[1])
    return best[0]
