"""A calibrated camera as a file (TOML)."""

from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from cobot_lfd.camera import Camera
from cobot_lfd.description_file import DescriptionModel, read_description
from cobot_lfd.pose import Pose

_Pixels = Annotated[int, Field(ge=1)]
_Row = tuple[float, float, float]


class CameraValues(DescriptionModel):
    """A camera in plain numbers, as its file holds them; see ``Camera`` for the meaning."""

    width: _Pixels
    height: _Pixels
    matrix: tuple[_Row, _Row, _Row]
    distortion: tuple[float, float, float, float, float]
    position: _Row
    quaternion: tuple[float, float, float, float]

    @property
    def camera(self) -> Camera:
        """The camera of these values."""
        pose = Pose.from_quaternion(self.position, self.quaternion)
        return Camera(self.width, self.height, np.array(self.matrix), pose, np.array(self.distortion))


def load_camera(file: Path) -> Camera:
    """The camera that a file describes.

    Raises:
        DescriptionError: If the file cannot be read, or holds a key or value that is not allowed.
    """
    return read_camera_values(file).camera


def read_camera_values(file: Path) -> CameraValues:
    """What a camera's file holds.

    Raises:
        DescriptionError: If the file cannot be read, or holds a key or value that is not allowed.
    """
    return read_description(file, CameraValues)


def save_camera(camera: Camera, file: Path) -> None:
    """Write a camera to a file; ``load_camera`` gives it back."""
    pose = camera.world_from_camera
    lines = [
        f"width = {camera.width}  # [px]",
        f"height = {camera.height}  # [px]",
        f"matrix = {camera.matrix.tolist()}  # [px]",
        f"distortion = {camera.distortion.tolist()}  # k1, k2, p1, p2, k3",
        f"position = {pose.position.tolist()}  # in the world [m]",
        f"quaternion = {pose.quaternion.tolist()}  # x, y, z, w",
    ]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
