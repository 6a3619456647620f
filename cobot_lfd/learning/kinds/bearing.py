"""Does the path depend on a frame's direction? A likelihood ratio of bearings.

At each time the direction in which the path lies, seen from the frame and in the frame's own axes, is
predicted for each demonstration from the others. If the task depends on the frame's direction, that
prediction beats two rivals that need no direction of the frame: a direction uniform on the sphere (the
circle, for d = 2), and the direction relative to the line of sight to another frame. The gain in
log-likelihood, summed over the demonstrations, median over a short window and maximum over time, is the
evidence in nats.

The predictions are Student's t of the angle to the others' mean direction, with a share of uniform outliers,
written with scalar products only, so that one implementation serves two and three dimensions.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter
from scipy.special import gammaln

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import TaskData


@dataclass(frozen=True, slots=True)
class BearingTest:
    """Settings of the likelihood ratio.

    Attributes:
        prior_spread: Spread of bearings that is expected where the frame matters [rad].
        prior_strength: How many demonstrations that expectation is worth.
        outliers: Share of demonstrations that may disagree.
        window: Part of the path over which the evidence must last.
        margin: Evidence above which the frame is called oriented [nat per demonstration].
        doubt: Evidence must lie this far from the margin to be called certain [nat per demonstration].
        nearest: Bearings of points closer to the frame than this part of the path's size say nothing.
        looks: Normalised times at which the usual place of the path in another frame's axes is looked at.
    """

    prior_spread: float = np.radians(4.0)
    prior_strength: float = 2.0
    outliers: float = 0.05
    window: float = 0.06
    margin: float = 0.45
    doubt: float = 0.2
    nearest: float = 0.06
    looks: tuple[float, ...] = (0.25, 0.5, 0.75)


def bearing_evidence(data: TaskData, test: BearingTest) -> Array:
    """Evidence in nats that each frame is oriented, over time, shape (J, T)."""
    directions, seen = _directions(data, test)
    own = np.einsum("njtd,njde->njte", directions, data.scenes.rotations)
    n_frames = len(data.names)
    evidence = np.empty((n_frames, len(data.times)))
    for frame in range(n_frames):
        weight = seen[:, frame]
        rivals = [np.full(len(data.times), -_log_sphere(own.shape[-1])) * weight.sum(axis=0)]
        for other in range(n_frames):
            if other != frame:
                for target in _targets(data, other, test):
                    axes = _sight_axes(target - data.scenes.positions[:, frame])
                    relative = np.einsum("ntd,nde->nte", directions[:, frame], axes)
                    rivals.append(_held_out(relative, weight, test).sum(axis=0))
        gain = _held_out(own[:, frame], weight, test).sum(axis=0) - np.max(rivals, axis=0)
        # A few demonstrations agree by chance: a time speaks for a direction only where all can tell.
        gain = np.where(weight.all(axis=0), gain, np.minimum(gain, 0.0))
        evidence[frame] = _lasting(gain, test.window)
    return evidence


def _directions(data: TaskData, test: BearingTest) -> tuple[Array, Array]:
    """Unit vectors from each frame to the path in the world, shape (N, J, T, d), and which of them count."""
    offsets = data.paths[:, None] - data.scenes.positions[:, :, None]
    distance = np.linalg.norm(offsets, axis=-1)
    seen = distance > test.nearest * max(data.scale, 1e-12)
    return offsets / np.where(seen, distance, 1.0)[..., None], seen.astype(np.float64)


def _targets(data: TaskData, frame: int, test: BearingTest) -> list[Array]:
    """What may be looked at, each (N, d): a frame's origin, and where the path usually is in its axes."""
    usual = data.local[:, frame].mean(axis=0)
    steps = [round(time * (len(data.times) - 1)) for time in test.looks]
    positions, rotations = data.scenes.positions[:, frame], data.scenes.rotations[:, frame]
    return [positions, *(positions + rotations @ usual[step] for step in steps)]


def _sight_axes(sight: Array) -> Array:
    """Axes with a line of sight first, as columns: (N, d) -> (N, d, d).

    In the plane the second axis is square to it; in space it is horizontal (the third world axis is up).
    """
    d = sight.shape[1]
    first = sight / np.maximum(np.linalg.norm(sight, axis=1, keepdims=True), 1e-12)
    if d == 2:
        return np.stack([first, np.stack([-first[:, 1], first[:, 0]], axis=1)], axis=2)
    side = np.cross(np.array([0.0, 0.0, 1.0]), first)
    side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-12)
    return np.stack([first, side, np.cross(first, side)], axis=2)


def _held_out(directions: Array, weight: Array, test: BearingTest) -> Array:
    """Log density of each demonstration's direction, predicted from the others, shape (N, T).

    The centre is the others' mean direction; the deviation follows Student's t on the sphere's tangent with a
    prior on its scale, mixed with a share of uniform outliers.
    """
    n, _, d = directions.shape
    total = (weight[..., None] * directions).sum(axis=0)
    others = np.maximum(weight.sum(axis=0) - weight, 0.0)
    out = np.empty(weight.shape)
    for held in range(n):
        mean = total - weight[held][:, None] * directions[held]
        length = np.linalg.norm(mean, axis=1)
        centre = mean / np.maximum(length, 1e-12)[:, None]
        angles = np.arccos(np.clip(np.einsum("ntd,td->nt", directions, centre), -1.0, 1.0))
        squares = ((weight * angles**2).sum(axis=0) - weight[held] * angles[held] ** 2) / (d - 1)
        freedom = test.prior_strength + np.maximum(others[held] - 1.0, 0.0)
        variance = (test.prior_strength * test.prior_spread**2 + squares) / freedom
        variance = variance * (1.0 + 1.0 / np.maximum(others[held], 1.0))
        inlier = _log_student(angles[held], variance, freedom, d - 1) + np.log1p(-test.outliers)
        density = np.logaddexp(inlier, np.log(test.outliers) - _log_sphere(d))
        out[held] = np.where(others[held] > 0, density, -_log_sphere(d)) * weight[held]
    return out


def _log_student(angle: Array, variance: Array, freedom: Array, dimension: int) -> Array:
    """Log density of Student's t in the given dimension at a distance from its centre."""
    constant = gammaln((freedom + dimension) / 2) - gammaln(freedom / 2)
    constant = constant - dimension / 2 * np.log(freedom * np.pi * variance)
    return np.asarray(constant - (freedom + dimension) / 2 * np.log1p(angle**2 / (freedom * variance)))


def _log_sphere(d: int) -> float:
    """Logarithm of the circumference of the unit circle (d = 2) or of the area of the unit sphere (d = 3)."""
    return float(np.log(2.0) + d / 2 * np.log(np.pi) - gammaln(d / 2))


def _lasting(evidence: Array, window: float) -> Array:
    """Median over a window that is given as a part of the path."""
    return np.asarray(median_filter(evidence, size=2 * round(window * len(evidence) / 2) + 1, mode="nearest"))
