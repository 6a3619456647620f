"""A recorded demonstration once more in the physics: from its joint states, or by its wrenches."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.execute import Observer
from cobot_lfd.arrays import Array
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Verdict
from robots import Arm, load_robot
from scenes import World, check_success, load_scene

By = Literal["joints", "wrenches"]
"""What is applied again: the joints are driven through their recorded states, or the hand pulls as it did."""

_MOVES = 0.001  # [m] by which the fingers must have moved for it to count as an order to the gripper


@dataclass(frozen=True, slots=True)
class Replay:
    """How a replay went.

    Attributes:
        verdict: How it ended.
        worst: Largest distance between the tool then and now [m].
        mean: Mean of that distance [m].
        final: That distance at the end [m].
    """

    verdict: Verdict
    worst: float
    mean: float
    final: float


def replay(episode: RecordedEpisode, by: By, *, observer: Observer | None = None) -> Replay:
    """Do what was recorded again, in the scene that the episode's seed lays out.

    Args:
        episode: What was recorded.
        by: What is applied again. Joint states are held by the motors and so repeat the motion. Wrenches are
            applied to the compliant arm without looking where it goes, so that every small error adds up.
        observer: Called after every step of the simulation.

    Raises:
        DescriptionError: If the episode's scene or robot is unknown.
        DataError: If the episode has no joint states, as imported ones do not.
    """
    if episode.joint_positions.shape[1] == 0 or len(episode.times) < 2:
        raise DataError(f"the episode of seed {episode.seed} has no joint states; it cannot be replayed.")
    scene = load_scene(episode.scene)
    robot = load_robot(episode.robot, scene.task.tool)
    with World(scene, episode.seed) as world:
        return replay_in(world, Arm(world.client, robot), episode, by, observer=observer)


def replay_in(
    world: World, arm: Arm, episode: RecordedEpisode, by: By, *, observer: Observer | None = None
) -> Replay:
    """The same in a world that is laid out already, as the episode found it."""
    arm.body.place(episode.joint_positions[0])
    orders = _orders(episode, arm, world.description.task.release_opening)
    order, distances = np.nan, []
    every = max(1, round(float(np.median(np.diff(episode.times))) / world.description.physics.time_step))
    for i in range(len(episode.times)):
        distances.append(float(np.linalg.norm(arm.tool_position() - episode.tool_positions[i])))
        if orders[i] != order:
            order = orders[i]
            arm.grip(order)
        for tick in range(every):
            _apply(arm, episode, by, i, tick / every)
            _step(world, observer)
    arm.hold()
    verdict = check_success(world, (arm.body.id,), step=lambda: _step(world, observer))
    return Replay(verdict, max(distances), float(np.mean(distances)), distances[-1])


def gripper_orders(openings: Array, maximum: float) -> Array:
    """What the gripper was told, from what its encoder saw: fingers that move close or open all the way.

    Args:
        openings: Measured distance between the fingers [m], shape (M,).
        maximum: Opening of the open gripper [m].

    Returns:
        The ordered opening [m], 0 or ``maximum``, shape (M,).
    """
    orders, order = np.empty(len(openings)), maximum
    farthest = float(openings[0]) if len(openings) else 0.0
    if farthest < maximum - 2 * _MOVES:
        order = 0.0
    for i, opening in enumerate(openings):
        is_open = order > 0.0
        farthest = max(farthest, opening) if is_open else min(farthest, opening)
        if (farthest - opening if is_open else opening - farthest) > _MOVES:
            order, farthest = (0.0 if is_open else maximum), float(opening)
        orders[i] = order
    return orders


def _orders(episode: RecordedEpisode, arm: Arm, release_opening: float | None) -> Array:
    """The orders to this gripper, which lets go with an opening of its own where the task says so."""
    orders = gripper_orders(episode.gripper_openings, arm.description.gripper.maximum_opening)
    was_closed = np.maximum.accumulate(orders == 0.0)
    return (
        orders if release_opening is None else np.where(was_closed & (orders > 0.0), release_opening, orders)
    )


def _apply(arm: Arm, episode: RecordedEpisode, by: By, i: int, share: float) -> None:
    """What is applied at a share of the way from sample ``i`` to the next."""

    def between(series: Array) -> Array:
        following = series[min(i + 1, len(series) - 1)]
        return np.asarray((1.0 - share) * series[i] + share * following)

    if by == "joints":
        arm.follow(between(episode.joint_positions), between(episode.joint_velocities))
    else:
        arm.lead(between(episode.hand_forces), between(episode.hand_torques))


def _step(world: World, observer: Observer | None) -> None:
    world.step()
    if observer is not None:
        observer()
