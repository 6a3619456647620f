"""What an arm must not hit, where the picture says that it is."""

from collections.abc import Mapping

import numpy as np

from cobot_lfd.frame import Frame
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from scenes.boxes import Block, blocks_of
from scenes.description import SceneDescription
from scenes.shapes import Ball

_TABLE = "table"
_BAR_SHARE = 0.5  # of a ball's diameter; the corners of such bars stick out by a fifth of the radius


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
    item = description.objects[name]
    blocks = _bars_in(item) if isinstance(item, Ball) else blocks_of(item)
    return Obstacle(
        name,
        Pose.from_rpy([*frame.position, 0.0], [0.0, 0.0, frame.angle]),
        np.array([block.centre for block in blocks]),
        np.array([block.half_size for block in blocks]),
    )


def _bars_in(ball: Ball) -> tuple[Block, ...]:
    """Three bars across a ball, whose corners stick out less than those of a box round it would."""
    radius = 0.5 * ball.diameter
    centre = np.array([0.0, 0.0, radius])
    thickness = np.full((3, 3), _BAR_SHARE * radius)
    np.fill_diagonal(thickness, radius)
    return tuple(Block(centre, half_size) for half_size in thickness)
