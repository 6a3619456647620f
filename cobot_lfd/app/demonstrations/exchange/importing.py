"""Paths that were recorded elsewhere, on a real cobot for instance, as episodes that can be learnt from.

A path is a CSV file with a header, or an npz file with arrays of the same names::

    t,x,y,z,qx,qy,qz,qw,gripper,carrying

``t`` [s], ``x`` and ``y`` [m] are needed; where they are left out, ``z`` [m] is 0, the quaternion that of a
tool pointing down, ``gripper`` [m] 0 and ``carrying`` (0 or 1) 1. The frames are a TOML file::

    [frames.cube]
    position = [0.45, -0.12]   # [m]
    angle_deg = 30.0
"""

from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.gripper_orders import guessed_orders
from cobot_lfd.app.disk import told
from cobot_lfd.arrays import Array
from cobot_lfd.description_file import DescriptionModel, read_description
from cobot_lfd.detection import Detection
from cobot_lfd.errors import DataError
from cobot_lfd.frame import Frame
from cobot_lfd.outcome import Outcome, Verdict

IMPORTED = "imported"
"""Stands for the robot of an episode that was not recorded here."""

_NEEDED = ("t", "x", "y")
_DEFAULTS = {"z": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0, "qw": 0.0, "gripper": 0.0, "carrying": 1.0}


class _Frame(DescriptionModel):
    position: tuple[float, float]
    angle_deg: float = 0.0


class _Frames(DescriptionModel):
    frames: Annotated[dict[str, _Frame], Field(min_length=1)]


def import_path(path: Path, frames: Path, scene: str, *, robot: str = IMPORTED) -> RecordedEpisode:
    """A path and its frames as an episode.

    It has no joint states, no forces and no picture, and nobody but the one who imports it vouches for its
    success; its verdict says so.

    Args:
        path: The CSV or npz file.
        frames: The TOML file.
        scene: Name of the scene that the path belongs to.
        robot: Name of the robot that it was recorded with.

    Raises:
        DataError: If a file cannot be read or a column is missing or no number.
        DescriptionError: If the frames are not as they should be.
    """
    columns = _read_columns(path)
    n_samples = len(columns["t"])
    nothing = np.zeros((n_samples, 0))
    try:
        return RecordedEpisode(
            scene=scene,
            robot=robot,
            seed=0,
            verdict=Verdict(Outcome.SUCCESS, f"as imported from {path.name}; not seen by the physics"),
            times=columns["t"],
            joint_positions=nothing,
            joint_velocities=nothing,
            joint_torques=nothing,
            tool_positions=np.column_stack([columns[name] for name in ("x", "y", "z")]),
            tool_quaternions=np.column_stack([columns[name] for name in ("qx", "qy", "qz", "qw")]),
            gripper_openings=columns["gripper"],
            gripper_orders=guessed_orders(columns["gripper"]),
            hand_forces=np.zeros((n_samples, 3)),
            hand_torques=np.zeros((n_samples, 3)),
            carrying=columns["carrying"] > 0.5,
            picture=np.zeros((0, 0, 3), dtype=np.uint8),
            detections=_read_frames(frames),
        )
    except ValueError as error:
        raise DataError(f"{path} holds no path: {error}") from error


def _read_columns(path: Path) -> dict[str, Array]:
    """All columns by name, those that were left out with their defaults."""
    readers = {".csv": _read_csv, ".npz": _read_npz}
    if path.suffix.lower() not in readers:
        raise DataError(f"{path}: a path to import must be a .csv or .npz file.")
    with told(path, "read"):
        columns = readers[path.suffix.lower()](path)
    missing = [name for name in _NEEDED if name not in columns]
    if missing:
        raise DataError(
            f"{path} has no column {', '.join(missing)}; it needs {', '.join(_NEEDED)} and may have "
            f"{', '.join(_DEFAULTS)}."
        )
    n_samples = len(columns["t"])
    return {name: np.full(n_samples, value) for name, value in _DEFAULTS.items()} | columns


def _read_csv(path: Path) -> dict[str, Array]:
    header = path.read_text(encoding="utf-8").partition("\n")[0]
    names = [name.strip() for name in header.split(",")]
    try:
        rows = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    except ValueError as error:
        raise DataError(f"{path} is no table of numbers below a header: {error}.") from error
    if rows.shape[1] != len(names):
        raise DataError(f"{path} names {len(names)} columns and has {rows.shape[1]}.")
    return dict(zip(names, rows.T, strict=True))


def _read_npz(path: Path) -> dict[str, Array]:
    try:
        with np.load(path, allow_pickle=False) as arrays:
            return {name: np.asarray(arrays[name], dtype=np.float64) for name in arrays.files}
    except ValueError as error:
        raise DataError(f"{path} is no npz file of numbers: {error}.") from error


def _read_frames(file: Path) -> tuple[Detection, ...]:
    """The frames, as if a camera had seen them without an error."""
    frames = read_description(file, _Frames).frames
    return tuple(
        Detection(
            name=name,
            frame=Frame(np.array(frame.position), np.deg2rad(frame.angle_deg)),
            symmetry=1,
            covariance=np.zeros((3, 3)),
            confidence=1.0,
            contour=np.zeros((0, 2)),
        )
        for name, frame in frames.items()
    )
