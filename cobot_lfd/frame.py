"""A planar task frame: where an object sits on the table, and which way it points."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.arrays import Array, frozen_array


class FrameKind(Enum):
    """Whether the task depends on the direction of a frame (paper, section 1.3)."""

    ORIENTED = "oriented"
    ORIENTATION_LESS = "orientation-less"


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A planar task frame: where an object sits on the table, and which way it points.

    A point ``p`` given in this frame is ``rotation @ p + position`` in the world.

    Attributes:
        position: Origin in the world [m], shape (2,).
        angle: Direction of the frame's x axis in the world [rad], in (-pi, pi].
    """

    position: Array
    angle: float

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "position", frozen_array(self.position, "position", (2,)))
        angle = float(self.angle)
        if not np.isfinite(angle):
            raise ValueError(f"angle is {angle}; it must be a finite number [rad].")
        object.__setattr__(self, "angle", wrap_angle(angle))

    @property
    def rotation(self) -> Array:
        """Rotation matrix that takes the frame's axes to the world's, shape (2, 2)."""
        cos, sin = np.cos(self.angle), np.sin(self.angle)
        return np.array([[cos, -sin], [sin, cos]])

    def __matmul__(self, other: "Frame") -> "Frame":
        """Chain two frames: ``world_from_b = world_from_a @ a_from_b``."""
        return Frame(self.apply(other.position), self.angle + other.angle)

    def inverse(self) -> "Frame":
        """The frame that undoes this one: ``frame.inverse() @ frame`` is the identity."""
        return Frame(-self.rotation.T @ self.position, -self.angle)

    def apply(self, points: ArrayLike) -> Array:
        """Take points given in this frame [m], shape (..., 2), to the world."""
        return np.asarray(points, dtype=np.float64) @ self.rotation.T + self.position

    def localise(self, points: ArrayLike) -> Array:
        """Take points given in the world [m], shape (..., 2), to this frame (paper, eq. 1)."""
        return (np.asarray(points, dtype=np.float64) - self.position) @ self.rotation


def wrap_angle(angle: float) -> float:
    """The same direction [rad] as an angle in (-pi, pi]."""
    wrapped = np.pi - np.mod(np.pi - angle, 2 * np.pi)
    return float(wrapped)
