"""Stiffness from covariance: where the learnt path is loose the arm may give way, where it is tight not."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.path import GeneratedPath


@dataclass(frozen=True, slots=True)
class Compliance:
    """How stiffness follows from covariance.

    The covariance of the generated path says how far the demonstrations strayed (paper, section 3.3); the
    force moves the tool by one standard deviation of theirs, in every direction.

    Attributes:
        force: That moves the tool by one standard deviation [N].
        softest: Least stiffness [N/m].
        stiffest: Largest stiffness [N/m].
    """

    force: float = 5.0
    softest: float = 200.0
    stiffest: float = 4000.0

    def stiffness(self, covariance: Array) -> Array:
        """Stiffnesses [N/m] for covariances [m²], both of shape (..., 2, 2)."""
        variances, axes = np.linalg.eigh(covariance)
        deviations = np.sqrt(np.maximum(variances, 1e-12))
        values = np.clip(self.force / deviations, self.softest, self.stiffest)
        return np.asarray((axes * values[..., None, :]) @ np.swapaxes(axes, -1, -2))


class StiffnessField:
    """The stiffness that belongs to a place beside a generated path: that of the path's nearest point."""

    def __init__(self, compliance: Compliance, path: GeneratedPath) -> None:
        self._places = path.mean
        self._stiffness = compliance.stiffness(path.covariance)

    def __call__(self, place: Array) -> Array:
        """Stiffness [N/m], shape (2, 2), at a place [m], shape (2,)."""
        return np.asarray(self._stiffness[((self._places - place) ** 2).sum(axis=1).argmin()])
