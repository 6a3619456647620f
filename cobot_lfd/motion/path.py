"""A smooth joint path: where the joints go, without when."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline

from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.motion.smoothing import fit_spline

SAME_WAYPOINT = 1e-7
"""Waypoints that lie closer together [rad] count as one: a spline through both would swing wildly."""


@dataclass(frozen=True, slots=True, eq=False)
class JointPath:
    """A smooth joint path ``p(s)`` for ``s`` from 0 to 1: where the joints go, without when.

    It is a B-spline whose derivatives up to the third are continuous, so that a smooth ``s(t)`` gives a
    motion with bounded jerk.

    Attributes:
        knots: Knots of the B-spline in the parameter s, shape (n_coefficients + degree + 1,).
        coefficients: Control points of the B-spline [rad], shape (n_coefficients, n).
        degree: Degree of the B-spline; 5, or less for paths of fewer than six waypoints.
    """

    knots: Array
    coefficients: Array
    degree: int

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(
            self, "coefficients", frozen_array(self.coefficients, "coefficients", (None, None))
        )
        n_knots = len(self.coefficients) + self.degree + 1
        object.__setattr__(self, "knots", frozen_array(self.knots, "knots", (n_knots,)))

    @classmethod
    def through(
        cls, waypoints: ArrayLike, *, parameters: ArrayLike | None = None, tolerance: float = 1e-4
    ) -> "JointPath":
        """The smoothest path that starts at the first waypoint, ends at the last and passes near the others.

        Waypoints that come from inverse
        kinematics carry its residual as noise; a path that follows 2e-4 rad of noise takes four times as
        long, because the noise bends it. ``tolerance`` says how much may be smoothed away.

        Waypoints should lie densely along the motion: a corner between few of them makes the path swing.

        Args:
            waypoints: Joint positions [rad], shape (M, n), M >= 1. Repeated waypoints count once.
            parameters: How far along the path each waypoint lies, in any unit, increasing, shape (M,).
                By default the distance between successive waypoints counts. Where they are even samples of a
                smooth motion (a demonstration, a learnt path), their numbers 0, 1, 2, ... are better: such a
                motion may turn back on itself by slowing down, and measured by distance the same turn is an
                edge, around which the arm takes many times as long.
            tolerance: Largest distance, joint by joint, between a waypoint and the path [rad]. With 0 the
                path passes through every waypoint; the first and the last it meets exactly in any case.

        Raises:
            ValueError: If ``waypoints`` is empty, has another shape or holds a number that is not finite,
                if ``parameters`` do not increase, or if ``tolerance`` is negative.
        """
        points = frozen_array(waypoints, "waypoints", (None, None))
        if not points.size:
            raise ValueError(f"waypoints has shape {points.shape}; a path needs at least one waypoint.")
        if not tolerance >= 0:
            raise ValueError(f"tolerance is {tolerance} rad; it must be 0 or positive.")
        given = None if parameters is None else _checked_parameters(parameters, len(points))
        kept = _without_repetitions(points)
        points = points[kept]
        if len(points) == 1:
            return cls(np.array([0.0, 1.0]), points, 0)
        u = _from_0_to_1(_distances(points) if given is None else given[kept])
        spline = fit_spline(u, points, tolerance)
        return cls(spline.t, spline.c, spline.k)

    @property
    def n_joints(self) -> int:
        """Number of joints."""
        return int(self.coefficients.shape[1])

    @property
    def is_constant(self) -> bool:
        """Whether the path stays where it is."""
        return not np.ptp(self.coefficients, axis=0).any()

    def __call__(self, s: ArrayLike, order: int = 0) -> Array:
        """The path, or its derivative of the given order (0 to 3) in s, at ``s``: [rad], shape (..., n)."""
        s = np.clip(np.asarray(s, dtype=np.float64), 0.0, 1.0)
        if order > self.degree:
            return np.zeros((*s.shape, self.n_joints))
        spline = BSpline.construct_fast(self.knots, self.coefficients, self.degree)
        return np.asarray(spline(s, nu=order), dtype=np.float64)


def _without_repetitions(points: Array) -> list[int]:
    """Which waypoints to keep: all but those that repeat their predecessor, and the last in any case."""
    kept = [0]
    for i in range(1, len(points)):
        if np.abs(points[i] - points[kept[-1]]).max() > SAME_WAYPOINT:
            kept.append(i)
    return kept if len(kept) == 1 else [*kept[:-1], len(points) - 1]


def _checked_parameters(parameters: ArrayLike, n: int) -> Array:
    parameters = frozen_array(parameters, "parameters", (n,))
    if (np.diff(parameters) <= 0).any():
        i = int(np.argmax(np.diff(parameters) <= 0))
        raise ValueError(
            f"parameters[{i + 1}] is {parameters[i + 1]}, after {parameters[i]}; they must strictly increase."
        )
    return parameters


def _distances(points: Array) -> Array:
    """Distance from the first waypoint, along the polygon through the others [rad], shape (M,)."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def _from_0_to_1(values: Array) -> Array:
    return np.asarray((values - values[0]) / (values[-1] - values[0]))
