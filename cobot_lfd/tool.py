"""The tool over a table: the rotations and yaws that a gripper takes from above."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.arrays import Array
from cobot_lfd.frame import wrap_angle
from cobot_lfd.pose import Pose


def pointing_down(yaw: float) -> Array:
    """Rotation of a tool whose z axis points down and whose x axis points along ``yaw`` [rad]: (3, 3)."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    return np.array([[cos, sin, 0.0], [sin, -cos, 0.0], [0.0, 0.0, -1.0]])


def tool_above(point: ArrayLike, height: float, yaw: float) -> Pose:
    """Pose of a tool that points down, turned by ``yaw`` [rad], at a height [m] above a point (x, y) [m]."""
    return Pose(np.array([*np.asarray(point), height]), pointing_down(yaw))


@dataclass(frozen=True, slots=True)
class ToolTurn:
    """How the tool turns about the vertical while it goes along a path.

    Attributes:
        start: Yaw at the path's start [rad].
        end: Yaw at the path's end [rad].
        begins: Share of the path's length at which the tool begins to turn.
        ends: Share of the path's length at which it has turned.
    """

    start: float
    end: float
    begins: float = 0.1
    ends: float = 0.6

    @classmethod
    def none(cls, yaw: float) -> "ToolTurn":
        """No turn at all."""
        return cls(yaw, yaw)

    def along(self, path: ArrayLike) -> Array:
        """The yaw [rad], shape (M,), at each point of a path [m], shape (M, 2), with little jerk along it."""
        lengths = np.linalg.norm(np.diff(np.asarray(path, dtype=np.float64), axis=0), axis=1)
        shares = np.concatenate([[0.0], np.cumsum(lengths)]) / max(lengths.sum(), 1e-12)
        u = np.clip((shares - self.begins) / max(self.ends - self.begins, 1e-12), 0.0, 1.0)
        return np.asarray(self.start + (self.end - self.start) * u**3 * (10.0 - 15.0 * u + 6.0 * u**2))


def equal_yaws(direction: float, turns: int, preferred: float = 0.0) -> list[float]:
    """The yaws that do equally well [rad], the nearest to ``preferred`` first.

    Args:
        direction: One of them [rad].
        turns: How many there are within a full circle.
        preferred: Yaw at which the arm is most comfortable [rad]; all are within half a circle of it.
    """
    yaws = [preferred + wrap_angle(direction + 2 * np.pi * k / turns - preferred) for k in range(turns)]
    return sorted(yaws, key=lambda yaw: abs(yaw - preferred))
