"""An arm as a chain of turning joints: poses and Jacobians of its tool for many postures at once."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array, frozen_array
from robots.body import RobotBody


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """Where the tool is in each of M postures, and how it moves there.

    Attributes:
        positions: Of the tool in the world [m], shape (M, 3).
        rotations: From the tool's axes to the world's, shape (M, 3, 3).
        jacobians: Of the tool's linear and angular velocity by the joint velocities, shape (M, 6, n).
    """

    positions: Array
    rotations: Array
    jacobians: Array


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """Forward kinematics as a product of rotations about the joints' axes.

    All is told of the posture in which every joint is at 0, so that the formula needs no frames of links:
    a tool pose is ``exp(S_1 q_1) ... exp(S_n q_n) M`` with a screw ``S_i`` for each axis (Lynch and Park,
    Modern Robotics, 2017, eq. 4.14).

    Attributes:
        axes: Directions of the joints' axes in the world, unit vectors, shape (n, 3).
        points: A point on each axis [m], shape (n, 3).
        tool_position: Of the tool in the world [m], shape (3,).
        tool_rotation: From the tool's axes to the world's, shape (3, 3).
    """

    axes: Array
    points: Array
    tool_position: Array
    tool_rotation: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "axes", frozen_array(self.axes, "axes", (None, 3)))
        object.__setattr__(self, "points", frozen_array(self.points, "points", (len(self.axes), 3)))
        object.__setattr__(self, "tool_position", frozen_array(self.tool_position, "tool_position", (3,)))
        object.__setattr__(self, "tool_rotation", frozen_array(self.tool_rotation, "tool_rotation", (3, 3)))

    @classmethod
    def of(cls, body: RobotBody) -> "Chain":
        """The chain of a robot's body in the simulation, which is left in its posture of zeros."""
        body.place(np.zeros(len(body.joints)))
        axes, points = body.joint_axes()
        tool = body.tool_pose()
        return cls(axes, points, tool.position, tool.rotation)

    def reach(self, postures: Array) -> Reach:
        """Poses and Jacobians of the tool at joint positions [rad], shape (M, n)."""
        turns = self._turns(postures)
        origin, rotation = np.zeros((len(postures), 3)), np.broadcast_to(np.eye(3), (len(postures), 3, 3))
        origins, directions = [], []
        before = np.zeros(3)
        for i, (axis, point) in enumerate(zip(self.axes, self.points, strict=True)):
            origin = origin + rotation @ (point - before)
            origins.append(origin)
            directions.append(rotation @ axis)
            rotation = rotation @ turns[:, i]
            before = point
        positions = origin + rotation @ (self.tool_position - before)
        angular = np.stack(directions, axis=1)
        linear = np.cross(angular, positions[:, None] - np.stack(origins, axis=1))
        jacobians = np.swapaxes(np.concatenate([linear, angular], axis=2), 1, 2)
        return Reach(positions, rotation @ self.tool_rotation, jacobians)

    def _turns(self, postures: Array) -> Array:
        """The rotation of each joint in each posture, shape (M, n, 3, 3), by Rodrigues' formula."""
        x, y, z = self.axes.T
        zero = np.zeros_like(x)
        cross = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
        sines, cosines = np.sin(postures)[..., None, None], np.cos(postures)[..., None, None]
        return np.asarray(np.eye(3) + sines * cross + (1.0 - cosines) * (cross @ cross))
