"""Responsibilities shared between demonstrations: a Gaussian describes all of them (paper, section 4.2)."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from scipy.ndimage import convolve1d

from cobot_lfd.arrays import Array


class SharedQuantity(Enum):
    """What the paper's "likelihood" l of eq. (12) is taken to be."""

    RESPONSIBILITY = "responsibility"
    DENSITY = "density"
    LOG_DENSITY = "log-density"


@dataclass(frozen=True, slots=True)
class Sharing:
    """How far the demonstrations' responsibilities are drawn together.

    Attributes:
        strength: gamma of eq. (15): 0 leaves each demonstration alone, 1 gives all the same.
        half_width: S of eq. (13): how many steps of time the average reaches to each side.
        quantity: The reading of "likelihood" in eq. (12).
    """

    strength: float = 0.5
    half_width: int = 10
    quantity: SharedQuantity = SharedQuantity.RESPONSIBILITY

    def __post_init__(self) -> None:
        """Check."""
        if not 0 <= self.strength <= 1:
            raise ValueError(f"strength is {self.strength}; it must lie in 0..1.")
        if self.half_width < 0:
            raise ValueError(f"half_width is {self.half_width}; it must be at least 0.")


def share(log_joint: Array, n_demonstrations: int, sharing: Sharing) -> Array:
    """Responsibilities after the exchange between demonstrations, shape (N T, K) (paper, eqs. 12-15).

    Two corrections to the paper: the average is divided by the mass of the kernel inside the path, where the
    paper pads with zeros and the ends fade; and eq. (15) is read as l + gamma (L - l), as its own text says.

    Args:
        log_joint: Logarithm of weight times density of each point and component, shape (N T, K).
        n_demonstrations: N.
        sharing: The settings.
    """
    values = log_joint.reshape(n_demonstrations, -1, log_joint.shape[1])
    peak = values.max(axis=2, keepdims=True)
    match sharing.quantity:
        case SharedQuantity.RESPONSIBILITY:
            values = np.exp(values - peak)
            values = values / values.sum(axis=2, keepdims=True)
        case SharedQuantity.DENSITY:
            values = np.exp(values - values.max())
        case SharedQuantity.LOG_DENSITY:
            pass
    average = smooth_over_time(values.mean(axis=0), sharing.half_width)
    values = values + sharing.strength * (average - values)
    if sharing.quantity is SharedQuantity.LOG_DENSITY:
        values = np.exp(values - values.max(axis=2, keepdims=True))
    total = values.sum(axis=2, keepdims=True)
    # Densities of a far outlier can all underflow; it then belongs to all components alike.
    values = np.where(total > 0, values / np.where(total > 0, total, 1.0), 1.0 / values.shape[2])
    return values.reshape(log_joint.shape)


def smooth_over_time(values: Array, half_width: int) -> Array:
    """Weighted average over neighbouring steps with a triangular kernel, shape (T, K) (paper, eqs. 13-14)."""
    if half_width == 0:
        return values
    kernel = 1.0 - np.abs(np.arange(-half_width, half_width + 1)) / (half_width + 1)
    mass = convolve1d(np.ones(len(values)), kernel, mode="constant")
    return np.asarray(convolve1d(values, kernel, axis=0, mode="constant") / mass[:, None])
