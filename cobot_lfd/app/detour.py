"""Ways round what stands in the way: a generated path, bent most where the demonstrations leave it free."""

from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course.splines import even_basis, roughness_penalty
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.obstacle import Obstacle

_CLEARANCES = (0.05, 0.075)  # [m] between the middle of the tool and a thing's circle, the narrow one first
_MOST_THINGS = 3  # in the way at once; each can be passed on two sides
_N_FUNCTIONS = 20  # of the spline by which a path is bent
_HELD = 3  # spline functions at each end that stay zero: place, direction and bend of the path's ends
_ROUGHNESS = 1e-5  # weight of the detour's squared jerk against its squared size, in the least variance
_FARTHEST = 0.4  # [m] that a coefficient of the bending spline may reach
_SLACK = 1e-4  # [m] by which a found detour may come closer than asked for


class _Disc(NamedTuple):
    """A circle that the path must not enter: its middle, shape (2,), and its radius [m]."""

    centre: Array
    radius: float


def detours(path: GeneratedPath, things: Sequence[Obstacle]) -> Iterator[Array]:
    """Paths that pass the things that a path comes too close to, the least bent first.

    A detour d minimises the mean of d' inv(C) d, C being the path's covariance, plus a penalty on its jerk,
    and keeps the path outside of a circle round each thing. The ends of the path stay as they are. Each
    side of a thing is tried, for a narrow clearance first.

    Args:
        path: Where the tool would go.
        things: What is passed at a distance, whatever its height; what the path ends in is none of them.

    Yields:
        Positions [m], shape (T, 2).
    """
    for clearance in _CLEARANCES:
        discs = [_disc(thing, clearance, path.mean) for thing in things]
        blocking = [i for i, disc in enumerate(discs) if _gaps(path.mean, disc).min() < 0]
        if not 0 < len(blocking) <= _MOST_THINGS:
            continue
        found = []
        for sides in product((1.0, -1.0), repeat=len(blocking)):
            start = sum(_bump(path.mean, discs[i], side) for i, side in zip(blocking, sides, strict=True))
            found.append(_bent(path, discs, np.asarray(start)))
        yield from (bent for _, bent in sorted((f for f in found if f is not None), key=lambda f: f[0]))


def _disc(thing: Obstacle, clearance: float, path: Array) -> _Disc:
    """The circle round a thing, as large as the path's ends, which cannot give way, allow."""
    corners = np.abs(thing.centres[:, :2]) + thing.half_sizes[:, :2]
    centre = thing.pose.position[:2]
    wanted = float(np.linalg.norm(corners, axis=1).max()) + clearance
    return _Disc(centre, min(wanted, *np.linalg.norm(path[[0, -1]] - centre, axis=1)))


def _gaps(path: Array, disc: _Disc) -> Array:
    """How far each point is outside of a circle [m], shape (T,)."""
    return np.asarray(np.linalg.norm(path - disc.centre, axis=1) - disc.radius)


def _basis(n_steps: int) -> Array:
    """The spline functions of a detour over time, shape (T, B)."""
    return even_basis(_N_FUNCTIONS, n_steps)[:, _HELD:-_HELD]


def _bump(path: Array, disc: _Disc, side: float) -> Array:
    """A first guess, as coefficients (B, 2): out of the circle, to the left of the path or to its right."""
    nearest = int(_gaps(path, disc).argmin())
    ahead = np.gradient(path, axis=0)[nearest]
    left = np.array([-ahead[1], ahead[0]]) / max(float(np.linalg.norm(ahead)), 1e-12)
    offset = float(left @ (path[nearest] - disc.centre))
    height = side * disc.radius - offset
    inside = np.abs(np.linalg.norm(path - path[nearest], axis=1)) < disc.radius
    wanted = np.where(inside, height, 0.0)[:, None] * left
    return np.asarray(np.linalg.lstsq(_basis(len(path)), wanted, rcond=None)[0])


def _bent(path: GeneratedPath, discs: Sequence[_Disc], start: Array) -> tuple[float, Array] | None:
    """The least detour near a first guess with its cost, or None if there is none."""
    basis = _basis(len(path.mean))
    precision = np.linalg.inv(path.covariance) / len(path.mean)
    rough = roughness_penalty(_N_FUNCTIONS, 3)[_HELD:-_HELD, _HELD:-_HELD]
    rough = rough * _ROUGHNESS / float(np.trace(path.covariance, axis1=1, axis2=2).max() / 2)

    def cost(flat: Array) -> tuple[float, Array]:
        c = flat.reshape(-1, 2)
        pull = (precision @ (basis @ c)[..., None])[..., 0]
        slope = basis.T @ pull + rough @ c
        return float((c * slope).sum()), 2 * slope.ravel()

    def gaps(flat: Array) -> Array:
        bent = path.mean + basis @ flat.reshape(-1, 2)
        return np.concatenate([_gaps(bent, disc) for disc in discs])

    def gap_slopes(flat: Array) -> Array:
        bent = path.mean + basis @ flat.reshape(-1, 2)
        away = np.concatenate([bent - disc.centre for disc in discs])
        away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12)
        rows = np.tile(basis, (len(discs), 1))
        return np.asarray((rows[:, :, None] * away[:, None, :]).reshape(len(rows), -1))

    solution = minimize(
        cost,
        np.clip(start.ravel(), -_FARTHEST, _FARTHEST),
        jac=True,
        method="SLSQP",
        bounds=[(-_FARTHEST, _FARTHEST)] * start.size,
        constraints={"type": "ineq", "fun": gaps, "jac": gap_slopes},
    )
    if not solution.success or gaps(solution.x).min() < -_SLACK:
        return None
    return float(solution.fun), path.mean + basis @ solution.x.reshape(-1, 2)
