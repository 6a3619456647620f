"""What learning says about the path as seen from each frame, at each time."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """Gaussians in the axes of each frame, and rings around it, at T times.

    Attributes:
        mean: Where the path is, in the frame's axes [m], shape (J, T, d).
        covariance: How far it varies [m²], shape (J, T, d, d).
        radius: How far from the frame's origin the path is [m], shape (J, T).
        radius_variance: How far that varies [m²], shape (J, T).
    """

    mean: Array
    covariance: Array
    radius: Array
    radius_variance: Array

    def at(self, places: Array) -> "Profile":
        """Interpolated linearly at places in units of the table's steps, shape (T',)."""
        low = np.clip(places.astype(int), 0, max(self.mean.shape[1] - 2, 0))
        high = np.minimum(low + 1, self.mean.shape[1] - 1)
        share = places - low

        def between(table: Array) -> Array:
            weight = share.reshape((1, -1) + (1,) * (table.ndim - 2))
            return np.asarray(table[:, low] * (1 - weight) + table[:, high] * weight)

        return Profile(
            between(self.mean),
            between(self.covariance),
            between(self.radius),
            between(self.radius_variance),
        )
