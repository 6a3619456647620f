"""A generated path: where to go at each time, and how far the demonstrations allow to differ."""

from dataclasses import dataclass

from cobot_lfd.arrays import Array, frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class GeneratedPath:
    """A generated path with its uncertainty.

    Attributes:
        mean: Positions in the world [m], shape (T, d).
        covariance: How far the demonstrations allow to differ from it [m²], shape (T, d, d).
        times: Time of each position [s], from 0 to the median duration of the demonstrations, shape (T,).
    """

    mean: Array
    covariance: Array
    times: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        mean = frozen_array(self.mean, "mean", (None, None))
        n, d = mean.shape
        object.__setattr__(self, "mean", mean)
        object.__setattr__(self, "covariance", frozen_array(self.covariance, "covariance", (n, d, d)))
        object.__setattr__(self, "times", frozen_array(self.times, "times", (n,)))
