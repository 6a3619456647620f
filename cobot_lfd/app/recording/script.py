"""What a person's hand wants to do in one demonstration: the task's waypoints with human-like variation."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation, Slerp

from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from cobot_lfd.pose import Pose
from cobot_lfd.tool import ToolTurn, pointing_down, tool_above
from scenes import Task

HAND_STREAM = 1
"""Keeps the hand's randomness apart from that of the scene's layout, which has the same seed."""

_SPEED = 0.25  # [m/s] mean speed of a person's hand on the way to the part and away from it
_SHORTEST = 0.8  # [s] that even the shortest movement takes
_PAUSE = 0.3  # [s] for which the hand rests after each movement
_GRIP = 1.0  # [s] that the hand gives the gripper to close or open
_WANDER = 0.25  # [s] over which the hand's slow wander is correlated


@dataclass(frozen=True, slots=True, eq=False)
class Script:
    """Where the hand wants the tool, tick by tick.

    Attributes:
        positions: Wanted position of the tool [m], shape (M, 3).
        rotations: Wanted rotation of the tool, M rotations.
        openings: Wanted opening of the gripper [m], shape (M,).
        carrying: Whether the tick belongs to the planar carry, shape (M,).
    """

    positions: Array
    rotations: Rotation
    openings: Array
    carrying: NDArray[np.bool_]

    def __len__(self) -> int:
        """Number of ticks."""
        return len(self.positions)


def write_script(
    task: Task,
    frames: Mapping[str, Frame],
    *,
    start: Pose,
    turn: ToolTurn,
    maximum_opening: float,
    time_step: float,
    rng: np.random.Generator,
) -> Script:
    """A demonstration of the task as a person would do it: reach, grasp, lift, carry, release, retreat.

    Args:
        task: What is to be done, and how a hand varies.
        frames: Where the objects really are; the person sees the table.
        start: Pose of the tool at the start.
        turn: How the tool is turned from the grasp to the release.
        maximum_opening: Opening of the open gripper [m].
        time_step: Time between two ticks [s].
        rng: Source of the variation.
    """
    carry = _carry(task, frames, time_step, rng)
    writer = _Writer(time_step, start, maximum_opening)
    opening = maximum_opening if task.release_opening is None else task.release_opening
    writer.move_to(tool_above(carry[0], task.travel_height, turn.start))
    writer.move_to(tool_above(carry[0], task.grasp_height, turn.start))
    if task.grips:
        writer.grip(0.0)
        writer.move_to(tool_above(carry[0], task.carry_height, turn.start))
    writer.follow(carry, task.carry_height, turn.along(carry))
    if task.grips:
        writer.move_to(tool_above(carry[-1], task.release_height, turn.end))
        writer.grip(opening)
    writer.move_to(tool_above(carry[-1], task.travel_height, turn.end))
    return writer.script()


def minimum_jerk(u: Array) -> Array:
    """Share of a movement done at share ``u`` of its time, from rest to rest with the least jerk.

    Flash and Hogan, The coordination of arm movements (1985): 10 u³ - 15 u⁴ + 6 u⁵.
    """
    return u**3 * (10.0 - 15.0 * u + 6.0 * u**2)


class _Writer:
    """Collects ticks; each movement starts where the one before it ended."""

    def __init__(self, time_step: float, start: Pose, opening: float) -> None:
        self._time_step = time_step
        self._pose = start
        self._opening = opening
        self._parts: list[tuple[Array, Rotation, float, bool]] = []

    def move_to(self, goal: Pose) -> None:
        """A straight minimum-jerk movement, then a pause."""
        distance = float(np.linalg.norm(goal.position - self._pose.position))
        share = minimum_jerk(np.linspace(0.0, 1.0, self._n_ticks(max(distance / _SPEED, _SHORTEST))))
        turn = Slerp([0.0, 1.0], Rotation.from_matrix([self._pose.rotation, goal.rotation]))
        positions = self._pose.position + share[:, None] * (goal.position - self._pose.position)
        self._parts.append((positions, turn(share), self._opening, False))
        self._pose = goal
        self._rest(_PAUSE)

    def follow(self, path: Array, height: float, yaws: Array) -> None:
        """The planar carry along a path [m], shape (M, 2), with yaws [rad], shape (M,), then a pause."""
        positions = np.column_stack([path, np.full(len(path), height)])
        matrices = np.array([pointing_down(yaw) for yaw in yaws])
        self._parts.append((positions, Rotation.from_matrix(matrices), self._opening, True))
        self._pose = Pose(positions[-1], matrices[-1])
        self._rest(_PAUSE)

    def grip(self, opening: float) -> None:
        """Let the gripper go to an opening [m] while the hand rests."""
        self._opening = opening
        self._rest(_GRIP)

    def script(self) -> Script:
        """All ticks."""
        positions, rotations, openings, carrying = zip(*self._parts, strict=True)
        lengths = [len(part) for part in positions]
        return Script(
            np.concatenate(positions),
            Rotation.concatenate(rotations),
            np.repeat(openings, lengths),
            np.repeat(carrying, lengths),
        )

    def _rest(self, duration: float) -> None:
        n = self._n_ticks(duration)
        rotations = Rotation.from_matrix(np.repeat(self._pose.rotation[None], n, axis=0))
        self._parts.append((np.repeat(self._pose.position[None], n, axis=0), rotations, self._opening, False))

    def _n_ticks(self, duration: float) -> int:
        return max(2, round(duration / self._time_step))


def _carry(task: Task, frames: Mapping[str, Frame], time_step: float, rng: np.random.Generator) -> Array:
    """The hand's planar path over the table [m], one position per tick, shape (M, 2)."""
    corners = np.array(
        [frames[w.frame].apply(w.position) + rng.normal(0.0, w.noise, 2) for w in task.waypoints]
    )
    n = round(rng.uniform(*task.hand.carry_duration) / time_step)
    u = np.linspace(0.0, 1.0, n)
    warp = rng.uniform(-task.hand.timing_warp, task.hand.timing_warp)
    share = minimum_jerk(u + warp / (2 * np.pi) * np.sin(2 * np.pi * u))
    bows = [rng.uniform(*(w.bow or task.hand.bow)) for w in task.waypoints[1:]]
    path = _through(corners, np.array(bows))(share)
    return np.asarray(path + _tremor(n, task.hand.tremor, time_step, rng))


def _through(corners: Array, bows: Array) -> CubicSpline:
    """A curve through the corners [m], shape (M, 2), that bulges by ``bows`` [m] to the left between them."""
    steps = np.diff(corners, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    left = np.column_stack([-steps[:, 1], steps[:, 0]]) / lengths[:, None]
    points = np.empty((2 * len(corners) - 1, 2))
    points[::2] = corners
    points[1::2] = corners[:-1] + 0.5 * steps + bows[:, None] * left
    ends = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
    parameters = np.empty(len(points))
    parameters[::2] = ends
    parameters[1::2] = 0.5 * (ends[:-1] + ends[1:])
    return CubicSpline(parameters, points)


def _tremor(n: int, size: float, time_step: float, rng: np.random.Generator) -> Array:
    """The hand's slow wander [m], shape (n, 2), that vanishes at both ends of the movement."""
    wander = gaussian_filter1d(rng.normal(size=(n, 2)), _WANDER / time_step, axis=0, mode="wrap")
    fade = np.sin(np.pi * np.linspace(0.0, 1.0, n))[:, None]
    return np.asarray(size * fade * wander / wander.std())
