"""A generated path: where to go at each time, and how far the demonstrations allow to differ."""

from dataclasses import dataclass
from typing import Self

import numpy as np

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

    @classmethod
    def batch(cls, means: Array, covariances: Array, times: Array) -> list[Self]:
        """Many paths with the same times, checked together: a thousand checks one by one take longer.

        Args:
            means: Shape (S, T, d).
            covariances: Shape (S, T, d, d).
            times: Shape (T,).
        """
        s, n, d = means.shape
        if covariances.shape != (s, n, d, d) or times.shape != (n,):
            raise ValueError(
                f"covariances {covariances.shape} and times {times.shape} do not fit {means.shape}."
            )
        if not (np.isfinite(means).all() and np.isfinite(covariances).all()):
            raise ValueError("a generated path holds numbers that are not finite; check the frames.")
        for array in (means, covariances, times):
            array.setflags(write=False)
        paths = []
        for mean, covariance in zip(means, covariances, strict=True):
            path = cls.__new__(cls)
            object.__setattr__(path, "mean", mean)
            object.__setattr__(path, "covariance", covariance)
            object.__setattr__(path, "times", times)
            paths.append(path)
        return paths
