"""What an arm must not hit, where the picture says that it is."""

from collections.abc import Mapping

import numpy as np

from cobot_lfd.frame import Frame
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from scenes.boxes import blocks_of
from scenes.description import SceneDescription

_TABLE = "table"


def obstacles(description: SceneDescription, frames: Mapping[str, Frame]) -> tuple[Obstacle, ...]:
    """The table, and the scene's objects at the places where they were seen.

    Args:
        description: The scene.
        frames: Where its objects are; what is not among them was not seen and is left out.
    """
    half_size = 0.5 * np.array([*description.table.size, description.table.thickness])
    centre = np.array([*description.table.centre, -half_size[2]])
    table = Obstacle(_TABLE, Pose.identity(), centre[None], half_size[None])
    return (table, *(object_obstacle(description, name, frame) for name, frame in frames.items()))


def object_obstacle(description: SceneDescription, name: str, frame: Frame) -> Obstacle:
    """One object that stands on the table at a frame."""
    blocks = blocks_of(description.objects[name])
    return Obstacle(
        name,
        Pose.from_rpy([*frame.position, 0.0], [0.0, 0.0, frame.angle]),
        np.array([block.centre for block in blocks]),
        np.array([block.half_size for block in blocks]),
    )
