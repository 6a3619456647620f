"""A planar path to the whole motion: approach, grasp, lift, carry, lower, release, retreat, return."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from cobot_lfd.app.choices import Choice, choices
from cobot_lfd.app.geometry import densify, farthest_from
from cobot_lfd.arrays import Array
from cobot_lfd.errors import MotionError
from cobot_lfd.motion import JointLimits, JointPath, JointTrajectory, TimingMethod, move, time_path
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from cobot_lfd.tool import ToolTurn, tool_above
from robots import CollisionCheck, CollisionError, Kinematics, KinematicsError, RobotDescription, thinned
from scenes import Task

_STEP = 0.004  # [m] between neighbouring poses of a straight line
_SETTLING_TIME = 0.2  # [s] that the gripper is given beyond the time in which its fingers can close
# A cobot beside a person moves well below what its joints could do.
_VELOCITY_SHARE, _ACCELERATION_SHARE, _JERK_SHARE = 0.5, 0.2, 0.1
_MOST_DEVIATION = 0.001  # [m] by which the planned tool may leave the generated path
_N_DEVIATIONS = 60  # places along the carry at which that is checked
_CHECK_EVERY = 3  # poses of a line between two that are checked for collisions
_N_FREE = 25  # postures of a free movement that are checked for collisions


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


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """What the arm must not hit, as far as it was seen.

    Attributes:
        obstacles: What stands around, without the part.
        part: The part that is carried, where it is before; None where nothing is.
    """

    obstacles: tuple[Obstacle, ...] = ()
    part: Obstacle | None = None


def plan_motion(
    kinematics: Kinematics,
    robot: RobotDescription,
    task: Task,
    path: Array,
    turns: Sequence[ToolTurn],
    surroundings: Surroundings | None = None,
    *,
    detours: Iterable[Array] = (),
    timing: TimingMethod = "simple",
) -> tuple[Stage, ...]:
    """The motion that carries a part along a path.

    Where the first choice cannot be carried out, the others are tried: another turn of the tool, another
    branch of the inverse kinematics, the detours, and at last a carry lifted to the height at which the tool
    travels.

    Args:
        kinematics: Of the robot.
        robot: The robot, which waits in its parked posture.
        task: Heights at which the part is grasped, carried and released.
        path: Where the tool carries the part [m], shape (T, 2).
        turns: How the tool may be turned, the best first.
        surroundings: What the arm must not hit; by default nothing is looked at.
        detours: Other paths from the same start to the same end, the best first; asked for where needed.
        timing: How straight and planar parts get their times; free movements always get them simply.

    Returns:
        The stages, each from rest to rest, in their order.

    Raises:
        KinematicsError: If the tool cannot reach a pose of the motion, or would hit something; it says what
            the first choice met.
        MotionError: If the motion breaks a limit of the joints, or leaves the path.
    """
    surroundings = surroundings or Surroundings()
    first: KinematicsError | None = None
    for choice in choices(robot, task, path, turns, detours):
        with kinematics.collisions(surroundings.obstacles) as check:
            try:
                lines = _lines(kinematics, check, choice, surroundings.part)
                stages = _stages(robot, choice.task, lines, timing)
                _require_free(check, stages[0].trajectory, stages[-1].trajectory)
            except KinematicsError as error:
                first = first or error
                continue
        _require_near(kinematics, choice.path, next(s for s in stages if s.name == "carry").trajectory)
        return stages
    raise first or MotionError("the task leaves no way to turn the tool; give it one.")


@dataclass(frozen=True, slots=True, eq=False)
class _Lines:
    """The joint paths of the straight and planar parts of the motion [rad]."""

    down: Array
    up: Array
    carry: Array
    lower: Array
    leave: Array


def _lines(kinematics: Kinematics, check: CollisionCheck, choice: Choice, part: Obstacle | None) -> _Lines:
    """Inverse kinematics and collision checks, part by part; what is impossible fails early."""
    task, path, turn, posture = choice
    start, goal = path[0], path[-1]

    def line(joints: Array, height: float, next_height: float, point: Array, yaw: float) -> Array:
        corners = np.array([[*point, height], [*point, next_height]])
        return follow(joints, [tool_above(p[:2], p[2], yaw) for p in densify(corners, _STEP)])

    def follow(joints: Array, poses: Sequence[Pose]) -> Array:
        found = kinematics.follow(poses, joints)
        hit = check.first_hit(thinned(found, _CHECK_EVERY))
        if hit is not None:
            raise CollisionError(hit)
        return found

    grasping = tool_above(start, task.grasp_height, turn.start)
    above = kinematics.inverse(tool_above(start, task.travel_height, turn.start), posture)
    down = line(above, task.travel_height, task.grasp_height, start, turn.start)
    if part is not None:
        check.hold(part, grasping.inverse() @ part.pose)
    up = line(down[-1], task.grasp_height, task.carry_height, start, turn.start)
    yaws = turn.along(path)
    poses = [tool_above(p, task.carry_height, yaw) for p, yaw in zip(path, yaws, strict=True)]
    carry = follow(up[-1], poses)
    lower = line(carry[-1], task.carry_height, task.release_height, goal, turn.end)
    check.release()
    leave = line(lower[-1], task.release_height, task.travel_height, goal, turn.end)
    return _Lines(down, up, carry, lower, leave)


def _stages(robot: RobotDescription, task: Task, lines: _Lines, timing: TimingMethod) -> tuple[Stage, ...]:
    limits = robot.joint_limits.scaled(
        velocity=_VELOCITY_SHARE, acceleration=_ACCELERATION_SHARE, jerk=_JERK_SHARE
    )
    parked = np.array(robot.parked)
    open_ = robot.gripper.maximum_opening
    released = open_ if task.release_opening is None else min(task.release_opening, open_)
    grip_time = robot.gripper.closing_time + _SETTLING_TIME
    held, closed = task.grips, 0.0 if task.grips else open_
    stages = [
        Stage("approach", move(parked, lines.down[0], limits), open_, False),
        Stage("descend", _timed(lines.down, limits, timing), open_, False),
        Stage("grasp", JointTrajectory.hold(lines.down[-1], grip_time), closed, held),
        Stage("lift", _timed(lines.up, limits, timing), closed, held),
        Stage("carry", _timed_samples(lines.carry, limits, timing), closed, held),
        Stage("lower", _timed(lines.lower, limits, timing), closed, held),
        Stage("release", JointTrajectory.hold(lines.lower[-1], grip_time), released, False),
        Stage("retreat", _timed(lines.leave, limits, timing), released, False),
        Stage("return", move(lines.leave[-1], parked, limits), released, False),
    ]
    gripping = {"grasp", "release"}
    return tuple(stage for stage in stages if task.grips or stage.name not in gripping)


def _timed(waypoints: Array, limits: JointLimits, timing: TimingMethod) -> JointTrajectory:
    return time_path(JointPath.through(waypoints), limits, method=timing)


def _timed_samples(waypoints: Array, limits: JointLimits, timing: TimingMethod) -> JointTrajectory:
    """The learnt path is an evenly sampled motion; where it turns back on itself, it slows down to do so."""
    path = JointPath.through(waypoints, parameters=np.arange(len(waypoints)))
    return time_path(path, limits, method=timing)


def _require_free(check: CollisionCheck, *movements: JointTrajectory) -> None:
    for movement in movements:
        hit = check.first_hit(movement.positions(np.linspace(0.0, movement.duration, _N_FREE)))
        if hit is not None:
            raise CollisionError(hit)


def _require_near(kinematics: Kinematics, path: Array, carry: JointTrajectory) -> None:
    """Refuse a motion whose tool leaves the path."""
    joints = carry.positions(np.linspace(0.0, carry.duration, _N_DEVIATIONS))
    deviation = farthest_from(path, kinematics.tool_positions(joints)[:, :2])
    if deviation > _MOST_DEVIATION:
        raise MotionError(
            f"the planned motion leaves the path by {1e3 * deviation:.2f} mm; "
            f"{1e3 * _MOST_DEVIATION:.0f} mm are allowed."
        )
