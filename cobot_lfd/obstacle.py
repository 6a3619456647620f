"""Something that an arm must not hit: boxes that are fixed to one another, at a pose."""

from dataclasses import dataclass

from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.pose import Pose


@dataclass(frozen=True, slots=True, eq=False)
class Obstacle:
    """Boxes that are fixed to one another, at a pose.

    Attributes:
        name: What it is, for people.
        pose: Its pose in the world.
        centres: Middle of each box in the obstacle's frame [m], shape (n, 3).
        half_sizes: Half the extent of each box along the frame's axes [m], shape (n, 3).
    """

    name: str
    pose: Pose
    centres: Array
    half_sizes: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "centres", frozen_array(self.centres, "centres", (None, 3)))
        shape = (len(self.centres), 3)
        object.__setattr__(self, "half_sizes", frozen_array(self.half_sizes, "half_sizes", shape))
