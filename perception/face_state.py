"""What a fit of a face changes: where the face is, in what light, through what lens."""

from dataclasses import dataclass, replace

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from perception.face import SOFTER, Level

_POSE = 3  # Unknowns: x, y, angle; then come the light's.
_LEAST_CONTRAST = 0.2  # Of the picture, compared with the face.


@dataclass(frozen=True, slots=True, eq=False)
class FaceState:
    """Where a face is taken to be, in what light, through what lens.

    Attributes:
        frame: The pose.
        light: A factor of the face's brightness, what is added to it [0..255], the square of a further blur
            times the factor [px²], and how much the factor grows towards the ends of the frame's axes, (5,).
        lens: Number of the look of the face, of those through softer and softer lenses.
    """

    frame: Frame
    light: Array
    lens: int = 0

    def expected(self, level: Level) -> Array:
        """How bright the face's pixels must be, shape (n,)."""
        return level.looks[self.lens].shades @ self.light

    def jacobian(self, level: Level, free: int) -> Array:
        """How the difference of seen and expected brightness changes with the unknowns, shape (n, free)."""
        look = level.looks[self.lens]
        jacobian = np.empty((len(look.brightness), free))
        in_world = self.light[0] * look.gradients @ self.frame.rotation.T
        x, y = (level.local @ self.frame.rotation.T).T
        jacobian[:, :2] = in_world
        jacobian[:, 2] = in_world[:, 1] * x - in_world[:, 0] * y
        jacobian[:, _POSE:] = -look.shades[:, : free - _POSE]
        return jacobian

    def moved(self, step: Array) -> "FaceState":
        """A step further."""
        light = self.light.copy()
        light[: len(step) - _POSE] += step[_POSE:]
        return replace(
            self, frame=Frame(self.frame.position + step[:2], self.frame.angle + step[2]), light=light
        )

    @property
    def shows_the_face(self) -> bool:
        """Whether there is enough contrast; else the picture shows something else."""
        return bool(self.light[0] > _LEAST_CONTRAST)

    def through_the_right_lens(self) -> "FaceState":
        """The same with a look of the face that is as soft as the picture."""
        if not self.shows_the_face:
            return self
        variance = SOFTER[self.lens] ** 2 + self.light[2] / self.light[0]
        lens = int(np.argmin(np.abs(np.square(SOFTER) - variance)))
        light = self.light.copy()
        light[2] = self.light[0] * (variance - SOFTER[lens] ** 2) if lens == self.lens else 0.0
        return replace(self, light=light, lens=lens)
