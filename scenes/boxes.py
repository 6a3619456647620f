"""What an object is built from: boxes, placed in the object's own frame."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array, frozen_array
from scenes.colours import Colour
from scenes.shapes import Assembly, Ball, Box, Container, ObjectDescription, Part


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """A box whose sides are parallel to the axes of an object's frame.

    Attributes:
        centre: Its middle in the object's frame [m], shape (3,).
        half_size: Half its extent along the axes [m], shape (3,).
        colour: Its own colour, where it differs from the object's.
    """

    centre: Array
    half_size: Array
    colour: Colour | None = None

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "centre", frozen_array(self.centre, "centre", (3,)))
        object.__setattr__(self, "half_size", frozen_array(self.half_size, "half_size", (3,)))


def blocks_of(item: ObjectDescription) -> tuple[Block, ...]:
    """The boxes that make up an object, or enclose it; its frame is at its foot, z upwards."""
    match item:
        case Box():
            return (_block((0.0, 0.0), item.size, foot=0.0),)
        case Container():
            return _container(item)
        case Ball():
            return (_block((0.0, 0.0), (item.diameter,) * 3, foot=0.0),)
        case Assembly():
            return tuple(_between(part) for part in item.boxes)


def _container(item: Container) -> tuple[Block, ...]:
    """A floor and four walls, which do not overlap: the long ones run along x."""
    (length, width), wall, height = item.inner_size, item.wall, item.height - item.floor
    along_x = (length + 2 * wall, wall, height)
    along_y = (wall, width, height)
    return (
        _block((0.0, 0.0), (*item.outer_size, item.floor), foot=0.0),
        *(_block((0.0, side * (width + wall) / 2), along_x, foot=item.floor) for side in (1, -1)),
        *(_block((side * (length + wall) / 2, 0.0), along_y, foot=item.floor) for side in (1, -1)),
    )


def _block(centre: tuple[float, float], size: tuple[float, float, float], *, foot: float) -> Block:
    return Block(np.array([*centre, foot + size[2] / 2]), np.array(size) / 2)


def _between(part: Part) -> Block:
    low, high = np.array(part.low), np.array(part.high)
    return Block(0.5 * (low + high), 0.5 * (high - low), part.colour)
