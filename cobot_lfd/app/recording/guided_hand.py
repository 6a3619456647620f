"""A person's hand as a pointer and buttons stand for it: it pulls the tool after the pointer."""

from collections import deque
from time import perf_counter

import numpy as np

from cobot_lfd.app.recording.hand import HandAction
from cobot_lfd.arrays import Array
from cobot_lfd.frame import wrap_angle
from cobot_lfd.rotation import rotation_matrix, rotation_vector
from cobot_lfd.tool import pointing_down
from robots import ArmState
from scenes import Task

_STIFFNESS = 1000.0  # [N/m] of the grasp
_DAMPING = 60.0  # [N s/m] relative to the wanted motion
_MAX_FORCE = 40.0  # [N] that a person exerts without effort
_TURN_STIFFNESS = 40.0  # [N m/rad]
_TURN_DAMPING = 2.0  # [N m s/rad]
_MAX_TORQUE = 8.0  # [N m]
# Pointer events come in jerks, some twenty in a second; a critically damped follower smooths them.
_FOLLOW = 16.0  # [1/s]; higher is more direct, lower is smoother
_MAX_SPEED = 0.5  # [m/s] of the follower
_LIFT_SPEED = 0.15  # [m/s] at which the buttons lift and lower
_TURN_SPEED = 1.0  # [rad/s] at which the tool turns
_EMPTY = 0.004  # [m]; closed fingers that are nearer to each other hold nothing
_IN_PLANE = 0.02  # [m] from the carry height that still counts as the plane


class GuidedHand:
    """A hand that follows a pointer; where nobody pulls, it lets the arm rest where it is.

    Its goal, buttons and guide may be set from another thread than the one that asks it to act: each setter
    replaces one value.

    Attributes:
        guide: Whether the planar guide keeps the tool's height and lets it point down.
        latencies: From the arrival of a pointer event to the force on the arm [s]; hands may share them.
    """

    def __init__(
        self, task: Task, maximum_opening: float, time_step: float, latencies: deque[float] | None = None
    ) -> None:
        self.guide = True
        self.latencies: deque[float] = deque(maxlen=10_000) if latencies is None else latencies
        self._task = task
        self._time_step = time_step
        self._open, self._wanted_opening = maximum_opening, maximum_opening
        self._pointer: Array | None = None
        self._arrived: float | None = None
        self._height: float | None = None
        self._turn = 0.0
        self._yaw: float | None = None
        self._goal: Array | None = None
        self._anchor, self._velocity = np.zeros(3), np.zeros(3)
        self._rotation = np.eye(3)

    @property
    def pulls(self) -> bool:
        """Whether the pointer pulls now."""
        return self._pointer is not None

    @property
    def pointer(self) -> Array | None:
        """Where the pointer wants the tool [m], shape (3,); None when it was let go."""
        return self._pointer

    @property
    def is_closed(self) -> bool:
        """Whether the gripper is told to be closed."""
        return self._wanted_opening == 0.0

    def reach(self, pointer: Array) -> None:
        """Pull the tool to a place in the world [m], shape (3,)."""
        self._pointer = pointer
        self._arrived = perf_counter()

    def let_go(self) -> None:
        """Pull no more; the arm rests where it is."""
        self._pointer = None

    def close_or_open(self) -> None:
        """Close the gripper, or open it."""
        released = self._task.release_opening
        let_go = self._open if released is None else released
        self._wanted_opening = let_go if self.is_closed else 0.0

    def switch_guide(self) -> None:
        """Take the planar guide off, or put it on."""
        self.guide = not self.guide

    def lift(self) -> None:
        """Lift the tool: with a part to the height of the carry, without one to where it is clear of all."""
        self._height = self._task.carry_height if self.is_closed else self._task.travel_height

    def lower(self) -> None:
        """Lower the tool to the part, or, with a part, to where it is let go."""
        self._height = self._task.release_height if self.is_closed else self._task.grasp_height

    def turn(self, angle: float) -> None:
        """Turn the tool about the vertical by an angle [rad]."""
        self._turn += angle

    def turn_to(self, yaw: float) -> None:
        """Turn the tool to a direction [rad]."""
        self._yaw = yaw

    def act(self, state: ArmState) -> HandAction | None:
        """Pull towards the pointer; this hand is never done by itself."""
        if self._goal is None:
            self._take_hold(state)
        self._set_goal(state)
        self._follow_goal()
        tool = state.world_from_tool
        force = _STIFFNESS * (self._anchor - tool.position)
        force += _DAMPING * (self._velocity - state.tool_velocity)
        turned = rotation_vector(self._rotation @ tool.rotation.T)
        torque = _TURN_STIFFNESS * turned - _TURN_DAMPING * state.tool_rate
        arrived, self._arrived = self._arrived, None
        if arrived is not None:
            self.latencies.append(perf_counter() - arrived)
        return HandAction(
            _at_most(force, _MAX_FORCE),
            _at_most(torque, _MAX_TORQUE),
            self._wanted_opening,
            self._carries(state),
        )

    def _take_hold(self, state: ArmState) -> None:
        """Begin where the tool is."""
        tool = state.world_from_tool
        self._goal = self._anchor = tool.position
        self._velocity = np.zeros(3)
        self._rotation = tool.rotation
        self._yaw = float(np.arctan2(tool.rotation[1, 0], tool.rotation[0, 0]))
        if self._height is None and self.guide:
            self._height = self._task.travel_height

    def _set_goal(self, state: ArmState) -> None:
        """Where the tool is to go: in the plane after the pointer, up and down by the buttons."""
        if self._goal is None:
            return
        goal = self._goal.copy()
        pointer = self._pointer
        if pointer is not None:
            goal = pointer.copy()
            goal[2] = self._goal[2] if self.guide else pointer[2]
            if not self.guide:
                self._height = None
        elif np.linalg.norm(self._goal[:2] - self._anchor[:2]) > _IN_PLANE:
            goal[:2] = state.world_from_tool.position[:2]  # let go on the way: rest here
        if self._height is not None:
            step = _LIFT_SPEED * self._time_step
            goal[2] += np.clip(self._height - goal[2], -step, step)
        self._goal = goal

    def _follow_goal(self) -> None:
        """Move the anchor that pulls the tool: critically damped, and no faster than a hand."""
        if self._goal is None:
            return
        pull = _FOLLOW**2 * (self._goal - self._anchor) - 2 * _FOLLOW * self._velocity
        self._velocity = _at_most(self._velocity + self._time_step * pull, _MAX_SPEED)
        self._anchor = self._anchor + self._time_step * self._velocity
        turn, self._turn = self._turn, 0.0
        self._yaw = wrap_angle((self._yaw or 0.0) + turn)
        if self.guide or turn:
            wanted, step = pointing_down(self._yaw), _TURN_SPEED * self._time_step
            way = rotation_vector(wanted @ self._rotation.T)
            arrives = np.linalg.norm(way) <= step
            self._rotation = wanted if arrives else rotation_matrix(_at_most(way, step)) @ self._rotation

    def _carries(self, state: ArmState) -> bool:
        """Whether the tool is in the plane of the carry, with the guide on and a part, if it can hold one."""
        height = state.world_from_tool.position[2]
        in_plane = self.guide and abs(height - self._task.carry_height) < _IN_PLANE
        if self._task.tool == "gripper":
            return bool(in_plane and self.is_closed and state.opening > _EMPTY)
        return bool(in_plane and (self.is_closed or not self._task.grips))


def _at_most(vector: Array, size: float) -> Array:
    """The vector, shortened to ``size`` where it is longer."""
    return np.asarray(vector * (size / max(size, float(np.linalg.norm(vector)))))
