"""How a tool takes hold of a part in the simulation, by fingers or by suction."""

from typing import Any, Protocol

import numpy as np
import pybullet

from cobot_lfd.arrays import Array
from robots.body import RobotBody
from robots.gripper import GripperDescription, NoGripper, ParallelGripper, SuctionGripper

_EMPTY_OPENING = 0.004  # [m]; closed fingers that are nearer to each other hold nothing
_SPINNING_FRICTION = 0.002  # [m]
# Fingers that open do not hold by friction. The simulator sometimes gives a contact a normal that is slanted
# by 40 degrees; at the friction of closed fingers a part then jams, and 20 N cannot open them.
_OPENING_FRICTION = 0.1
_LOST = 0.005  # [m]; a part that has come this far off the cup has lost it
_TOUCHING = 0.002  # [m]; a cup's lip gives way by so much
_BEHIND = 0.005  # [m]; a face at the axis is looked for from so far inside the cup ...
_BEYOND = 0.005  # ... to so far beyond its lip, which bends to a ball that it meets beside its top


class Grip(Protocol):
    """What takes hold."""

    def command(self, opening: float) -> None:
        """Close (0) or open to a width [m]."""

    def update(self) -> None:
        """Do what must be done before each step of the simulation."""

    def opening(self) -> float:
        """The width to which it is open [m]."""
        ...

    def holds_something(self) -> bool:
        """Whether its own sensor says that it holds a part."""
        ...


def make_grip(client: Any, body: RobotBody, gripper: GripperDescription) -> Grip:
    """The grip that a description describes, open."""
    match gripper:
        case ParallelGripper():
            return Fingers(client, body, gripper)
        case SuctionGripper():
            return Suction(client, body, gripper)
        case NoGripper():
            return NoGrip(gripper)


class Fingers:
    """Two fingers that move against each other and hold by friction."""

    def __init__(self, client: Any, body: RobotBody, gripper: ParallelGripper) -> None:
        self._client, self._body, self._gripper = client, body, gripper
        self._closing = False
        for finger in body.fingers:
            client.resetJointState(body.id, finger, 0.5 * gripper.maximum_opening)
        self._couple()

    def command(self, opening: float) -> None:
        """Move the fingers towards an opening [m] with the speed and force that the gripper has."""
        self._closing = opening < _EMPTY_OPENING
        self._grip_by(self._gripper.friction if self._closing else _OPENING_FRICTION)
        for finger in self._body.fingers:
            self._client.setJointMotorControl2(
                self._body.id,
                finger,
                pybullet.POSITION_CONTROL,
                targetPosition=0.5 * opening,
                force=self._gripper.force,
                maxVelocity=0.5 * self._gripper.speed,
            )

    def update(self) -> None:
        """Nothing to do: the motors keep doing what they were told."""

    def opening(self) -> float:
        """Distance between the fingers [m]."""
        fingers = self._client.getJointStates(self._body.id, self._body.fingers)
        return float(sum(finger[0] for finger in fingers))

    def holds_something(self) -> bool:
        """Whether something keeps the fingers apart that are closing, as the gripper's own encoder tells."""
        return self._closing and self.opening() > _EMPTY_OPENING

    def _grip_by(self, friction: float) -> None:
        for link in self._body.fingertips:
            self._client.changeDynamics(
                self._body.id, link, lateralFriction=friction, spinningFriction=_SPINNING_FRICTION
            )
            for contact in self._client.getContactPoints(bodyA=self._body.id, linkIndexA=link):
                for together in (0, 1):  # contacts that last keep the friction with which they began
                    self._client.setCollisionFilterPair(self._body.id, contact[2], link, contact[4], together)

    def _couple(self) -> None:
        """Let the two fingers move by equal amounts, as the belt in the hand makes them."""
        gear = self._client.createConstraint(
            self._body.id,
            self._body.fingers[0],
            self._body.id,
            self._body.fingers[1],
            jointType=pybullet.JOINT_GEAR,
            jointAxis=[1, 0, 0],
            parentFramePosition=[0, 0, 0],
            childFramePosition=[0, 0, 0],
        )
        self._client.changeConstraint(gear, gearRatio=-1, erp=0.1, maxForce=50)


class Suction:
    """A cup that sticks to a face that it touches near its axis."""

    def __init__(self, client: Any, body: RobotBody, gripper: SuctionGripper) -> None:
        self._client, self._body, self._gripper = client, body, gripper
        self._cup = body.links[gripper.link]
        self._sucking = False
        self._constraint: int | None = None
        self._held = -1
        self._cup_from_part = np.zeros(3)

    def command(self, opening: float) -> None:
        """Suck (0) or let go."""
        self._sucking = opening <= 0.0
        if not self._sucking:
            self._let_go()

    def update(self) -> None:
        """Stick to what the cup has come to touch; let go of what was torn off."""
        if self._constraint is not None and self._displacement() > _LOST:
            self._let_go()
        if self._sucking and self._constraint is None:
            self._try_to_stick()

    def opening(self) -> float:
        """0 while it sucks."""
        return 0.0 if self._sucking else self._gripper.maximum_opening

    def holds_something(self) -> bool:
        """Whether there is a vacuum."""
        return self._constraint is not None

    def _try_to_stick(self) -> None:
        contacts = self._client.getContactPoints(bodyA=self._body.id, linkIndexA=self._cup)
        touched = {int(contact[2]) for contact in contacts if contact[8] < _TOUCHING}
        part = self._face_at_axis() if touched else None
        if part in touched:
            self._stick(part)

    def _face_at_axis(self) -> int | None:
        """The body that has a face across the cup's axis, at its lip; None where there is none."""
        lip, axis = self._lip()
        hit = self._client.rayTest((lip - _BEHIND * axis).tolist(), (lip + _BEYOND * axis).tolist())[0]
        aligned = -(np.array(hit[4]) @ axis) > np.cos(np.deg2rad(self._gripper.alignment_deg))
        return int(hit[0]) if hit[0] >= 0 and aligned else None

    def _lip(self) -> tuple[Array, Array]:
        """The middle of the cup's lip in the world [m], and the direction in which the cup points."""
        pose = self._body.tool_pose()
        return pose.position, pose.rotation[:, 2]

    def _stick(self, part: int) -> None:
        cup_from_world = self._client.invertTransform(*self._cup_state())
        pose = self._client.getBasePositionAndOrientation(part)
        cup_from_part = self._client.multiplyTransforms(*cup_from_world, *pose)
        self._constraint = self._client.createConstraint(
            self._body.id,
            self._cup,
            part,
            -1,
            jointType=pybullet.JOINT_FIXED,
            jointAxis=[0, 0, 0],
            parentFramePosition=cup_from_part[0],
            childFramePosition=[0, 0, 0],
            parentFrameOrientation=cup_from_part[1],
        )
        self._client.changeConstraint(self._constraint, maxForce=self._gripper.force)
        self._held, self._cup_from_part = part, np.array(cup_from_part[0])

    def _let_go(self) -> None:
        if self._constraint is not None:
            self._client.removeConstraint(self._constraint)
            self._constraint = None

    def _displacement(self) -> float:
        """How far the part has come off its place at the cup [m]."""
        position, rotation = self._cup_pose()
        part, _ = self._client.getBasePositionAndOrientation(self._held)
        return float(np.linalg.norm(position + rotation @ self._cup_from_part - part))

    def _cup_state(self) -> tuple[Any, Any]:
        state = self._client.getLinkState(self._body.id, self._cup)
        return state[0], state[1]

    def _cup_pose(self) -> tuple[Any, Any]:
        position, orientation = self._cup_state()
        rotation = np.array(self._client.getMatrixFromQuaternion(orientation)).reshape(3, 3)
        return np.array(position), rotation


class NoGrip:
    """A tool that takes hold of nothing."""

    def __init__(self, gripper: NoGripper) -> None:
        self._opening = gripper.maximum_opening

    def command(self, opening: float) -> None:
        """Nothing to do."""

    def update(self) -> None:
        """Nothing to do."""

    def opening(self) -> float:
        """A number that never changes [m]."""
        return self._opening

    def holds_something(self) -> bool:
        """Never."""
        return False
