"""Episodes in the layout of robomimic's HDF5 data sets.

``data/demo_<k>`` holds ``actions``, ``states``, ``rewards``, ``dones``, ``obs/<name>`` and
``next_obs/<name>``. The attributes ``num_samples`` and ``total`` count;
``env_args`` says in JSON what the environment was.
"""

import io
import json
from collections.abc import Sequence
from pathlib import Path

import h5py
import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.exchange.samples import ACTION_NAMES, Samples, object_names, sample
from cobot_lfd.app.disk import write_file
from cobot_lfd.arrays import Array


def export_robomimic(episodes: Sequence[RecordedEpisode], file: Path) -> int:
    """Write episodes into one HDF5 file in robomimic's layout.

    Args:
        episodes: At least one, all of the same scene and robot.
        file: The file, ending in .hdf5.

    Returns:
        How many samples were written.

    Raises:
        DataError: If the file cannot be written.
    """
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as hdf5:
        data = hdf5.create_group("data")
        total = sum(_write(data.create_group(f"demo_{i}"), episode) for i, episode in enumerate(episodes))
        data.attrs["total"] = total
        data.attrs["env_args"] = json.dumps(
            {
                "env_name": episodes[0].scene,
                "type": 1,
                "env_kwargs": {"robot": episodes[0].robot, "action_names": ACTION_NAMES},
            }
        )
        names = np.array([f"demo_{i}" for i in range(len(episodes))], dtype="S")
        hdf5.create_dataset("mask/train", data=names)
    write_file(file, buffer.getvalue())
    return total


def _write(group: h5py.Group, episode: RecordedEpisode) -> int:
    """Write one episode and return how many samples it has."""
    samples = sample(episode)
    n_samples = len(samples.actions)
    ends = np.arange(n_samples) == n_samples - 1
    group.attrs["num_samples"] = n_samples
    group.attrs["seed"] = episode.seed
    group.attrs["outcome"] = episode.verdict.outcome.kind
    group.attrs["rate_hz"] = samples.rate
    group.attrs["object_names"] = json.dumps(object_names(episode))
    group.create_dataset("actions", data=samples.actions)
    group.create_dataset("states", data=_states(samples))
    group.create_dataset("dones", data=ends.astype(np.int64))
    group.create_dataset("rewards", data=(ends & episode.verdict.succeeded).astype(np.float64))
    following = np.minimum(np.arange(n_samples) + 1, n_samples - 1)
    for name, series in samples.observations.items():
        group.create_dataset(f"obs/{name}", data=series)
        group.create_dataset(f"next_obs/{name}", data=series[following])
    return n_samples


def _states(samples: Samples) -> Array:
    """Joint positions, joint velocities and opening: the state of the arm."""
    parts = ("robot0_joint_pos", "robot0_joint_vel", "robot0_gripper_opening")
    return np.column_stack([samples.observations[name] for name in parts])
