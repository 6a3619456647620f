"""The planned motion in the physics: the arm follows it, its gripper tells whether it holds the part."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from cobot_lfd.app.compliance import StiffnessField
from cobot_lfd.app.plan import Stage
from cobot_lfd.arrays import Array
from cobot_lfd.outcome import Outcome, Verdict
from robots import Arm
from scenes import World

_GRIP_CHECK_EVERY = 10  # steps between two looks at the gripper's sensor
_FOLLOWED = 0.02  # [rad] by which a joint may miss the end of a stage

Observer = Callable[[], None]
"""Called after every step of the simulation: a video camera, for instance."""


@dataclass(frozen=True, slots=True, eq=False)
class Execution:
    """How the arm did.

    Attributes:
        failure: Why the motion was broken off; None if it was carried out to its end.
        carried: Where the tool was in the plane while it carried the part [m], shape (M, 2).
    """

    failure: Verdict | None
    carried: Array


def execute(
    world: World,
    arm: Arm,
    stages: Sequence[Stage],
    *,
    observer: Observer | None = None,
    stiffness: StiffnessField | None = None,
) -> Execution:
    """Carry out a motion; broken off where the gripper loses the part or the arm does not follow.

    Args:
        world: The scene in the simulator; its time passes.
        arm: The arm, at the start of the first stage.
        stages: What to do.
        observer: Called after every step of the simulation.
        stiffness: How stiff the tool is during the carry, by place; by default as stiff as the arm can be.
    """
    carried: list[Array] = []
    held = False
    for stage in stages:
        arm.grip(stage.opening)
        trace = carried if stage.name == "carry" else None
        soft = stiffness if stage.name == "carry" else None
        must_hold = held and stage.holding
        if not _follow(world, arm, stage, must_hold=must_hold, trace=trace, observer=observer, soft=soft):
            return Execution(Verdict(Outcome.GRASP_LOST, f"during '{stage.name}'"), _stack(carried))
        if stage.holding and not arm.holds_something():
            return Execution(Verdict(Outcome.GRASP_FAILED, "the fingers closed on nothing"), _stack(carried))
        held = stage.holding
        miss = float(np.abs(arm.state().positions - stage.trajectory.goal).max())
        if (
            miss > _FOLLOWED and soft is None
        ):  # a soft arm may have been pushed; the next stage brings it back
            detail = f"a joint is {miss:.3f} rad from the end of '{stage.name}'"
            return Execution(Verdict(Outcome.TRACKING_LOST, detail), _stack(carried))
    return Execution(None, _stack(carried))


def _follow(
    world: World,
    arm: Arm,
    stage: Stage,
    *,
    must_hold: bool,
    trace: list[Array] | None,
    observer: Observer | None,
    soft: StiffnessField | None,
) -> bool:
    """Follow one stage; False as soon as the gripper is empty though it must hold something."""
    samples = stage.trajectory.every(world.description.physics.time_step)
    positions, velocities = samples.positions.tolist(), samples.velocities.tolist()
    for i, (position, velocity) in enumerate(zip(positions, velocities, strict=True)):
        if soft is None:
            arm.follow(position, velocity)
        else:
            wanted = samples.positions[i], samples.velocities[i], samples.accelerations[i]
            arm.comply(*wanted, soft(arm.tool_position()[:2]))
        world.step()
        if trace is not None:
            trace.append(arm.tool_position()[:2])
        if observer is not None:
            observer()
        if must_hold and i % _GRIP_CHECK_EVERY == 0 and not arm.holds_something():
            return False
    return True


def _stack(points: list[Array]) -> Array:
    return np.array(points).reshape(-1, 2)
