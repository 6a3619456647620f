"""What is known of a robot: its URDF, joints, limits, tool and gripper, read from its ``robot.toml``."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field, PositiveFloat, model_validator

from cobot_lfd.description_file import DescriptionModel, read_description, read_toml
from cobot_lfd.errors import DescriptionError
from cobot_lfd.motion.limits import JointLimits
from robots.gripper import GripperDescription
from robots.parts import Mount, Part

_FOLDER = Path(__file__).parent
_TOOLS = _FOLDER / "tools"

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


class TeachingDescription(DescriptionModel):
    """How the arm feels when it is led by hand: the damping left in each joint [N m s/rad]."""

    damping: PositiveNumbers


class RobotDescription(DescriptionModel):
    """A robot arm with its tool.

    Attributes:
        title: Maker and model, for people.
        urdf: Path of the URDF in pybullet_data or in another package.
        package: Name of the package that the URDF comes with; pybullet_data by default.
        base: Where its base stands in the world [m].
        joints: Names of the arm's joints, from the base to the tool.
        mount: Where tools are mounted.
        parts: The tool's links by name, where it is not part of the URDF.
        tool_link: Link whose frame is the tool frame: z along the approach, y along the gripper's closing.
        parked: Joint positions out of the camera's view [rad].
        home: A comfortable working posture [rad].
        branches: Other postures from which inverse kinematics may start [rad].
        limits: Joint limits.
        gripper: The gripper.
        teaching: How the arm feels when it is led by hand.
    """

    title: str
    urdf: str
    package: str | None = None
    base: tuple[float, float, float] = (0.0, 0.0, 0.0)
    joints: Names
    mount: Mount
    parts: Annotated[Mapping[str, Part], Field(default_factory=dict)]
    tool_link: str
    parked: Numbers
    home: Numbers
    branches: tuple[Numbers, ...] = ()
    limits: LimitsDescription
    gripper: GripperDescription
    teaching: TeachingDescription

    @model_validator(mode="after")
    def _one_number_per_joint(self) -> "RobotDescription":
        lists = {"parked": self.parked, "home": self.home, "teaching.damping": self.teaching.damping}
        lists |= {f"branches.{i}": branch for i, branch in enumerate(self.branches)}
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
    """Names of the robots that there are, whether or not their URDFs are installed."""
    return tuple(sorted(file.parent.name for file in _FOLDER.glob("*/robot.toml")))


def tool_names() -> tuple[str, ...]:
    """Names of the tools that can be mounted on every robot."""
    return tuple(sorted(file.stem for file in _TOOLS.glob("*.toml")))


def load_robot(name: str, tool: str = "gripper") -> RobotDescription:
    """A robot with a tool.

    A robot that has a gripper of its own uses that one; all other tools are mounted on its flange.

    Args:
        name: Name of the robot.
        tool: Name of the tool.

    Raises:
        DescriptionError: If there is no such robot or tool, or a file holds a value that is not allowed.
    """
    if name not in robot_names():
        raise DescriptionError(f"no robot named '{name}'; choose one of: {', '.join(robot_names())}.")
    if tool not in tool_names():
        raise DescriptionError(f"no tool named '{tool}'; choose one of: {', '.join(tool_names())}.")
    file = _FOLDER / name / "robot.toml"
    return read_description(file, RobotDescription, partial(_with_tool, tool=tool))


def _with_tool(content: dict[str, Any], tool: str) -> dict[str, Any]:
    """A robot's description with that of a tool in it."""
    if tool == "gripper" and "gripper" in content:
        return content
    mounted = read_toml(_TOOLS / f"{tool}.toml")
    return content | {key: mounted[key] for key in ("tool_link", "gripper", "parts")}
