"""The arm in the simulation: led by hand, or following a trajectory."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pybullet

from cobot_lfd.arrays import Array
from cobot_lfd.pose import Pose
from robots.body import RobotBody
from robots.description import RobotDescription
from robots.grip import make_grip
from robots.impedance import posture_torques, tool_wrench

_POSITION_GAIN = 0.5  # share of a joint's error that its motor removes in one step
_VELOCITY_GAIN = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class ArmState:
    """What the arm's own sensors tell.

    Attributes:
        positions: Joint positions [rad], shape (n,).
        velocities: Joint velocities [rad/s], shape (n,).
        torques: Torques of the joints' motors [N m], shape (n,).
        world_from_tool: Pose of the tool.
        tool_velocity: Linear velocity of the tool [m/s], shape (3,).
        tool_rate: Angular velocity of the tool [rad/s], shape (3,).
        opening: Distance between the fingers [m].
    """

    positions: Array
    velocities: Array
    torques: Array
    world_from_tool: Pose
    tool_velocity: Array
    tool_rate: Array
    opening: float


class Arm:
    """A robot arm with a tool, in a simulation that steps elsewhere.

    Before every step of the simulation call either ``lead`` (the arm is compliant and a hand pulls it) or
    ``follow`` (the arm holds joint positions), and ``grip`` when the gripper's opening is to change.

    Attributes:
        description: What is known of the robot.
        body: Its joints and links in the simulation.
    """

    def __init__(self, client: Any, description: RobotDescription, *, visible: bool = True) -> None:
        """Add it, parked.

        Args:
            client: The simulation.
            description: What is known of the robot.
            visible: Whether it is in pictures; they and the loading take less time without it.
        """
        self.description = description
        self.body = RobotBody(client, description, visible=visible)
        self._client = client
        self._drive_motors = client.setJointMotorControlArray  # looked up once: it is called at every step
        self._motors = {
            "forces": list(description.limits.torque),
            "positionGains": [_POSITION_GAIN] * len(description.joints),
            "velocityGains": [_VELOCITY_GAIN] * len(description.joints),
        }
        self._torques = np.zeros(len(description.joints))
        self._led = False
        self.body.place(np.array(description.parked))
        self._grip = make_grip(client, self.body, description.gripper)
        self.follow(description.parked, [0.0] * len(description.joints))
        self.grip(description.gripper.maximum_opening)

    def state(self) -> ArmState:
        """What the arm's own sensors tell now."""
        positions, velocities = self.body.joint_states()
        linear, angular = self.body.tool_velocity()
        return ArmState(
            positions,
            velocities,
            self._motor_torques(),
            self.body.tool_pose(),
            linear,
            angular,
            self.opening(),
        )

    def lead(self, force: Array, torque: Array) -> None:
        """Be compliant for one step: weightless, lightly damped, and pulled by a hand at the tool.

        Args:
            force: The hand's force in the world [N], shape (3,).
            torque: The hand's torque in the world [N m], shape (3,).
        """
        positions, velocities = self.body.joint_states()
        damping = np.array(self.description.teaching.damping)
        self._torques = self.body.gravity_torques(positions) - damping * velocities
        self._drive()
        point = self.body.tool_pose().position.tolist()
        world = pybullet.WORLD_FRAME
        self._client.applyExternalForce(self.body.id, self.body.tool, list(map(float, force)), point, world)
        self._client.applyExternalTorque(self.body.id, self.body.tool, list(map(float, torque)), world)
        self._grip.update()
        self._led = True

    def follow(self, positions: Sequence[float] | Array, velocities: Sequence[float] | Array) -> None:
        """Drive the joints to positions [rad] at velocities [rad/s], n of each, in the next step."""
        self._drive_motors(
            self.body.id,
            self.body.joints,
            pybullet.POSITION_CONTROL,
            targetPositions=positions,
            targetVelocities=velocities,
            **self._motors,
        )
        self._grip.update()
        self._led = False

    def comply(self, positions: Array, velocities: Array, accelerations: Array, stiffness: Array) -> None:
        """Follow joint positions for one step as if pulled there by springs at the tool.

        Args:
            positions: Wanted joint positions [rad], shape (n,).
            velocities: Wanted joint velocities [rad/s], shape (n,).
            accelerations: Wanted joint accelerations [rad/s²], shape (n,).
            stiffness: Of the tool in x and y of the world [N/m], shape (2, 2).
        """
        actual, rates = self.body.joint_states()
        jacobian = self.body.jacobian(actual)
        error, error_rate = positions - actual, velocities - rates
        wrench = tool_wrench(stiffness, jacobian @ error, jacobian @ error_rate)
        carried = self.body.dynamics_torques(actual, rates, accelerations)
        held = posture_torques(jacobian, error, error_rate)
        most = np.array(self.description.limits.torque)
        self._torques = np.clip(carried + jacobian.T @ wrench + held, -most, most)
        self._drive()
        self._grip.update()
        self._led = True

    def _drive(self) -> None:
        """Let the joints' motors exert the torques, and nothing else, in the next step."""
        body, joints, zeros = self.body.id, self.body.joints, [0.0] * len(self.body.joints)
        self._client.setJointMotorControlArray(
            body, joints, pybullet.VELOCITY_CONTROL, targetVelocities=zeros, forces=zeros
        )
        self._client.setJointMotorControlArray(
            body, joints, pybullet.TORQUE_CONTROL, forces=self._torques.tolist()
        )

    def hold(self) -> None:
        """Stay where the arm is now, until something else is asked of it."""
        positions, _ = self.body.joint_states()
        self.follow(positions.tolist(), [0.0] * len(positions))

    def grip(self, opening: float) -> None:
        """Move the fingers towards an opening [m]; a suction cup sucks at 0 and lets go at more."""
        self._grip.command(opening)

    def holds_something(self) -> bool:
        """Whether the gripper's own sensor says that it holds something."""
        return self._grip.holds_something()

    def tool_position(self) -> Array:
        """Where the tool is in the world [m], shape (3,)."""
        return self.body.tool_position()

    def opening(self) -> float:
        """Distance between the fingers [m]; of a suction cup 0 while it sucks."""
        return self._grip.opening()

    def _motor_torques(self) -> Array:
        if self._led:
            return self._torques
        return np.array([state[3] for state in self._client.getJointStates(self.body.id, self.body.joints)])
