"""When a path is where: the path parameter as a function of time."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.arrays import Array, frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class TimeLaw:
    """The path parameter ``s(t)`` in pieces of constant jerk, from rest to rest.

    Attributes:
        times: Start of each piece, then the end of the last [s], shape (B + 1,); the first is 0.
        states: s, s', s'' at the start of each piece, shape (B, 3).
        jerks: s''' during each piece, shape (B,).
    """

    times: Array
    states: Array
    jerks: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        n = len(np.atleast_1d(self.jerks))
        if n < 1:
            raise ValueError("jerks is empty; a time law needs at least one piece.")
        object.__setattr__(self, "jerks", frozen_array(self.jerks, "jerks", (n,)))
        object.__setattr__(self, "states", frozen_array(self.states, "states", (n, 3)))
        object.__setattr__(self, "times", frozen_array(self.times, "times", (n + 1,)))
        if self.times[0] != 0 or (np.diff(self.times) < 0).any():
            raise ValueError("times must start at 0 and never decrease.")

    @classmethod
    def hold(cls, duration: float) -> "TimeLaw":
        """Stay at s = 0 for ``duration`` [s]."""
        return cls(np.array([0.0, duration]), np.zeros((1, 3)), np.zeros(1))

    @property
    def duration(self) -> float:
        """How long it takes [s]."""
        return float(self.times[-1])

    def __call__(self, times: ArrayLike, order: int = 0) -> Array:
        """The parameter, or its time derivative of the given order (0 to 3), at ``times`` [s]."""
        return self.derivatives(times)[order]

    def derivatives(self, times: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """The parameter and its first three time derivatives at ``times`` [s], each of their shape."""
        t = np.clip(np.asarray(times, dtype=np.float64), 0.0, self.duration)
        piece = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, len(self.jerks) - 1)
        dt = t - self.times[piece]
        s, v, a = (column[piece] for column in self.states.T)
        j = self.jerks[piece]
        return (
            np.asarray(s + dt * (v + dt * (a / 2 + dt * j / 6))),
            np.asarray(v + dt * (a + dt * j / 2)),
            np.asarray(a + dt * j),
            np.asarray(j),
        )

    def stretched(self, factor: float) -> "TimeLaw":
        """The same motion, ``factor`` times as long: s', s'', s''' shrink by factor, its square, its cube."""
        return TimeLaw(
            factor * self.times, self.states / np.array([1.0, factor, factor**2]), self.jerks / factor**3
        )
