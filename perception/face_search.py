"""Looks for a face at all places and angles in a part of a picture, whatever noise and blur leave of it."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.appearance import Appearance
from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.frame import Frame
from perception.brightness import brightness
from perception.foreground import Part
from perception.rigid import on_plane

_SIDE = 10.0  # Of a face in the small pictures that are compared, the shorter one [px].
_N_ANGLES = 48
_LEAST_ALIKE = 0.4  # Correlation from which on a place is worth a closer look.
_SAME_ANGLE = 2  # Steps within which two poses are one.


@dataclass(frozen=True, slots=True, eq=False)
class Search:
    """A face, prepared for being looked for: small pictures of it at all angles, along the world's axes.

    Attributes:
        turned: The face at each angle, shape (side, side) each.
        masks: Where in those it is, shape (side, side) each.
        step: Distance of their pixels [m].
        blur: Of a picture, which takes what is too fine for them [px].
        z: Height of the face [m].
    """

    turned: tuple[NDArray[Any], ...]
    masks: tuple[NDArray[Any], ...]
    step: float
    blur: float
    z: float

    @classmethod
    def of(cls, appearance: Appearance) -> "Search":
        """From what the face looks like."""
        reach = float(np.linalg.norm(appearance.outline, axis=1).max())
        step = float(np.ptp(appearance.outline, axis=0).min()) / _SIDE
        side = 2 * int(np.ceil(reach / step)) + 1
        places = _grid(-0.5 * (side - 1) * step * np.ones(2), step, (side, side))
        blur = 0.5 * step / appearance.metres_per_pixel
        image = cv2.GaussianBlur(brightness(appearance.image).astype(np.float32), (0, 0), blur)
        inside = np.zeros(image.shape, np.float32)
        cv2.fillPoly(inside, [np.rint(appearance.to_pixels(appearance.outline)).astype(np.int32)], 1.0)
        turned, masks = [], []
        for angle in _angles():
            pixels = appearance.to_pixels(Frame(np.zeros(2), angle).localise(places))
            turned.append(_sampled(image, pixels, cv2.BORDER_REPLICATE))
            masks.append(np.rint(_sampled(inside, pixels, cv2.BORDER_CONSTANT)))
        return cls(tuple(turned), tuple(masks), step, blur, appearance.z)

    def poses(
        self, image: NDArray[np.uint8], camera: Camera, parts: Iterable[Part], most: int
    ) -> list[Frame]:
        """The poses at which parts of a picture are most like the face, the likeliest first.

        Args:
            image: How bright the picture is.
            camera: The camera that took it.
            parts: Where to look.
            most: How many poses to return at most.
        """
        found = [hit for part in parts for hit in self._in_part(image, camera, part)]
        poses: list[Frame] = []
        for _, frame in sorted(found, key=lambda hit: -hit[0]):
            if len(poses) == most:
                break
            if not any(self._same(frame, pose) for pose in poses):
                poses.append(frame)
        return poses

    def _in_part(self, image: NDArray[np.uint8], camera: Camera, part: Part) -> Iterable[tuple[float, Frame]]:
        """For each angle how alike the likeliest place in a part of the picture is, and the pose."""
        rows, columns = part
        corners = [[u, v] for u in (columns.start, columns.stop) for v in (rows.start, rows.stop)]
        world = camera.to_plane(np.array(corners, float) - 0.5, self.z)
        half = len(self.turned[0]) // 2
        low = world.min(axis=0)
        width, height = (np.ceil(np.ptp(world, axis=0) / self.step).astype(int) + 1).tolist()
        places = _grid(low, self.step, (height, width))
        smooth = cv2.GaussianBlur(image[rows, columns].astype(np.float32), (0, 0), self.blur)
        pixels = camera.project(on_plane(places, self.z)) - [columns.start, rows.start]
        seen = _sampled(smooth, pixels, cv2.BORDER_REPLICATE)
        seen = cv2.copyMakeBorder(seen, half, half, half, half, cv2.BORDER_REPLICATE)
        for angle, turned, mask in zip(_angles(), self.turned, self.masks, strict=True):
            alike = cv2.matchTemplate(seen, turned, cv2.TM_CCOEFF_NORMED, mask=mask)
            alike = np.where(np.abs(alike) <= 1.0, alike, -1.0)
            row, column = np.unravel_index(np.argmax(alike), alike.shape)
            if alike[row, column] > _LEAST_ALIKE:
                yield float(alike[row, column]), Frame(places[row, column], angle)

    def _same(self, a: Frame, b: Frame) -> bool:
        turn = abs(np.mod(a.angle - b.angle + np.pi, 2 * np.pi) - np.pi)
        near = np.linalg.norm(a.position - b.position) < 0.3 * _SIDE * self.step
        return bool(near and turn < (_SAME_ANGLE + 0.5) * 2 * np.pi / _N_ANGLES)


def _angles() -> Array:
    return np.linspace(-np.pi, np.pi, _N_ANGLES, endpoint=False)


def _grid(low: Array, step: float, shape: tuple[int, int]) -> Array:
    """Places a step apart as a picture of the plane, its rows from large y to small, shape (*shape, 2)."""
    rows, columns = np.indices(shape)
    return np.asarray(low + step * np.stack([columns, shape[0] - 1 - rows], axis=-1))


def _sampled(image: NDArray[Any], pixels: Array, border: int) -> NDArray[Any]:
    """An image at places in it, column and row, shape (rows, columns, 2)."""
    x, y = np.moveaxis(pixels, -1, 0).astype(np.float32)
    return np.asarray(cv2.remap(image, x, y, cv2.INTER_LINEAR, borderMode=border))
