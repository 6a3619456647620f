"""The paper's test for an oriented frame: a narrow Gaussian that stretches along the path (section 4.2)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.learning.mixtures.mixture import Mixture


@dataclass(frozen=True, slots=True)
class Criteria:
    """Thresholds of the paper's two criteria.

    Attributes:
        narrowness: Smallest ratio of the two greatest eigenvalues (variances) of a Gaussian.
        angle: Greatest angle between its long axis and the direction in which time grows [rad].
    """

    narrowness: float = 10.0
    angle: float = 0.1


def fulfilled(mixture: Mixture, criteria: Criteria) -> NDArray[np.bool_]:
    """Which Gaussians fulfil both criteria, shape (K, J); one suffices for its frame to be oriented."""
    values, vectors = np.linalg.eigh(mixture.covariances[..., 1:, 1:])
    narrow = values[..., -1] > criteria.narrowness * values[..., -2]
    flow = mixture.covariances[..., 1:, 0]
    cosine = np.abs((vectors[..., -1] * flow).sum(axis=-1))
    along = cosine >= np.cos(criteria.angle) * np.linalg.norm(flow, axis=-1)
    return np.asarray(narrow & along & (np.linalg.norm(flow, axis=-1) > 0))
