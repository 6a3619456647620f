"""A robot's body in a PyBullet simulation: its joints and tool by name."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pybullet
from pybullet_utils.bullet_client import BulletClient

from cobot_lfd.arrays import Array
from cobot_lfd.errors import DescriptionError
from cobot_lfd.pose import Pose
from cobot_lfd.quiet import quiet_output
from robots.compose import compose, find_urdf
from robots.description import RobotDescription
from robots.gripper import ParallelGripper

_SELF_COLLISION = pybullet.URDF_USE_SELF_COLLISION | pybullet.URDF_USE_SELF_COLLISION_EXCLUDE_PARENT

_INVISIBLE = pybullet.URDF_IGNORE_VISUAL_SHAPES


def connect() -> Any:
    """A simulation of its own, without a window."""
    with quiet_output():
        return BulletClient(pybullet.DIRECT)


class RobotBody:
    """The URDF of a robot, loaded with its base fixed.

    Attributes:
        client: The simulation that the body lives in.
        id: The body's number in the simulation.
        joints: Numbers of the arm's joints.
        fingers: Numbers of the two finger joints of a gripper that has fingers.
        fingertips: Numbers of its two fingertip links.
        links: Name of a link to its number.
        tool: Number of the tool link.
    """

    def __init__(
        self,
        client: Any,
        description: RobotDescription,
        *,
        self_collision: bool = False,
        visible: bool = True,
    ) -> None:
        """Load it.

        Args:
            client: The simulation.
            description: What is known of the robot.
            self_collision: Whether links that are no neighbours may hit one another.
            visible: Whether it is in pictures; they and the loading take less time without it.
        """
        self.client = client
        flags = (_SELF_COLLISION if self_collision else 0) | (0 if visible else _INVISIBLE)
        self.id = _load(client, description, flags)
        names = [client.getJointInfo(self.id, i) for i in range(client.getNumJoints(self.id))]
        joints = {info[1].decode(): info[0] for info in names}
        links = {info[12].decode(): info[0] for info in names}
        self.joints = [_find(joints, name, "joint", description) for name in description.joints]
        gripper = description.gripper
        parallel = gripper if isinstance(gripper, ParallelGripper) else None
        finger_names, fingertip_names = (parallel.joints, parallel.fingertip_links) if parallel else ((), ())
        self.fingers = [_find(joints, name, "joint", description) for name in finger_names]
        self.fingertips = [_find(links, name, "link", description) for name in fingertip_names]
        self.links = links
        self.tool = _find(links, description.tool_link, "link", description)
        movable = [info[0] for info in names if info[2] != pybullet.JOINT_FIXED]
        self._columns = [movable.index(joint) for joint in self.joints]
        self._movable = movable

    def place(self, positions: Array) -> None:
        """Set the joints to positions [rad], shape (n,), at rest and without physics."""
        places = np.asarray(positions, dtype=np.float64)[:, None].tolist()
        self.client.resetJointStatesMultiDof(self.id, self.joints, places, [[0.0]] * len(places))

    def boxes(self) -> Array:
        """Two opposite corners of a box around each link [m], shape (number of links, 2, 3).

        The sides of the boxes are parallel to the world's axes.
        """
        self.client.performCollisionDetection()
        links = range(-1, self.client.getNumJoints(self.id))
        return np.array([self.client.getAABB(self.id, link) for link in links])

    def joint_states(self) -> tuple[Array, Array]:
        """Positions [rad] and velocities [rad/s] of the arm's joints, each of shape (n,)."""
        states = self.client.getJointStates(self.id, self.joints)
        return np.array([s[0] for s in states]), np.array([s[1] for s in states])

    def tool_pose(self) -> Pose:
        """Pose of the tool in the world."""
        state = self.client.getLinkState(self.id, self.tool, computeForwardKinematics=True)
        return Pose.from_quaternion(state[4], state[5])

    def joint_axes(self) -> tuple[Array, Array]:
        """Directions of the joints' axes in the world, and a point on each [m], both of shape (n, 3)."""
        axes, points = [], []
        for joint in self.joints:
            state = self.client.getLinkState(self.id, joint, computeForwardKinematics=True)
            # PyBullet tells the axis in the frame of the link's centre of mass.
            axis = (
                Pose.from_quaternion(state[0], state[1]).rotation
                @ self.client.getJointInfo(self.id, joint)[13]
            )
            axes.append(axis / np.linalg.norm(axis))
            points.append(state[4])
        return np.array(axes), np.array(points)

    def tool_position(self) -> Array:
        """Position of the tool in the world [m], shape (3,)."""
        return np.array(self.client.getLinkState(self.id, self.tool, computeForwardKinematics=True)[4])

    def tool_velocity(self) -> tuple[Array, Array]:
        """Linear [m/s] and angular [rad/s] velocity of the tool in the world, each of shape (3,)."""
        state = self.client.getLinkState(self.id, self.tool, computeLinkVelocity=True)
        return np.array(state[6]), np.array(state[7])

    def jacobian(self, positions: Array) -> Array:
        """Of the tool's linear and angular velocity in the world by the joint velocities, shape (6, n)."""
        zeros = [0.0] * len(self._movable)
        linear, angular = self.client.calculateJacobian(
            self.id, self.tool, [0.0, 0.0, 0.0], self._all_positions(positions), zeros, zeros
        )
        return np.vstack([linear, angular])[:, self._columns]

    def gravity_torques(self, positions: Array) -> Array:
        """Joint torques that hold the arm still against gravity [N m], shape (n,)."""
        zeros = [0.0] * len(self._movable)
        torques = self.client.calculateInverseDynamics(self.id, self._all_positions(positions), zeros, zeros)
        return np.array(torques)[self._columns]

    def dynamics_torques(self, positions: Array, velocities: Array, accelerations: Array) -> Array:
        """Joint torques [N m], shape (n,), under which the arm has these accelerations [rad/s²], (n,)."""
        rates, gains = np.zeros(len(self._movable)), np.zeros(len(self._movable))
        rates[self._columns], gains[self._columns] = velocities, accelerations
        torques = self.client.calculateInverseDynamics(
            self.id, self._all_positions(positions), rates.tolist(), gains.tolist()
        )
        return np.array(torques)[self._columns]

    def _all_positions(self, positions: Array) -> list[float]:
        """Positions of all movable joints: the arm's as given, the fingers' as they are."""
        everything = [state[0] for state in self.client.getJointStates(self.id, self._movable)]
        for column, position in zip(self._columns, positions, strict=True):
            everything[column] = float(position)
        return everything


def _load(client: Any, description: RobotDescription, flags: int) -> int:
    """Load the arm with its tool; returns the body's number."""
    urdf = find_urdf(description.urdf, description.package)
    placed = {"basePosition": list(description.base), "useFixedBase": True, "flags": flags}
    with quiet_output():
        if not description.parts:
            return int(client.loadURDF(str(urdf), **placed))
        with TemporaryDirectory() as folder:
            file = Path(folder) / "robot.urdf"
            file.write_text(compose(urdf, description.mount, description.parts), encoding="utf-8")
            return int(client.loadURDF(str(file), **placed))


def _find(numbers: dict[str, int], name: str, kind: str, description: RobotDescription) -> int:
    if name not in numbers:
        raise DescriptionError(
            f"{description.urdf} has no {kind} named '{name}'; choose among: {', '.join(sorted(numbers))}."
        )
    return numbers[name]
