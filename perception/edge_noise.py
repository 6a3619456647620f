"""How far measured edges may be off, and how the errors of neighbouring points hang together.

A picture whose pixels are sampled at points has stairs along its edges, and a stair as long as the edge does
not average out. Sampling repeats the spectrum of the scene at all points K of the reciprocal grid (whole
numbers). The spectrum of an edge with normal n lies on a line along n, where it falls as 1 / (2 pi |s|); what
is repeated around K disturbs an edge's place, measured by adding up across it, as a wave along the edge of
frequency K.t (t along the edge) and variance ``1 / (2 pi^2 (K.n)^2)``, less what interpolation and blur take.
For an edge along the grid that is the familiar sawtooth, of variance 1/12 px^2; edges near 45 degrees have
long waves, too. With unknown phases the errors at two points a distance d apart have the covariance
``sum over K of variance(K) cos(2 pi K.t d)``. A pixel that averages over its area has no such stairs, and
shows it by mixed colours on the edge.
"""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from perception.silhouette import Contour

_MIXED_WITHOUT_STAIRS = 2 / 3  # Mean of 4 a (1 - a) over an edge, where the covered share a is evenly spread.
_MIXED_BY_BLUR = 0.1  # Excess of that mean from which on a blur hides what the renderer did.
_LEAST_NOISE = 0.01  # What light, rounding and the lens leave at the least [px].
_SPREAD = 3.0  # Number of points over which one pixel's noise is spread.
_REACH = 12  # Of the reciprocal grid; beyond, waves are weak.
_FEW = 2.0  # Stairs along an edge.
_TURN = 0.6  # Waves along an edge that turn it most.
_SHORTEST = 2.0  # Waves shorter than that [px] count as noise,
_SHORT_WAVES = 0.006  # of this variance [px²]: so much is missing in the sum, and hangs together less.
_ALL_WAVES = 0.05  # Variance of short and long ones together [px²]; 0.045 to 0.083, by simulation.
_WEAKEST = 4e-4  # Variance below which a wave does not count [px²].
_GRID = np.array([(i, j) for i in range(_REACH + 1) for j in range(-_REACH, _REACH + 1) if (i, j) > (0, 0)])
"""Half of the reciprocal grid's points, shape (k, 2); the others are their opposites."""


@dataclass(frozen=True, slots=True)
class EdgeNoise:
    """What makes edges in a picture uncertain.

    Attributes:
        stairs: How much of the stairs of a picture sampled at points they have [0..1].
        variance: Of their distances from the outline [px²].
        bias: How far light and shadow may displace an edge as a whole [px].
    """

    stairs: float
    variance: float
    bias: float

    @classmethod
    def seen_in(cls, mixed: Array, variance: float, bias: float) -> "EdgeNoise":
        """From how the pixels on the edges look.

        Where a pixel averages n points across the edge, the mean of ``4 a (1 - a)`` is ``2/3 (1 - 1/n²)``,
        and the stairs' variance is 1/n² of that of one point. A blurred edge mixes more than that; since a
        blur that comes after sampling leaves the long stairs and nothing shows them, they are then taken to
        be there.

        Args:
            mixed: Share a of the object in the pixel nearest to each point of the contour, shape (n,).
            variance: Of the edges' distances from the outline [px²].
            bias: How far light and shadow may displace an edge as a whole [px].
        """
        mixing = float(np.mean(4 * np.clip(mixed, 0.0, 1.0) * (1 - np.clip(mixed, 0.0, 1.0))))
        blurred = float(np.clip((mixing - _MIXED_WITHOUT_STAIRS) / _MIXED_BY_BLUR, 0.0, 1.0))
        return cls(max(blurred, 1.0 - mixing / _MIXED_WITHOUT_STAIRS), variance, bias)


def weighted_step(
    contour: Contour, jacobian: Array, offsets: Array, noise: EdgeNoise, ridge: Array
) -> tuple[Array, Array]:
    """Least squares that knows how errors hang together: the unknowns, shape (m,), and their covariance.

    With weights W from errors as they would be if their waves were known, the step is ``A r`` with
    ``A = (J' W J)^-1 J' W``; errors of covariance R then make it uncertain by ``A R A'``.

    Args:
        contour: Where the edges were measured, n points.
        jacobian: How they depend on the unknowns, shape (n, m).
        offsets: What was measured [px], shape (n,).
        noise: What makes the edges uncertain.
        ridge: What is known of the unknowns before, as information, shape (m, m).
    """
    information, spread, pull = ridge.copy(), np.zeros_like(ridge), np.zeros(len(ridge))
    for edge in np.unique(contour.edges):
        mine = contour.edges == edge
        R, turned = _covariance(contour.pixels[mine], contour.normals[mine][0], noise)
        weighted = np.linalg.solve(R, jacobian[mine])
        information += weighted.T @ jacobian[mine]
        spread += weighted.T @ turned @ weighted
        pull += weighted.T @ offsets[mine]
    inverse = np.linalg.inv(information)
    return inverse @ pull, np.asarray(inverse @ (spread + ridge) @ inverse, np.float64)


def _covariance(pixels: Array, normal: Array, noise: EdgeNoise) -> tuple[Array, Array]:
    """Covariance of the errors along one edge [px²], shape (k, k), and what it is where stairs are few.

    Few stairs on an edge tell neither their length nor, therefore, its direction: half of what they may do
    is to displace it as a whole, half is to turn it.
    """
    variances, frequencies = stair_waves(normal)
    variances = noise.stairs * variances
    distance = np.linalg.norm(pixels - pixels[0], axis=1)
    length = float(distance[-1]) + 1.0
    rest = max(noise.variance - noise.stairs * _ALL_WAVES, 0.0)
    white = _SPREAD * rest + noise.stairs * _SHORT_WAVES + _LEAST_NOISE**2
    R = _of_waves(distance, variances, frequencies) + noise.bias**2 + white * np.eye(len(pixels))
    few = np.abs(frequencies) * length < _FEW
    half = 0.5 * variances[few]
    turn = _of_waves(distance, half.sum(keepdims=True), np.array([_TURN / length]))
    return R, R - _of_waves(distance, half, frequencies[few]) + turn


def _of_waves(distance: Array, variances: Array, frequencies: Array) -> Array:
    """Covariance of waves of unknown phase at places along an edge [px²], shape (k, k)."""
    waves = np.sqrt(variances) * np.exp(2j * np.pi * np.outer(distance, frequencies))
    both = waves.view(np.float64)  # Cosines and sines, side by side.
    return np.asarray(both @ both.T)


def stair_waves(normal: Array) -> tuple[Array, Array]:
    """The waves by which point sampling displaces an edge: variances [px²] and frequencies [1/px], (k,) each.

    Args:
        normal: Unit vector in the picture at right angles to the edge, shape (2,).
    """
    along = np.array([-normal[1], normal[0]])
    frequencies = _GRID @ along
    long = np.abs(frequencies) * _SHORTEST < 1.0
    across, frequencies = np.abs(_GRID[long] @ normal), frequencies[long]
    interpolated = (np.sinc(frequencies * along[0]) * np.sinc(frequencies * along[1])) ** 4
    variances = interpolated / (2 * np.pi**2 * np.maximum(across, 0.1) ** 2)
    strong = variances > _WEAKEST
    return variances[strong], frequencies[strong]
