"""Recording with the mouse in the simulator's own window."""

import os
from collections.abc import Callable
from dataclasses import replace
from itertools import count, islice
from pathlib import Path

import numpy as np

from cobot_lfd.app.carry import trimmed_carry
from cobot_lfd.app.episodes import RecordedEpisode
from cobot_lfd.app.guided_hand import GuidedHand
from cobot_lfd.app.perceive import perceive
from cobot_lfd.app.record import judge, lead, seeds_in
from cobot_lfd.app.recorder import Recorder
from cobot_lfd.app.store import save_episode
from cobot_lfd.app.studio.clock import Clock
from cobot_lfd.app.turns import turn_choices
from cobot_lfd.app.window_hand import WindowHand, prepare_window
from cobot_lfd.errors import CobotError
from robots import Arm, RobotDescription, load_robot
from scenes import SceneDescription, World, load_scene

HELP = """in the window: drag the arm with the left mouse button (Ctrl and drag: look from elsewhere), then
  G gripper   S lower   W lift   Q, E turn   A turn to the part   P planar guide on, off   Return: done"""


def record_in_window(
    scene_name: str,
    robot_name: str,
    folder: Path,
    *,
    n_episodes: int,
    first_seed: int,
    report: Callable[[str], None],
) -> list[RecordedEpisode]:
    """Record demonstrations that a person leads with the mouse; each is on disk before the next begins.

    Args:
        scene_name: Name of the scene.
        robot_name: Name of the robot.
        folder: Folder of episodes; what is in it already stays.
        n_episodes: How many to record.
        first_seed: Of the first episode; the next ones count upwards, leaving out seeds that the folder has.
        report: Called with a sentence after each episode.

    Raises:
        CobotError: If there is no display for a window.
        DescriptionError: If there is no such scene or robot.
        DataError: If the folder cannot be written, or holds demonstrations of another scene or robot.
    """
    if not os.environ.get("DISPLAY"):
        raise CobotError("--hand mouse needs a display (DISPLAY is not set); use --hand browser instead.")
    taken = seeds_in(folder, scene_name, robot_name)
    scene = load_scene(scene_name)
    robot = load_robot(robot_name, scene.task.tool)
    episodes = []
    for seed in islice((seed for seed in count(first_seed) if seed not in taken), n_episodes):
        recorded = _record(scene, robot, scene_name, robot_name, seed)
        episode = replace(recorded, carrying=trimmed_carry(recorded.carrying, recorded.tool_positions))
        file = save_episode(folder, episode)
        report(f"{file}: {episode.verdict.sentence}")
        episodes.append(episode)
    return episodes


def _record(
    scene: SceneDescription, robot: RobotDescription, scene_name: str, robot_name: str, seed: int
) -> RecordedEpisode:
    """One demonstration."""
    with World(scene, seed, window=True) as world:
        arm = Arm(world.client, robot)
        view = perceive(world)
        arm.body.place(np.array(robot.home))
        ready = arm.state().world_from_tool.position
        prepare_window(world.client, np.array([*ready[:2], scene.task.travel_height]))
        guided = GuidedHand(scene.task, robot.gripper.maximum_opening, scene.physics.time_step)

        def align() -> None:
            turn = turn_choices(scene.task, view.frames)[0]
            guided.turn_to(turn.end if guided.is_closed else turn.start)

        recorder, clock = Recorder(), Clock(scene.physics.time_step)
        hand = WindowHand(world.client, arm, guided, align)
        print(f"seed {seed}: lead the arm", flush=True)
        lead(world, arm, hand, recorder, observer=clock.step)
        verdict = judge(world, arm, view)
        return recorder.episode(scene_name, robot_name, seed, verdict, view.picture, view.detections)
