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


class _CameraFile(DescriptionModel):
    """What the file holds; see ``Camera`` for the meaning."""

    width: _Pixels
    height: _Pixels
    matrix: tuple[_Row, _Row, _Row]
    distortion: tuple[float, float, float, float, float]
    position: _Row
    quaternion: tuple[float, float, float, float]


def load_camera(file: Path) -> Camera:
    """The camera that a file describes.

    Raises:
        DescriptionError: If the file cannot be read, or holds a key or value that is not allowed.
    """
    content = read_description(file, _CameraFile)
    return Camera(
        content.width,
        content.height,
        np.array(content.matrix),
        Pose.from_quaternion(content.position, content.quaternion),
        np.array(content.distortion),
    )


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
