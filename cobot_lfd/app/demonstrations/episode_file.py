"""The layout of an episode in HDF5: each series a data set with its unit, each detection a group."""

import io

import h5py
import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.gripper_orders import guessed_orders
from cobot_lfd.app.demonstrations.pulls import Pulls
from cobot_lfd.app.demonstrations.seal import BLOCK_SIZE, check_seal, seal
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection
from cobot_lfd.errors import DataError
from cobot_lfd.frame import Frame
from cobot_lfd.outcome import Outcome, Verdict
from cobot_lfd.pose import Pose

TITLE = "cobot-lfd episode"
VERSION = 2
"""Raised whenever a program of the version before could not read what is written now."""

READABLE = (1, VERSION)
"""Version 1 knew neither the orders to the gripper, which are worked out, nor the pulls of every step."""

UNITS = {
    "times": "s",
    "joint_positions": "rad",
    "joint_velocities": "rad/s",
    "joint_torques": "N m",
    "tool_positions": "m",
    "tool_quaternions": "1 (x, y, z, w)",
    "gripper_openings": "m",
    "gripper_orders": "m",
    "hand_forces": "N",
    "hand_torques": "N m",
    "carrying": "1 (true or false)",
    "picture": "1 (RGB, 0 to 255)",
}
"""Unit of every series of an episode."""

PULL_UNITS = {"forces": "N", "torques": "N m", "openings": "m"}
"""Unit of every array of the pulls."""

DETECTION_UNITS = {"position": "m", "angle": "rad", "covariance": "m, m, rad, squared", "contour": "px"}
"""Unit of every array of a detection."""

CAMERA_UNITS = {"matrix": "px", "distortion": "1", "position": "m", "rotation": "1"}
"""Unit of every array of the camera."""


def episode_to_bytes(episode: RecordedEpisode) -> bytes:
    """The whole file of an episode: equal episodes give equal bytes."""
    buffer = io.BytesIO()
    with h5py.File(buffer, "w", userblock_size=BLOCK_SIZE) as file:
        file.attrs["scene"] = episode.scene
        file.attrs["robot"] = episode.robot
        file.attrs["seed"] = episode.seed
        file.attrs["outcome"] = episode.verdict.outcome.kind
        file.attrs["detail"] = episode.verdict.detail
        for name, unit in UNITS.items():
            _write_array(file, name, getattr(episode, name), unit)
        if episode.camera is not None:
            _write_camera(file.create_group("camera"), episode.camera)
        pulls = file.create_group("pulls")
        for name, unit in PULL_UNITS.items():
            _write_array(pulls, name, getattr(episode.pulls, name), unit)
        for index, detection in enumerate(episode.detections):
            _write_detection(file.create_group(f"detections/{index}"), detection)
    return seal(buffer.getvalue()[BLOCK_SIZE:], title=TITLE, version=VERSION)


def episode_from_bytes(sealed: bytes, name: str) -> RecordedEpisode:
    """The episode that a file holds.

    Args:
        sealed: The bytes of the whole file.
        name: What the file is called in an error message.

    Raises:
        DataError: If the file is foreign, damaged or of another version, or its contents are no episode.
    """
    version = check_seal(sealed, title=TITLE, versions=READABLE, name=name)
    try:
        with h5py.File(io.BytesIO(sealed), "r") as file:
            return _read_episode(file, version)
    except (KeyError, TypeError, ValueError, OSError) as error:
        raise DataError(f"{name} holds no valid episode: {error}. Record it again.") from error


def _write_array(group: h5py.Group, name: str, array: object, unit: str) -> None:
    values = np.asarray(array)
    packing = {"compression": "gzip", "shuffle": True} if values.size and values.ndim else {}
    group.create_dataset(name, data=values, **packing).attrs["unit"] = unit


def _write_detection(group: h5py.Group, detection: Detection) -> None:
    group.attrs["name"] = detection.name
    group.attrs["symmetry"] = detection.symmetry
    group.attrs["confidence"] = detection.confidence
    arrays = {
        "position": detection.frame.position,
        "angle": detection.frame.angle,
        "covariance": detection.covariance,
        "contour": detection.contour,
    }
    for name, array in arrays.items():
        _write_array(group, name, array, DETECTION_UNITS[name])


def _write_camera(group: h5py.Group, camera: Camera) -> None:
    group.attrs["width"] = camera.width
    group.attrs["height"] = camera.height
    pose = camera.world_from_camera
    arrays = {
        "matrix": camera.matrix,
        "distortion": camera.distortion,
        "position": pose.position,
        "rotation": pose.rotation,
    }
    for name, array in arrays.items():
        _write_array(group, name, array, CAMERA_UNITS[name])


def _read_camera(group: h5py.Group) -> Camera:
    return Camera(
        int(group.attrs["width"]),
        int(group.attrs["height"]),
        group["matrix"][()],
        Pose(group["position"][()], group["rotation"][()]),
        group["distortion"][()],
    )


def _read_episode(file: h5py.File, version: int) -> RecordedEpisode:
    detections = file.get("detections", {})
    series = {name: file[name][()] for name in UNITS if version > 1 or name != "gripper_orders"}
    if version == 1:
        series["gripper_orders"] = guessed_orders(series["gripper_openings"])
    return RecordedEpisode(
        scene=str(file.attrs["scene"]),
        robot=str(file.attrs["robot"]),
        seed=int(file.attrs["seed"]),
        verdict=Verdict(Outcome.from_kind(str(file.attrs["outcome"])), str(file.attrs["detail"])),
        camera=_read_camera(file["camera"]) if "camera" in file else None,
        detections=tuple(_read_detection(detections[str(index)]) for index in range(len(detections))),
        pulls=_read_pulls(file) if version > 1 else Pulls.none(),
        **series,
    )


def _read_pulls(file: h5py.File) -> Pulls:
    return Pulls(**{name: file["pulls"][name][()] for name in PULL_UNITS})


def _read_detection(group: h5py.Group) -> Detection:
    return Detection(
        name=str(group.attrs["name"]),
        frame=Frame(group["position"][()], float(group["angle"][()])),
        symmetry=int(group.attrs["symmetry"]),
        covariance=group["covariance"][()],
        confidence=float(group.attrs["confidence"]),
        contour=group["contour"][()],
    )
