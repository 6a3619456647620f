"""A demonstration as the scripted hand wants it: picture and path, no physics; for tests and benchmarks."""

from collections.abc import Mapping

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.recording.script import HAND_STREAM, write_script
from cobot_lfd.app.turns import turn_choices
from cobot_lfd.frame import Frame
from cobot_lfd.outcome import Outcome, Verdict
from robots import Arm, load_robot
from scenes import SceneDescription, World

_SAMPLE_PERIOD = 0.01  # [s]


def sketch_episode(
    scene_name: str, scene: SceneDescription, robot_name: str, seed: int
) -> tuple[RecordedEpisode, Mapping[str, Frame]]:
    """What a demonstration would be if the arm followed the hand exactly, and where the objects really were.

    It holds no joint states and no forces, and the physics has not judged it.

    Args:
        scene_name: What the scene is called.
        scene: The scene.
        robot_name: Name of the robot, which is in the picture's light.
        seed: Decides the scene's layout and how the hand varies.
    """
    robot = load_robot(robot_name, scene.task.tool)
    with World(scene, seed) as world:
        start = Arm(world.client, robot).state().world_from_tool
        picture, frames = world.take_picture(), world.true_frames()
    script = write_script(
        scene.task,
        frames,
        start=start,
        turn=turn_choices(scene.task, frames)[0],
        maximum_opening=robot.gripper.maximum_opening,
        time_step=scene.physics.time_step,
        rng=np.random.default_rng([seed, HAND_STREAM]),
    )
    every = max(1, round(_SAMPLE_PERIOD / scene.physics.time_step))
    n = len(script.positions[::every])
    episode = RecordedEpisode(
        scene=scene_name,
        robot=robot_name,
        seed=seed,
        verdict=Verdict(Outcome.SUCCESS, "as the hand wants it; not seen by the physics"),
        times=np.arange(n, dtype=np.float64) * every * scene.physics.time_step,
        joint_positions=np.zeros((n, 0)),
        joint_velocities=np.zeros((n, 0)),
        joint_torques=np.zeros((n, 0)),
        tool_positions=script.positions[::every],
        tool_quaternions=script.rotations.as_quat()[::every],
        gripper_openings=script.openings[::every],
        gripper_orders=script.openings[::every],
        hand_forces=np.zeros((n, 3)),
        hand_torques=np.zeros((n, 3)),
        carrying=script.carrying[::every],
        picture=picture,
        detections=(),
        camera=scene.camera.camera,
    )
    return episode, frames
