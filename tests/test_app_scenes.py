"""Every scene, performed end to end: the seven tasks are shared out among the arms."""

import numpy as np
import pytest

from cobot_lfd.app.episode import Bench, run_episode
from cobot_lfd.app.perceive import perceive
from cobot_lfd.app.recording.script import HAND_STREAM, write_script
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.outcome import Outcome
from cobot_lfd.pose import Pose
from cobot_lfd.tool import ToolTurn
from robots import Kinematics, has_urdf, load_robot
from scenes import SceneDescription, World, draw_placements, load_scene, scene_names, variant_names

pytestmark = pytest.mark.simulator

SEED = 900
ARMS = {
    "ball_in_hole": "xarm6",
    "brushing": "panda",
    "handover": "iiwa",
    "inspection": "panda",
    "peg_in_slot": "ur5",
    "pick_and_place@clutter": "xarm6",
    "sorting": "iiwa",
}


def intended(scene: SceneDescription, seed: int) -> Demonstration:
    """What the scripted hand intends; the physics of recording has its own tests."""
    frames = draw_placements(scene, np.random.default_rng(seed))
    script = write_script(
        scene.task,
        frames,
        start=Pose.identity(),
        turn=ToolTurn.none(0.0),
        maximum_opening=0.01,
        time_step=0.01,
        rng=np.random.default_rng([seed, HAND_STREAM]),
    )
    path = script.positions[script.carrying, :2]
    return Demonstration(
        path, {name: frames[name] for name in scene.frame_names}, np.arange(len(path)) * 0.01
    )


def test_no_scene_is_left_out() -> None:
    assert {name.split("@")[0] for name in ARMS} == set(scene_names())


@pytest.mark.parametrize(("scene_name", "robot_name"), ARMS.items())
def test_a_scene_is_performed(scene_name: str, robot_name: str) -> None:
    scene = load_scene(scene_name)
    robot = load_robot(robot_name, scene.task.tool)
    if not has_urdf(robot.urdf, robot.package):
        pytest.skip(f"the URDF of {robot_name} is not installed")
    model = TaskParameterisedGMM.fit([intended(scene, seed) for seed in range(6)])
    with Kinematics(robot) as kinematics:
        run = run_episode(Bench(scene_name, robot_name, scene, robot, kinematics, model), SEED)
    assert run.result.verdict.outcome is Outcome.SUCCESS, run.result.verdict.sentence
    assert run.result.metrics["tracking_error"] < 0.002  # [m]


@pytest.mark.parametrize("scene_name", [f"{s}@{v}" for s in scene_names() for v in variant_names()])
def test_all_that_a_task_needs_is_seen_in_its_variants(scene_name: str) -> None:
    with World(load_scene(scene_name), SEED) as world:
        view = perceive(world)
        truth = world.true_frames()
    assert not [seen.reason for seen in view.missing]
    for seen in view.detections:
        assert np.linalg.norm(seen.frame.position - truth[seen.name].position) < 0.001
