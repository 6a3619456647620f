"""What other projects' learning methods want of an episode: observations and actions at a steady rate."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.arrays import Array

ACTION_NAMES = ("dx", "dy", "dz", "droll", "dpitch", "dyaw", "gripper")
"""An action: how the tool moves to the next sample [m], how it turns (rotation vector in the world) [rad],
and what the gripper is told, 1 to close and -1 to open."""


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """An episode at a steady rate.

    Attributes:
        rate: Samples per second [Hz].
        observations: Name to series, each of shape (M, k).
        actions: Named by ``ACTION_NAMES``, shape (M, 7).
    """

    rate: int
    observations: dict[str, Array]
    actions: Array


def sample(episode: RecordedEpisode) -> Samples:
    """The samples of an episode, nearest in time to a steady clock."""
    rate = max(1, round(1.0 / float(np.median(np.diff(episode.times)))))
    n_samples = round(float(np.ptp(episode.times)) * rate) + 1
    clock = episode.times[0] + np.arange(n_samples) / rate
    nearest = np.abs(np.subtract.outer(clock, episode.times)).argmin(axis=1)
    observations = {
        "robot0_joint_pos": episode.joint_positions[nearest],
        "robot0_joint_vel": episode.joint_velocities[nearest],
        "robot0_joint_torque": episode.joint_torques[nearest],
        "robot0_eef_pos": episode.tool_positions[nearest],
        "robot0_eef_quat": episode.tool_quaternions[nearest],
        "robot0_gripper_opening": episode.gripper_openings[nearest, None],
        "hand_force": episode.hand_forces[nearest],
        "hand_torque": episode.hand_torques[nearest],
        "object": np.tile(_frames(episode), (len(nearest), 1)),
    }
    return Samples(rate, observations, _actions(episode, nearest))


def object_names(episode: RecordedEpisode) -> list[str]:
    """Names of the numbers in the observation ``object``: where the camera saw each object."""
    return [f"{seen.name}_{part}" for seen in episode.detections for part in ("x", "y", "cos", "sin")]


def _frames(episode: RecordedEpisode) -> Array:
    numbers = [
        (*seen.frame.position, np.cos(seen.frame.angle), np.sin(seen.frame.angle))
        for seen in episode.detections
    ]
    return np.array(numbers).reshape(-1)


def _actions(episode: RecordedEpisode, nearest: Array) -> Array:
    positions = episode.tool_positions[nearest]
    rotations = Rotation.from_quat(episode.tool_quaternions[nearest])
    following = np.minimum(np.arange(len(nearest)) + 1, len(nearest) - 1)
    turns = (rotations[following] * rotations.inv()).as_rotvec()
    closing = np.where(episode.gripper_orders[nearest] > 0.0, -1.0, 1.0)
    return np.column_stack([positions[following] - positions, turns, closing])
