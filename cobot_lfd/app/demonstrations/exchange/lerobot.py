"""Episodes in the folder layout of LeRobot data sets, version 3.0: numbers in parquet, their meaning in JSON.

``data/chunk-000/file-000.parquet`` holds all samples, ``meta/episodes`` where each episode begins and ends,
``meta/tasks.parquet`` the tasks in words, ``meta/info.json`` the features, ``meta/stats.json`` their
statistics. It needs pyarrow, which the extra ``lerobot`` installs.
"""

from __future__ import annotations

import io
import json
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.exchange.samples import ACTION_NAMES, object_names, sample
from cobot_lfd.app.disk import told, write_file
from cobot_lfd.arrays import Array
from cobot_lfd.errors import CobotError, DataError

if TYPE_CHECKING:
    import pyarrow as pa

_STATE = ("robot0_joint_pos", "robot0_eef_pos", "robot0_eef_quat", "robot0_gripper_opening")
_DATA = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
_EPISODES = "meta/episodes/chunk-000/file-000.parquet"
_INDEX = ("frame_index", "episode_index", "index", "task_index")


def export_lerobot(episodes: Sequence[RecordedEpisode], folder: Path, task: str) -> int:
    """Write episodes into a new folder in LeRobot's layout, version 3.0.

    Args:
        episodes: At least one, all of the same scene, robot and rate.
        folder: The folder; it must not be there yet.
        task: What is done, in words.

    Returns:
        How many samples were written.

    Raises:
        CobotError: If pyarrow is not installed.
        DataError: If the folder is there already or cannot be written, or the episodes differ in rate.
    """
    if find_spec("pyarrow") is None:  # Asked for before anything is written.
        raise CobotError("writing LeRobot data needs pyarrow; install it: pip install 'cobot-lfd[lerobot]'.")
    rows, rate = _rows(episodes)
    if folder.exists():
        raise DataError(f"{folder} is there already; name a new folder.")
    with told(folder, "write"):
        for part in ("meta/episodes/chunk-000", "data/chunk-000"):
            (folder / part).mkdir(parents=True)
    lengths = np.bincount(rows["episode_index"][:, 0].astype(np.int64)).astype(np.int64)
    _write_table(folder / _DATA.format(chunk_index=0, file_index=0), _table(rows))
    _write_table(folder / _EPISODES, _episode_table(lengths, task))
    _write_table(folder / "meta/tasks.parquet", _task_table(task))
    _write_json(folder / "meta/stats.json", {name: _statistics(series) for name, series in rows.items()})
    _write_json(folder / "meta/info.json", _info(episodes, rows, rate, lengths))
    return int(lengths.sum())


def _rows(episodes: Sequence[RecordedEpisode]) -> tuple[dict[str, Array], int]:
    """All samples of all episodes, one after the other, by feature; and their rate [Hz]."""
    sampled = [sample(episode) for episode in episodes]
    rates = {samples.rate for samples in sampled}
    if len(rates) > 1:
        raise DataError(f"the episodes have different rates ({sorted(rates)} Hz); export them apart.")
    [rate] = rates
    lengths = [len(samples.actions) for samples in sampled]
    frame_index = np.concatenate([np.arange(n) for n in lengths])
    observed = [samples.observations for samples in sampled]
    rows = {
        "observation.state": np.concatenate(
            [np.column_stack([o[name] for name in _STATE]) for o in observed]
        ),
        "observation.environment_state": np.concatenate([o["object"] for o in observed]),
        "observation.hand": np.concatenate(
            [np.column_stack([o["hand_force"], o["hand_torque"]]) for o in observed]
        ),
        "action": np.concatenate([samples.actions for samples in sampled]),
        "timestamp": frame_index[:, None] / rate,
        "frame_index": frame_index[:, None],
        "episode_index": np.repeat(np.arange(len(lengths)), lengths)[:, None],
        "index": np.arange(sum(lengths))[:, None],
        "task_index": np.zeros((sum(lengths), 1)),
    }
    return rows, rate


def _table(rows: dict[str, Array]) -> pa.Table:
    import pyarrow as pa

    columns = {}
    for name, series in rows.items():
        if series.shape[1] == 1:
            kind = pa.int64() if name in _INDEX else pa.float32()
            columns[name] = pa.array(series[:, 0].astype(np.int64 if name in _INDEX else np.float32), kind)
        else:
            flat = pa.array(series.astype(np.float32).reshape(-1), pa.float32())
            columns[name] = pa.FixedSizeListArray.from_arrays(flat, series.shape[1])
    return pa.table(columns)


def _episode_table(lengths: NDArray[np.int64], task: str) -> pa.Table:
    import pyarrow as pa

    ends = np.cumsum(lengths)
    n = len(lengths)
    return pa.table(
        {
            "episode_index": np.arange(n),
            "tasks": [[task]] * n,
            "length": lengths,
            "dataset_from_index": ends - lengths,
            "dataset_to_index": ends,
            "data/chunk_index": np.zeros(n, dtype=np.int64),
            "data/file_index": np.zeros(n, dtype=np.int64),
            "meta/episodes/chunk_index": np.zeros(n, dtype=np.int64),
            "meta/episodes/file_index": np.zeros(n, dtype=np.int64),
        }
    )


def _task_table(task: str) -> pa.Table:
    """The tasks; the words are the index of the data frame that pandas makes of it."""
    import pyarrow as pa

    table = pa.table({"task_index": np.zeros(1, dtype=np.int64), "task": [task]})
    names = [
        {"name": "task_index", "field_name": "task_index", "pandas_type": "int64", "numpy_type": "int64"},
        {"name": "task", "field_name": "task", "pandas_type": "unicode", "numpy_type": "object"},
    ]
    pandas = {"index_columns": ["task"], "columns": names, "column_indexes": [], "pandas_version": "2.0.0"}
    return table.replace_schema_metadata({"pandas": json.dumps(pandas)})


def _statistics(series: Array) -> dict[str, list[float]]:
    low, high, mean, deviation = series.min(0), series.max(0), series.mean(0), series.std(0)
    named = {"min": low, "max": high, "mean": mean, "std": deviation}
    return {name: value.astype(float).tolist() for name, value in named.items()} | {"count": [len(series)]}


def _info(
    episodes: Sequence[RecordedEpisode], rows: dict[str, Array], rate: int, lengths: NDArray[np.int64]
) -> dict[str, Any]:
    n_joints = episodes[0].joint_positions.shape[1]
    names: dict[str, list[str]] = {
        "observation.state": [
            *(f"joint_{i + 1}" for i in range(n_joints)),
            *("x", "y", "z", "qx", "qy", "qz", "qw", "opening"),
        ],
        "observation.environment_state": object_names(episodes[0]),
        "observation.hand": ["fx", "fy", "fz", "tx", "ty", "tz"],
        "action": list(ACTION_NAMES),
    }
    features = {
        name: {
            "dtype": "int64" if name in _INDEX else "float32",
            "shape": [series.shape[1]],
            "names": names.get(name),
        }
        for name, series in rows.items()
    }
    return {
        "codebase_version": "v3.0",
        "robot_type": episodes[0].robot,
        "total_episodes": len(lengths),
        "total_frames": int(lengths.sum()),
        "total_tasks": 1,
        "chunks_size": 1000,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": rate,
        "splits": {"train": f"0:{len(lengths)}"},
        "data_path": _DATA,
        "video_path": None,
        "features": features,
    }


def _write_table(file: Path, table: pa.Table) -> None:
    import pyarrow.parquet as pq

    buffer = io.BytesIO()
    pq.write_table(table, buffer)
    write_file(file, buffer.getvalue())


def _write_json(file: Path, value: object) -> None:
    write_file(file, json.dumps(value, indent=1).encode())
