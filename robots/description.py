"""What is known of a robot: its URDF, joints, limits, tool and gripper, read from its ``robot.toml``."""

from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field, PositiveFloat, model_validator

from cobot_lfd.description_file import DescriptionModel, read_description
from cobot_lfd.errors import DescriptionError
from cobot_lfd.motion.limits import JointLimits

_FOLDER = Path(__file__).parent

Names = Annotated[tuple[str, ...], Field(min_length=1)]
Numbers = tuple[float, ...]
PositiveNumbers = tuple[PositiveFloat, ...]


class LimitsDescription(DescriptionModel):
    """Joint limits as the maker publishes them, each with one number per joint."""

    position_lower: Numbers
    position_upper: Numbers
    velocity: PositiveNumbers
    acceleration: PositiveNumbers
    jerk: PositiveNumbers
    torque: PositiveNumbers


class GripperDescription(DescriptionModel):
    """A parallel gripper of two fingers that move against each other.

    Attributes:
        joints: Names of the two finger joints in the URDF.
        fingertip_links: Names of the two links that touch the part.
        maximum_opening: Distance between the open fingers [m].
        speed: Speed at which the opening changes [m/s].
        force: Force of each finger [N].
        friction: Coefficient of friction of the fingertips.
    """

    joints: tuple[str, str]
    fingertip_links: tuple[str, str]
    maximum_opening: PositiveFloat
    speed: PositiveFloat
    force: PositiveFloat
    friction: PositiveFloat


class TeachingDescription(DescriptionModel):
    """How the arm feels when it is led by hand: the damping left in each joint [N m s/rad]."""

    damping: PositiveNumbers


class RobotDescription(DescriptionModel):
    """A robot arm with its tool.

    Attributes:
        title: Maker and model, for people.
        urdf: Path of the URDF: beside robot.toml, or in pybullet_data.
        joints: Names of the arm's joints, from the base to the tool.
        tool_link: Link whose frame is the tool frame: z along the approach, y along the gripper's closing.
        parked: Joint positions out of the camera's view [rad].
        home: A comfortable working posture [rad].
        limits: Joint limits.
        gripper: The gripper.
        teaching: How the arm feels when it is led by hand.
    """

    title: str
    urdf: str
    joints: Names
    tool_link: str
    parked: Numbers
    home: Numbers
    limits: LimitsDescription
    gripper: GripperDescription
    teaching: TeachingDescription

    @model_validator(mode="after")
    def _one_number_per_joint(self) -> "RobotDescription":
        lists = {"parked": self.parked, "home": self.home, "teaching.damping": self.teaching.damping}
        lists |= {f"limits.{key}": value for key, value in self.limits}
        for key, values in lists.items():
            if len(values) != len(self.joints):
                raise ValueError(
                    f"{key} has {len(values)} numbers; it needs one for each of {len(self.joints)} joints."
                )
        return self

    @model_validator(mode="after")
    def _postures_within_limits(self) -> "RobotDescription":
        lower, upper = np.array(self.limits.position_lower), np.array(self.limits.position_upper)
        for key, posture in {"parked": self.parked, "home": self.home}.items():
            outside = np.flatnonzero((np.array(posture) < lower) | (np.array(posture) > upper))
            if outside.size:
                i = int(outside[0])
                raise ValueError(
                    f"{key}: joint {i + 1} is at {posture[i]} rad; it can take {lower[i]} to {upper[i]} rad."
                )
        return self

    @property
    def joint_limits(self) -> JointLimits:
        """The limits that a trajectory must keep."""
        return JointLimits(
            position_lower=np.array(self.limits.position_lower),
            position_upper=np.array(self.limits.position_upper),
            velocity=np.array(self.limits.velocity),
            acceleration=np.array(self.limits.acceleration),
            jerk=np.array(self.limits.jerk),
        )


def robot_names() -> tuple[str, ...]:
    """Names of the robots that there are."""
    return tuple(sorted(file.parent.name for file in _FOLDER.glob("*/robot.toml")))


def load_robot(name: str) -> RobotDescription:
    """The robot of this name.

    Raises:
        DescriptionError: If there is no such robot, or its file holds a value that is not allowed.
    """
    if name not in robot_names():
        raise DescriptionError(f"no robot named '{name}'; choose one of: {', '.join(robot_names())}.")
    return read_description(_FOLDER / name / "robot.toml", RobotDescription)
