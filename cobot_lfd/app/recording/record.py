"""Recording: a hand leads the arm through the task, and everything that happens is kept."""

from collections.abc import Callable
from itertools import count, islice
from pathlib import Path

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.store import list_episodes, load_episode, require_writable, save_episode
from cobot_lfd.app.execute import Observer
from cobot_lfd.app.perceive import View, perceive
from cobot_lfd.app.recording.hand import Hand, ScriptedHand
from cobot_lfd.app.recording.recorder import Recorder
from cobot_lfd.app.recording.script import HAND_STREAM, write_script
from cobot_lfd.app.turns import turn_choices
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Outcome, Verdict
from robots import Arm, load_robot
from scenes import SceneDescription, World, check_success, load_scene


def record_episode(
    scene_name: str, robot_name: str, seed: int, *, camera: Path | None = None
) -> RecordedEpisode:
    """One demonstration by the scripted hand.

    Args:
        scene_name: Name of the scene.
        robot_name: Name of the robot.
        seed: Decides the scene's layout and how the hand varies.
        camera: File of the calibrated camera by which the picture is read; the scene's by default.

    Raises:
        DescriptionError: If there is no such scene or robot.
    """
    scene = load_scene(scene_name, calibration=camera)
    robot = load_robot(robot_name, scene.task.tool)
    with World(scene, seed) as world:
        arm = Arm(world.client, robot)
        view = perceive(world)
        recorder = Recorder(scene.physics.time_step)
        lead(world, arm, _scripted_hand(scene, world, arm, seed), recorder)
        verdict = judge(world, arm, view)
        return recorder.episode(
            scene_name, robot_name, seed, verdict, view.picture, view.detections, scene.camera.camera
        )


def lead(
    world: World, arm: Arm, hand: Hand, recorder: Recorder | None, *, observer: Observer | None = None
) -> None:
    """Let a hand lead the compliant arm until it is done.

    Args:
        world: The scene in the simulator; its time passes.
        arm: The arm.
        hand: Who leads.
        recorder: What happens is recorded here; None to record nothing.
        observer: Called after every step of the simulation.
    """
    opening = arm.opening()
    while True:
        state = arm.state()
        action = hand.act(state)
        if action is None:
            return
        if action.opening != opening:
            opening = action.opening
            arm.grip(opening)
        arm.lead(action.force, action.torque)
        if recorder is not None:
            recorder.add(world.time, state, action)
        world.step()
        if observer is not None:
            observer()


def _scripted_hand(scene: SceneDescription, world: World, arm: Arm, seed: int) -> ScriptedHand:
    """A hand for this scene; it stands for a person, who sees where the objects are."""
    frames = world.true_frames()
    script = write_script(
        scene.task,
        frames,
        start=arm.state().world_from_tool,
        turn=turn_choices(scene.task, frames)[0],
        maximum_opening=arm.description.gripper.maximum_opening,
        time_step=scene.physics.time_step,
        rng=np.random.default_rng([seed, HAND_STREAM]),
    )
    return ScriptedHand(script, scene.physics.time_step)


def judge(world: World, arm: Arm, view: View) -> Verdict:
    """Whether the demonstration can be learnt from: the task is done, and the camera saw the objects."""
    if view.missing:
        return Verdict(Outcome.OBJECT_NOT_SEEN, f"{view.missing[0].name}: {view.missing[0].reason}")
    arm.hold()
    return check_success(world, (arm.body.id,))


def record_session(
    scene_name: str,
    robot_name: str,
    folder: Path,
    *,
    n_episodes: int,
    first_seed: int,
    report: Callable[[str], None] | None = None,
    camera: Path | None = None,
) -> list[RecordedEpisode]:
    """Record demonstrations into a folder; each is safe on disk before the next begins.

    Args:
        scene_name: Name of the scene.
        robot_name: Name of the robot.
        folder: Folder of episodes; what is in it already stays.
        n_episodes: How many to record.
        first_seed: Of the first episode; the next ones count upwards, leaving out seeds that the folder has.
        report: Called with a sentence after each episode.
        camera: File of the calibrated camera by which pictures are read; the scene's by default.

    Raises:
        DescriptionError: If there is no such scene or robot.
        DataError: If the folder cannot be written, or holds demonstrations of another scene or robot.
    """
    load_robot(robot_name, load_scene(scene_name).task.tool)
    taken = seeds_in(folder, scene_name, robot_name)
    require_writable(folder)
    fresh_seeds = (seed for seed in count(first_seed) if seed not in taken)
    episodes = []
    for seed in islice(fresh_seeds, n_episodes):
        episode = record_episode(scene_name, robot_name, seed, camera=camera)
        file = save_episode(folder, episode)
        if report is not None:
            report(f"{file}: {episode.verdict.sentence}")
        episodes.append(episode)
    return episodes


def seeds_in(folder: Path, scene_name: str, robot_name: str) -> set[int]:
    """Seeds of the episodes that a folder holds already.

    Raises:
        DataError: If it holds demonstrations of another scene or robot, or one cannot be read.
    """
    episodes = [load_episode(file) for file in list_episodes(folder)] if folder.is_dir() else []
    for episode in episodes:
        if (episode.scene, episode.robot) != (scene_name, robot_name):
            raise DataError(
                f"{folder} holds demonstrations of {episode.scene} with {episode.robot}; "
                f"record {scene_name} with {robot_name} into another folder."
            )
    return {episode.seed for episode in episodes}
