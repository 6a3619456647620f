"""The product of the frames' Gaussians in a new scene (paper, eq. 11), in information form."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import Scenes
from cobot_lfd.learning.mixtures.profile import Profile
from cobot_lfd.learning.product import symmetric


@dataclass(frozen=True, slots=True, eq=False)
class Information:
    """Gaussians over T times in S scenes, as precision and precision times mean.

    Attributes:
        precision: Distinct entries [1/m²], shape (S, v, T); see ``symmetric``.
        weighted: Precision times mean [1/m], shape (S, d, T).
    """

    precision: Array
    weighted: Array

    def __add__(self, other: "Information") -> "Information":
        """The product of two Gaussians adds their information."""
        return Information(self.precision + other.precision, self.weighted + other.weighted)

    def moments(self) -> tuple[Array, Array]:
        """Mean [m], shape (S, d, T), and covariance entries [m²], shape (S, v, T)."""
        d = self.weighted.shape[-2]
        covariance = symmetric.inverse(self.precision, d)
        return symmetric.times_vector(covariance, self.weighted), covariance


def oriented_means(profile: Profile, scenes: Scenes) -> Array:
    """Where each frame's Gaussian stands in the world [m], shape (S, J, d, T)."""
    return np.asarray(scenes.rotations @ np.swapaxes(profile.mean, 1, 2) + scenes.positions[..., None])


def oriented_information(profile: Profile, scenes: Scenes, frame: int) -> Information:
    """A frame's Gaussians brought to the world: A mu + b and A Sigma A' (paper, eq. 11)."""
    d = profile.mean.shape[-1]
    local_precision = symmetric.inverse(symmetric.pack(profile.covariance[frame]), d)
    local_weighted = symmetric.times_vector(local_precision, profile.mean[frame].T)
    rotations = scenes.rotations[:, frame]
    precision = symmetric.rotation_map(rotations) @ local_precision
    shift = symmetric.times_vector(precision, scenes.positions[:, frame, :, None])
    return Information(precision, rotations @ local_weighted + shift)


def ring_information(profile: Profile, scenes: Scenes, frame: int, directions: Array) -> Information:
    """A ring's stand-in: its radius in the given direction, covariance sigma² I (paper, section 4.5)."""
    d = directions.shape[1]
    precision = 1.0 / profile.radius_variance[frame]
    centre = scenes.positions[:, frame, :, None] + profile.radius[frame] * directions
    identity = symmetric.pack(np.eye(d)[None])
    entries = np.broadcast_to(precision * identity, (len(scenes), *(precision * identity).shape))
    return Information(entries, precision * centre)
