"""A hand that leads the arm: what it does to the tool, tick by tick."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.spatial.transform import Rotation

from cobot_lfd.app.recording.script import Script
from cobot_lfd.arrays import Array
from robots import ArmState

_STIFFNESS = 1000.0  # [N/m] of the grasp of a hand that knows where it wants to go
_DAMPING = 60.0  # [N s/m] relative to the wanted motion
_MAX_FORCE = 60.0  # [N] that a person exerts without effort
_TURN_STIFFNESS = 40.0  # [N m/rad]
_TURN_DAMPING = 2.0  # [N m s/rad]
_MAX_TORQUE = 8.0  # [N m]


@dataclass(frozen=True, slots=True, eq=False)
class HandAction:
    """What a hand does in one tick.

    Attributes:
        force: On the tool, in the world [N], shape (3,).
        torque: On the tool, in the world [N m], shape (3,).
        opening: Wanted opening of the gripper [m].
        carrying: Whether the hand carries the part through the plane.
    """

    force: Array
    torque: Array
    opening: float
    carrying: bool


class Hand(Protocol):
    """Whatever leads the arm: a script, a mouse, a person in a browser."""

    def act(self, state: ArmState) -> HandAction | None:
        """What the hand does in the next tick, given what the arm does now; None when it is done."""
        ...


class ScriptedHand:
    """A hand that pulls the tool after a script, as if by a spring and a damper.

    It never moves the arm itself: what is recorded is how the arm gives way.
    """

    def __init__(self, script: Script, time_step: float) -> None:
        self._script = script
        self._velocities = np.gradient(script.positions, time_step, axis=0)
        self._tick = 0

    def act(self, state: ArmState) -> HandAction | None:
        """Pull towards the place that the script has for this tick."""
        if self._tick >= len(self._script):
            return None
        i, self._tick = self._tick, self._tick + 1
        tool = state.world_from_tool
        away = self._script.positions[i] - tool.position
        turned = (self._script.rotations[i] * Rotation.from_matrix(tool.rotation.T)).as_rotvec()
        force = _STIFFNESS * away + _DAMPING * (self._velocities[i] - state.tool_velocity)
        torque = _TURN_STIFFNESS * turned - _TURN_DAMPING * state.tool_rate
        return HandAction(
            _at_most(force, _MAX_FORCE),
            _at_most(torque, _MAX_TORQUE),
            float(self._script.openings[i]),
            bool(self._script.carrying[i]),
        )


def _at_most(vector: Array, size: float) -> Array:
    """The vector, shortened to ``size`` where it is longer."""
    return np.asarray(vector * (size / max(size, float(np.linalg.norm(vector)))))
