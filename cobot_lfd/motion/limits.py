"""What the joints of an arm can do: position, velocity, acceleration and jerk limits."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array, frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class JointLimits:
    """What the joints of an arm can do; one number per joint, the same in both directions of motion.

    Attributes:
        position_lower: Smallest position [rad], shape (n,).
        position_upper: Largest position [rad], shape (n,).
        velocity: Largest speed [rad/s], shape (n,).
        acceleration: Largest acceleration [rad/s^2], shape (n,).
        jerk: Largest jerk [rad/s^3], shape (n,).
    """

    position_lower: Array
    position_upper: Array
    velocity: Array
    acceleration: Array
    jerk: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        n = len(np.atleast_1d(self.position_lower))
        for name in ("position_lower", "position_upper", "velocity", "acceleration", "jerk"):
            object.__setattr__(self, name, frozen_array(getattr(self, name), name, (n,)))
        if (self.position_lower >= self.position_upper).any():
            joint = int(np.argmax(self.position_lower >= self.position_upper))
            raise ValueError(
                f"position_lower of joint {joint} is {self.position_lower[joint]} rad; it must be below "
                f"position_upper, which is {self.position_upper[joint]} rad."
            )
        for name in ("velocity", "acceleration", "jerk"):
            if (getattr(self, name) <= 0).any():
                joint = int(np.argmin(getattr(self, name)))
                raise ValueError(
                    f"{name} of joint {joint} is {getattr(self, name)[joint]}; it must be positive."
                )

    @property
    def n_joints(self) -> int:
        """Number of joints."""
        return len(self.velocity)

    def scaled(self, *, velocity: float = 1.0, acceleration: float = 1.0, jerk: float = 1.0) -> "JointLimits":
        """The same position limits, with each of the other limits multiplied by its factor."""
        return JointLimits(
            self.position_lower,
            self.position_upper,
            velocity * self.velocity,
            acceleration * self.acceleration,
            jerk * self.jerk,
        )
