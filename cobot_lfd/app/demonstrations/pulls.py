"""What a hand did in every step of the physics: enough to do it again exactly."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array, frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class Pulls:
    """Force, torque and order to the gripper, one entry per step of the physics, ``K`` in number.

    The samples of an episode are some of these steps; the first of both is the same moment.

    Attributes:
        forces: On the tool, in the world [N], shape (K, 3).
        torques: On the tool, in the world [N m], shape (K, 3).
        openings: What the gripper is told [m], shape (K,).
    """

    forces: Array
    torques: Array
    openings: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "openings", frozen_array(self.openings, "openings", (None,)))
        for name in ("forces", "torques"):
            array = frozen_array(getattr(self, name), name, (len(self), 3))
            object.__setattr__(self, name, array)

    @classmethod
    def none(cls) -> "Pulls":
        """Nothing is known of the hand, as where a path was recorded elsewhere."""
        return cls(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))

    def __len__(self) -> int:
        """Number of steps."""
        return len(self.openings)
