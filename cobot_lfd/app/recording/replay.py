"""A recorded demonstration once more in the physics: from its joint states, or by its wrenches."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.execute import Observer
from cobot_lfd.app.recording.hand import HandAction
from cobot_lfd.app.recording.record import lead
from cobot_lfd.app.recording.recorder import steps_per_sample
from cobot_lfd.arrays import Array
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Verdict
from robots import Arm, ArmState, load_robot
from scenes import World, check_success, load_scene

By = Literal["joints", "wrenches"]
"""What is applied again: the joints are driven through their recorded states, or the hand pulls as it did."""


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


class RecordedHand:
    """A hand that pulls as it did when it was recorded, whatever the arm does.

    Attributes:
        distances: Between the tool then and now, at every sample so far [m].
    """

    def __init__(self, episode: RecordedEpisode, time_step: float) -> None:
        self.distances: list[float] = []
        self._pulls, self._then = episode.pulls, episode.tool_positions
        self._every = steps_per_sample(time_step)
        self._carrying = np.repeat(episode.carrying, self._every)
        self._step = 0

    def act(self, state: ArmState) -> HandAction | None:
        """What the hand did in this step; None after the last one."""
        i, pulls = self._step, self._pulls
        if i >= len(pulls):
            return None
        self._step += 1
        if i % self._every == 0:
            away = state.world_from_tool.position - self._then[i // self._every]
            self.distances.append(float(np.linalg.norm(away)))
        return HandAction(
            pulls.forces[i], pulls.torques[i], float(pulls.openings[i]), bool(self._carrying[i])
        )


def replay(episode: RecordedEpisode, by: By, *, observer: Observer | None = None) -> Replay:
    """Do what was recorded again, in the scene that the episode's seed lays out.

    Args:
        episode: What was recorded.
        by: What is applied again. Joint states are held by the motors and so repeat the motion. Wrenches are
            applied to the compliant arm without looking where it goes: it goes the same way exactly, if the
            physics is the same to the last bit.
        observer: Called after every step of the simulation.

    Raises:
        DescriptionError: If the episode's scene or robot is unknown.
        DataError: If the episode lacks what is to be applied, as imported ones do.
    """
    _require(episode, by)
    scene = load_scene(episode.scene)
    robot = load_robot(episode.robot, scene.task.tool)
    with World(scene, episode.seed) as world:
        return replay_in(world, Arm(world.client, robot), episode, by, observer=observer)


def replay_in(
    world: World, arm: Arm, episode: RecordedEpisode, by: By, *, observer: Observer | None = None
) -> Replay:
    """The same in a world that is laid out already, as the episode found it.

    Raises:
        DataError: If the episode lacks what is to be applied.
    """
    _require(episode, by)
    arm.body.place(episode.joint_positions[0])
    if by == "joints":
        distances = _follow_joints(world, arm, episode, observer)
    else:
        hand = RecordedHand(episode, world.description.physics.time_step)
        lead(world, arm, hand, None, observer=observer)
        distances = hand.distances
    arm.hold()
    verdict = check_success(world, (arm.body.id,), step=lambda: _step(world, observer))
    return Replay(verdict, max(distances), float(np.mean(distances)), distances[-1])


def _require(episode: RecordedEpisode, by: By) -> None:
    """Complain where the episode lacks what is to be applied."""
    if episode.joint_positions.shape[1] == 0 or len(episode.times) < 2:
        raise DataError(f"the episode of seed {episode.seed} has no joint states; it cannot be replayed.")
    if by == "wrenches" and not len(episode.pulls):
        raise DataError(
            f"the episode of seed {episode.seed} was recorded before the hand's pull in every step was kept; "
            "replay it by its joints (--by joints), or record it again."
        )


def _follow_joints(
    world: World, arm: Arm, episode: RecordedEpisode, observer: Observer | None
) -> list[float]:
    """Drive the joints through their recorded states; returns how far the tool was off at each sample [m]."""
    time_step = world.description.physics.time_step
    every = max(1, round(float(np.median(np.diff(episode.times))) / time_step))
    order, distances = np.nan, []
    for i in range(len(episode.times)):
        distances.append(float(np.linalg.norm(arm.tool_position() - episode.tool_positions[i])))
        if episode.gripper_orders[i] != order:
            order = float(episode.gripper_orders[i])
            arm.grip(order)
        for tick in range(every):
            share = tick / every
            arm.follow(
                _between(episode.joint_positions, i, share), _between(episode.joint_velocities, i, share)
            )
            _step(world, observer)
    return distances


def _between(series: Array, i: int, share: float) -> Array:
    """The series at a share of the way from sample ``i`` to the next."""
    following = series[min(i + 1, len(series) - 1)]
    return np.asarray((1.0 - share) * series[i] + share * following)


def _step(world: World, observer: Observer | None) -> None:
    world.step()
    if observer is not None:
        observer()
