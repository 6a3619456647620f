"""A planar path to the whole motion: approach, grasp, lift, carry, lower, release, retreat, return."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.motion import JointLimits, JointPath, JointTrajectory, move, time_path
from cobot_lfd.tool import tool_above
from robots import Kinematics, RobotDescription
from scenes import Task

_STEP = 0.004  # [m] between neighbouring poses of a straight line
_SETTLING_TIME = 0.2  # [s] that the gripper is given beyond the time in which its fingers can close
# A cobot beside a person moves well below what its joints could do.
_VELOCITY_SHARE, _ACCELERATION_SHARE, _JERK_SHARE = 0.5, 0.2, 0.1


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """A part of the motion during which the gripper keeps one opening.

    Attributes:
        name: What the arm does, for people.
        trajectory: How the joints move.
        opening: What the gripper is told to open to [m].
        holding: Whether the gripper must hold something at the end of the stage.
    """

    name: str
    trajectory: JointTrajectory
    opening: float
    holding: bool


def plan_motion(
    kinematics: Kinematics, robot: RobotDescription, task: Task, path: Array, yaw: float
) -> tuple[Stage, ...]:
    """The motion that carries a part along a path.

    Args:
        kinematics: Of the robot.
        robot: The robot, which waits in its parked posture.
        task: Heights at which the part is grasped, carried and released.
        path: Where the tool carries the part [m], shape (T, 2).
        yaw: Direction of the tool from the grasp to the release [rad].

    Returns:
        The stages, each from rest to rest, in their order.

    Raises:
        KinematicsError: If the tool cannot reach a pose of the motion.
        MotionError: If the motion breaks a limit of the joints.
    """
    limits = robot.joint_limits.scaled(
        velocity=_VELOCITY_SHARE, acceleration=_ACCELERATION_SHARE, jerk=_JERK_SHARE
    )
    start, goal = path[0], path[-1]
    open_, closed = robot.gripper.maximum_opening, 0.0
    grip_time = open_ / robot.gripper.speed + _SETTLING_TIME
    parked = np.array(robot.parked)

    def line(joints: Array, corners: list[list[float]]) -> Array:
        poses = [tool_above(point[:2], point[2], yaw) for point in _densify(np.array(corners))]
        return kinematics.follow(poses, joints)

    above = kinematics.inverse(tool_above(start, task.carry_height, yaw), np.array(robot.home))
    down = line(above, [[*start, task.carry_height], [*start, task.grasp_height]])
    up = down[::-1]
    carry = kinematics.follow([tool_above(point, task.carry_height, yaw) for point in path], up[-1])
    lower = line(carry[-1], [[*goal, task.carry_height], [*goal, task.release_height]])
    leave = lower[::-1]
    return (
        Stage("approach", move(parked, down[0], limits), open_, False),
        Stage("descend", _timed(down, limits), open_, False),
        Stage("grasp", JointTrajectory.hold(down[-1], grip_time), closed, True),
        Stage("lift", _timed(up, limits), closed, True),
        Stage("carry", _timed_samples(carry, limits), closed, True),
        Stage("lower", _timed(lower, limits), closed, True),
        Stage("release", JointTrajectory.hold(lower[-1], grip_time), open_, False),
        Stage("retreat", _timed(leave, limits), open_, False),
        Stage("return", move(leave[-1], parked, limits), open_, False),
    )


def _timed(waypoints: Array, limits: JointLimits) -> JointTrajectory:
    return time_path(JointPath.through(waypoints), limits)


def _timed_samples(waypoints: Array, limits: JointLimits) -> JointTrajectory:
    """The learnt path is an evenly sampled motion; where it turns back on itself, it slows down to do so."""
    return time_path(JointPath.through(waypoints, parameters=np.arange(len(waypoints))), limits)


def _densify(corners: Array) -> Array:
    """Points on the polygon through the corners [m], shape (M, 3), no farther apart than ``_STEP``."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    places = np.linspace(0.0, lengths[-1], max(2, int(np.ceil(lengths[-1] / _STEP)) + 1))
    return np.column_stack([np.interp(places, lengths, column) for column in corners.T])
