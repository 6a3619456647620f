"""Whether the task is done: the physics decides, and says why not."""

from collections.abc import Callable, Collection

import numpy as np

from cobot_lfd.arrays import Array
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
    return (
        _not_inside(world, criterion)
        or _tipped_over(world, criterion)
        or _not_at_rest(world, criterion)
        or _mishandled(world, criterion)
    )


def _not_inside(world: World, criterion: Inside) -> Verdict | None:
    world_from_container = world.true_pose(criterion.container)
    centre = world_from_container.inverse().apply(world.true_centre(criterion.object).position)
    low, high = _region(world, criterion)
    below, above = low - centre, centre - high
    excess = {
        "outside the walls": max(below[0], below[1], above[0], above[1]),
        "above the rim": above[2],
        "below the floor": below[2],
    }
    for where, distance in excess.items():
        if distance > 0.0:
            detail = (
                f"the {criterion.object} is {1000 * distance:.1f} mm {where} of the {criterion.container}"
            )
            return Verdict(Outcome.NOT_PLACED, detail)
    return None


def _region(world: World, criterion: Inside) -> tuple[Array, Array]:
    """Two opposite corners, in the container's frame, of where the object's centre must lie [m]."""
    container = world.description.objects[criterion.container]
    if criterion.region is not None:
        return np.array(criterion.region.low), np.array(criterion.region.high)
    if not isinstance(container, Container):
        raise TypeError(f"'{criterion.container}' is no container.")
    half_length, half_width = container.inner_size[0] / 2, container.inner_size[1] / 2
    return np.array([-half_length, -half_width, 0.0]), np.array([half_length, half_width, container.height])


def _tipped_over(world: World, criterion: Inside) -> Verdict | None:
    """Whether what stood upright at the start does so no more."""
    upright = float(world.true_centre(criterion.object).rotation[2, 2])
    tilt_deg = float(np.rad2deg(np.arccos(np.clip(upright, -1.0, 1.0))))
    if criterion.max_tilt_deg is None or tilt_deg <= criterion.max_tilt_deg:
        return None
    return Verdict(Outcome.NOT_PLACED, f"the {criterion.object} is tilted by {tilt_deg:.0f} degrees")


def _mishandled(world: World, criterion: Inside) -> Verdict | None:
    """Whether something happened on the way that must not happen."""
    force = world.watch.largest_force
    if criterion.max_force is not None and force > criterion.max_force:
        detail = f"the {criterion.container} felt {force:.0f} N; {criterion.max_force:.0f} N are allowed"
        return Verdict(Outcome.HARD_CONTACT, detail)
    if not world.watch.passed and criterion.through is not None:
        detail = f"the {criterion.object} did not pass the {criterion.through.frame}"
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
