"""The linear program behind the near-optimal timing: the fastest warp near a given one.

Velocity and acceleration limits are linear in c and its derivatives. The jerk limit is

    |q''' c + 3/2 q'' c' + 1/2 q' c''| <= J / sqrt(c).

Its right side is convex in c, so its tangent at any c0, ``J (3 c0 - c) / (2 c0^(3/2))``, lies below it:
with the tangent in its place the limit is linear, and kept. The time, the integral of ``1 / sqrt(c)``, is
replaced by its tangent as well, which makes the objective ``max integral c / c0^(3/2)``.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_array, diags_array, vstack

from cobot_lfd.arrays import Array
from cobot_lfd.errors import MotionError
from cobot_lfd.motion.limits import JointLimits
from cobot_lfd.motion.path import JointPath
from cobot_lfd.motion.splines import spline_matrix
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.timing_stretch import joint_derivatives
from cobot_lfd.motion.timing_warp import DEGREE, Warp, full_knots, gauss_points

CHECKS = np.array([1e-6, 1 / 3, 2 / 3, 1 - 1e-6])
"""Where limits are kept between two breaks. The jerk steps at breaks: both sides of each are among them."""

SLOWEST = 1e-6
"""Smallest c / c0, which keeps c positive."""

SquaredRate = Callable[[Array], Array]


def fastest_warp(
    path: JointPath,
    limits: JointLimits,
    base: TimeLaw,
    breaks: Array,
    c0: SquaredRate,
    *,
    jerk: bool,
    most: float,
) -> Warp:
    """The warp that takes the least time, to first order, within limits that are kept at the check points.

    Args:
        path: Where the joints go.
        limits: What the joints can do.
        base: The law to warp.
        breaks: Breaks of the warp.
        c0: The squared rate to linearise at.
        jerk: Whether to keep the jerk limits.
        most: Largest c / c0; a warp with jerk limits gains no more than the factor 3 at once.

    Raises:
        MotionError: If HiGHS finds no solution; the message says why.
    """
    knots = full_knots(breaks)
    middles = np.array([knots[i + 1 : i + DEGREE + 1].mean() for i in range(len(knots) - DEGREE - 1)])
    scale = c0(middles)
    rows = _constraints(path, limits, base, breaks, c0, jerk=jerk) @ diags_array(scale)
    binding = rows[rows.maximum(0).sum(axis=1) * most > 1.0]
    nodes, weights = gauss_points(breaks, 4)
    gain = scale * (spline_matrix(nodes, knots, DEGREE).T @ (weights * c0(nodes) ** -1.5))
    solution = linprog(
        -gain / gain.max(),
        A_ub=binding,
        b_ub=np.ones(binding.shape[0]),
        bounds=(SLOWEST, most),
        method="highs-ds",
    )
    if solution.x is None:
        raise MotionError(
            f"the linear program of the near-optimal timing has no solution: {solution.message}"
        )
    return Warp(base, breaks, scale * solution.x)


def _constraints(
    path: JointPath, limits: JointLimits, base: TimeLaw, breaks: Array, c0: SquaredRate, *, jerk: bool
) -> csr_array:
    """The limits as rows of ``rows @ coefficients <= 1``."""
    tau = (breaks[:-1, None] + np.diff(breaks)[:, None] * CHECKS).ravel()
    q1, q2, q3 = joint_derivatives(path, *(base(tau, order) for order in range(4)))
    c, c1, c2 = (spline_matrix(tau, full_knots(breaks), DEGREE, order) for order in range(3))
    here = c0(tau)
    blocks = [_times((q1**2 / limits.velocity**2).max(axis=1), c)]
    for joint in range(limits.n_joints):
        a, b, d = q1[:, joint], q2[:, joint], q3[:, joint]
        acceleration = (_times(b, c) + _times(a / 2, c1)) / limits.acceleration[joint]
        blocks += [acceleration, -acceleration]
        if jerk:
            at_rate = _times(d, c) + _times(1.5 * b, c1) + _times(a / 2, c2)
            share = _times(np.sqrt(here) / (1.5 * limits.jerk[joint]), at_rate)
            tangent = _times(1 / (3 * here), c)
            blocks += [share + tangent, tangent - share]
    return csr_array(vstack(blocks))


def _times(factors: Array, matrix: csr_array) -> csr_array:
    """The matrix with each row multiplied by its factor."""
    return csr_array(diags_array(factors) @ matrix)
