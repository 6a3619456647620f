"""How the tool may be turned in a scene: the choices that its task leaves, the most comfortable first."""

from collections.abc import Mapping

import numpy as np

from cobot_lfd.frame import Frame
from cobot_lfd.tool import ToolTurn, equal_yaws
from scenes import Task, YawRule

_FREE = np.deg2rad([0.0, 30.0, -30.0, 60.0, -60.0, 90.0, -90.0])  # from the most comfortable yaw


def turn_choices(task: Task, frames: Mapping[str, Frame], preferred: float = 0.0) -> tuple[ToolTurn, ...]:
    """All turns that the task allows.

    Args:
        task: Says how the tool must be turned at the start and at the end, relative to which frames.
        frames: The frames.
        preferred: Yaw at which the arm is most comfortable [rad].
    """
    starts, ends = (_allowed(rule, frames, preferred) for rule in (task.start_yaw, task.end_yaw))
    if starts is None and ends is None:
        pairs = [(preferred + float(yaw), preferred + float(yaw)) for yaw in _FREE]
    elif starts is None or ends is None:
        pairs = [(yaw, yaw) for yaw in starts or ends or ()]
    else:
        pairs = [(start, _near(end, start)) for start in starts for end in ends]
    pairs.sort(key=lambda pair: abs(pair[0] - preferred) + abs(pair[1] - preferred))
    return tuple(ToolTurn(start, end, *task.turning) for start, end in pairs)


def _allowed(rule: YawRule | None, frames: Mapping[str, Frame], preferred: float) -> list[float] | None:
    """The yaws that a rule allows [rad]; None where anything is allowed."""
    if rule is None:
        return None
    return equal_yaws(frames[rule.frame].angle + np.deg2rad(rule.angle_deg), rule.turns, preferred)


def _near(angle: float, other: float) -> float:
    """The same direction, less than half a turn from another [rad]."""
    return float(other + np.mod(angle - other + np.pi, 2 * np.pi) - np.pi)
