"""The tool over a table: the rotations and yaws that a gripper takes from above."""

import math

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


def grasp_yaw(angle: float, symmetry: int, preferred: float = 0.0) -> float:
    """Yaw at which a gripper of two fingers grasps an object [rad].

    Of the yaws that the symmetry of object and gripper make equal it is the nearest to ``preferred``.

    Args:
        angle: Direction of the object [rad].
        symmetry: Number of turns within a full circle that look the same.
        preferred: Yaw at which the arm is most comfortable [rad].
    """
    turn = 2 * np.pi / math.lcm(symmetry, 2)
    return wrap_angle(angle - turn * np.round((angle - preferred) / turn))
