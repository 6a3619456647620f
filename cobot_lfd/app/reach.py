"""How much of a scene a robot reaches: the poses that its task needs, in layouts drawn at random."""

from collections.abc import Iterator, Mapping

import numpy as np

from cobot_lfd.app.turns import turn_choices
from cobot_lfd.frame import Frame
from cobot_lfd.pose import Pose
from cobot_lfd.tool import ToolTurn, tool_above
from robots import Kinematics, KinematicsError, RobotDescription
from scenes import SceneDescription, Task, draw_placements


def reached_share(
    kinematics: Kinematics, robot: RobotDescription, scene: SceneDescription, *, n_layouts: int, seed: int = 0
) -> float:
    """Share of layouts, in 0..1, in which the tool reaches where the task begins, passes and ends.

    Args:
        kinematics: Of the robot, with the tool that the scene asks for.
        robot: The robot.
        scene: The scene.
        n_layouts: How many layouts are tried.
        seed: Of the layouts.
    """
    rng = np.random.default_rng(seed)
    layouts = [draw_placements(scene, rng) for _ in range(n_layouts)]
    return sum(_reaches(kinematics, robot, scene.task, frames) for frames in layouts) / n_layouts


def _reaches(
    kinematics: Kinematics, robot: RobotDescription, task: Task, frames: Mapping[str, Frame]
) -> bool:
    """Whether one of the turns that the task allows brings the tool everywhere."""
    return any(_reaches_all(kinematics, robot, _poses(task, frames, t)) for t in turn_choices(task, frames))


def _poses(task: Task, frames: Mapping[str, Frame], turn: ToolTurn) -> Iterator[Pose]:
    start, *middle, end = [frames[w.frame].apply(w.position) for w in task.waypoints]
    yield from (tool_above(start, height, turn.start) for height in (task.travel_height, task.grasp_height))
    yield from (tool_above(point, task.carry_height, turn.end) for point in middle)
    yield from (tool_above(end, height, turn.end) for height in (task.travel_height, task.release_height))


def _reaches_all(kinematics: Kinematics, robot: RobotDescription, poses: Iterator[Pose]) -> bool:
    try:
        for pose in poses:
            kinematics.inverse(pose, np.array(robot.home))
    except KinematicsError:
        return False
    return True
