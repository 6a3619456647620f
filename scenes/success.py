"""Whether the task is done: the physics decides, and says why not."""

from collections.abc import Callable, Collection

import numpy as np

from cobot_lfd.outcome import Outcome, Verdict
from scenes.shapes import Container
from scenes.task import Inside
from scenes.world import World


def check_success(
    world: World, robot_bodies: Collection[int] = (), step: Callable[[], None] | None = None
) -> Verdict:
    """Watch the scene for the time that its criterion asks for; all of it must hold all the time.

    Args:
        world: The world; time passes in it.
        robot_bodies: Body numbers of the robot, which must not touch the object.
        step: Lets one time step pass, where more than the world's own ``step`` is needed for that (a robot
            that must be held, for instance).
    """
    criterion = world.description.success
    end = world.time + criterion.duration
    while True:
        fault = _fault(world, criterion, robot_bodies)
        if fault is not None:
            return fault
        if world.time >= end:
            break
        (step or world.step)()
    return Verdict(
        Outcome.SUCCESS, f"the {criterion.object} lies in the {criterion.container}, at rest and released"
    )


def _fault(world: World, criterion: Inside, robot_bodies: Collection[int]) -> Verdict | None:
    """What is not as it should be at this moment."""
    touching = any(world.touching(criterion.object, body) for body in robot_bodies)
    if touching:
        return Verdict(Outcome.NOT_RELEASED, f"the robot touches the {criterion.object}")
    return _not_inside(world, criterion) or _not_at_rest(world, criterion)


def _not_inside(world: World, criterion: Inside) -> Verdict | None:
    container = world.description.objects[criterion.container]
    if not isinstance(container, Container):
        raise TypeError(f"'{criterion.container}' is no container.")
    world_from_container = world.true_poses()[criterion.container]
    x, y, z = world_from_container.inverse().apply(world.true_centre(criterion.object).position)
    excess = {
        "outside the walls": max(abs(x) - container.inner_size[0] / 2, abs(y) - container.inner_size[1] / 2),
        "above the rim": z - container.height,
        "below the floor": -z,
    }
    for where, distance in excess.items():
        if distance > 0.0:
            detail = (
                f"the {criterion.object} is {1000 * distance:.1f} mm {where} of the {criterion.container}"
            )
            return Verdict(Outcome.NOT_PLACED, detail)
    return None


def _not_at_rest(world: World, criterion: Inside) -> Verdict | None:
    velocity, turn_rate = world.true_velocity(criterion.object)
    speed, turn_rate_deg = np.linalg.norm(velocity), np.rad2deg(np.linalg.norm(turn_rate))
    if speed > criterion.max_speed:
        return Verdict(Outcome.NOT_AT_REST, f"the {criterion.object} moves at {1000 * speed:.1f} mm/s")
    if turn_rate_deg > criterion.max_turn_rate_deg:
        return Verdict(Outcome.NOT_AT_REST, f"the {criterion.object} turns at {turn_rate_deg:.1f} degrees/s")
    return None
