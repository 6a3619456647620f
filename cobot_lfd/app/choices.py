"""The ways in which a motion may be carried out, in the order in which they are tried."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.tool import ToolTurn
from robots import RobotDescription
from scenes import Task

_MOST_ATTEMPTS = 8  # with the path as it is
_FEW_TURNS = 2  # that are tried with each other path


class Choice(NamedTuple):
    """One way to carry out the motion: what is done, along which path, and the posture to start from."""

    task: Task
    path: Array
    turn: ToolTurn
    posture: Array


def choices(
    robot: RobotDescription, task: Task, path: Array, turns: Sequence[ToolTurn], detours: Iterable[Array]
) -> Iterator[Choice]:
    """The choices in the order in which they are tried."""
    home, *branches = (np.array(posture) for posture in (robot.home, *robot.branches))
    direct = [Choice(task, path, turn, home) for turn in turns]
    direct += [Choice(task, path, turn, posture) for turn in turns[:1] for posture in branches]
    yield from direct[:_MOST_ATTEMPTS]
    yield from (Choice(task, detour, turn, home) for detour in detours for turn in turns[:_FEW_TURNS])
    lifted = _lifted(task)
    if lifted is not None:
        yield from (Choice(lifted, path, turn, home) for turn in turns[:_FEW_TURNS])


def _lifted(task: Task) -> Task | None:
    """The task with its carry lifted; None where that would be the same, or something else is pushed."""
    if not task.grips or task.travel_height <= task.carry_height:
        return None
    return task.model_copy(update={"carry_height": task.travel_height})
