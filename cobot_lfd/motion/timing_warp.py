"""A faster time law from a slower one, by warping its time.

Let a base law lead along the path, and call its time ``tau``. Played at the rate ``dtau/dt = sqrt(c(tau))``
it is another law. In the square ``c`` of the rate, joint velocity, acceleration and jerk are, with ``q(tau)``
the joint positions under the base law and ' its derivative,

    q' sqrt(c),   q'' c + q' c' / 2,   (q''' c + 3/2 q'' c' + 1/2 q' c'') sqrt(c).

It is the well-known substitution b(s) = s'^2, with one gain: a rest in b is a singular point (b grows like
s^(4/3)), while the base law brings its rests along and leaves c positive and smooth.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline

from cobot_lfd.arrays import Array
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.time_law_fit import connect_states

DEGREE = 2
"""Degree of the spline c. The fastest law has steps in its jerk, so c'' should be free to step."""


@dataclass(frozen=True, slots=True, eq=False)
class Warp:
    """A base law and the squared rate at which it is played.

    Attributes:
        base: The base law.
        breaks: Places between which c is a parabola: from 0 to the base law's duration, shape (K + 1,).
        coefficients: B-spline coefficients of c, shape (K + 2,).
    """

    base: TimeLaw
    breaks: Array
    coefficients: Array

    def squared_rate(self, tau: Array, order: int = 0) -> Array:
        """The squared rate c, or its derivative of the given order, at ``tau``."""
        return np.asarray(BSpline(full_knots(self.breaks), self.coefficients, DEGREE)(tau, nu=order))

    def durations(self) -> Array:
        """Time that it takes from break to break [s]: the integral of ``1 / sqrt(c)``, shape (K,)."""
        nodes, weights = gauss_points(self.breaks, 8)
        return np.asarray((weights / np.sqrt(self.squared_rate(nodes))).reshape(-1, 8).sum(axis=1))

    def law(self) -> TimeLaw:
        """The warped law: it meets s, s', s'' at the breaks and the durations between them."""
        f, f1, f2 = (self.base(self.breaks, order) for order in range(3))
        c, c1 = self.squared_rate(self.breaks), self.squared_rate(self.breaks, 1)
        states = np.column_stack([f, f1 * np.sqrt(c), f2 * c + f1 * c1 / 2])
        states[[0, -1]] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
        return connect_states(self.durations(), states)


def full_knots(breaks: Array) -> Array:
    """The knots of c: the breaks, with the first and the last repeated."""
    return np.concatenate([[breaks[0]] * DEGREE, breaks, [breaks[-1]] * DEGREE])


def gauss_points(breaks: Array, n: int) -> tuple[Array, Array]:
    """Nodes and weights of Gauss's rule with ``n`` nodes between any two breaks, each of shape (K n,)."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    half = np.diff(breaks)[:, None] / 2
    return (breaks[:-1, None] + half * (1 + nodes)).ravel(), (half * weights).ravel()
