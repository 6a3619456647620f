"""How the paths seen from each frame are kept: as a Gaussian mixture, or as statistics at each time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import TaskData
from cobot_lfd.learning.mixtures.em import EMFit, EMSettings, fit_mixture
from cobot_lfd.learning.mixtures.kernel import kernel_statistics, kernel_weights, local_linear_weights
from cobot_lfd.learning.mixtures.mixture import Mixture, regress
from cobot_lfd.learning.mixtures.profile import Profile


@dataclass(frozen=True, slots=True, eq=False)
class MixtureEncoding:
    """A Gaussian mixture of [t, x] shared by all frames, and one of [t, r] for each ring.

    Attributes:
        mixture: The Gaussians.
        rings: The ring Gaussians of each orientation-less frame, by its number (paper, section 4.3).
    """

    mixture: Mixture
    rings: Mapping[int, Mixture]

    def profile(self, times: Array) -> Profile:
        """Gaussian mixture regression at normalised times; a regressed radius below zero counts as zero."""
        mean, covariance = regress(self.mixture, times)
        radius = np.zeros(mean.shape[:2])
        variance = np.ones(mean.shape[:2])
        for frame, ring in self.rings.items():
            centre, spread = regress(ring, times)
            radius[frame] = np.maximum(centre[0, :, 0], 0.0)
            variance[frame] = spread[0, :, 0, 0]
        return Profile(mean, covariance, radius, variance)


@dataclass(frozen=True, slots=True, eq=False)
class TableEncoding:
    """Statistics at equally spaced normalised times, between which is interpolated.

    Attributes:
        table: The statistics.
    """

    table: Profile

    def profile(self, times: Array) -> Profile:
        """The table, interpolated."""
        return self.table.at(times * (self.table.mean.shape[1] - 1))


Encoding = MixtureEncoding | TableEncoding


def fit_rings(
    data: TaskData, frames: Sequence[int], settings: EMSettings, rng: np.random.Generator
) -> dict[int, EMFit]:
    """A mixture of [t, r] for each of these frames (paper, eqs. 16-17)."""
    radii = np.linalg.norm(data.local, axis=-1)
    return {j: fit_mixture(radii[:, [j], :, None], data.times, settings, rng) for j in frames}


def tabulate(data: TaskData, width: float, regularisation: float) -> TableEncoding:
    """Kernel statistics of the paths, and of their distances, seen from each frame.

    Args:
        data: The demonstrations.
        width: Standard deviation of the kernel, in units of the path's duration.
        regularisation: Smallest variance, in units of the data's mean square size.
    """
    linear = local_linear_weights(data.times, data.times, width)
    average = kernel_weights(data.times, data.times, width)
    local = data.local
    floor = regularisation * max(data.scale, 1e-9) ** 2
    mean, covariance = kernel_statistics(local, linear, average)
    radii = np.linalg.norm(local, axis=-1, keepdims=True)
    radius, variance = kernel_statistics(radii, linear, average)
    return TableEncoding(
        Profile(
            mean,
            covariance + floor * np.eye(local.shape[-1]),
            np.maximum(radius[..., 0], 0.0),
            variance[..., 0, 0] + floor,
        )
    )
