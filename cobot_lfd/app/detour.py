"""Ways round what a path would hit: the path, bent most where the demonstrations leave it free."""

from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple, Protocol

import numpy as np
from scipy.optimize import minimize

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course.splines import even_basis, roughness_penalty
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.obstacle import Obstacle

_CLEARANCES = (0.05, 0.075)  # [m] between the middle of the tool and a thing's circle, the narrow one first
_WALL_CLEARANCES = (0.025, 0.035, 0.05)  # [m] between the middle of the tool and a wall, as seen from above
_LEEWAY = 0.002  # [m] that a path may stray in a way in as wide as it needs
_MOST_THINGS = 3  # in the way at once; each can be passed on two sides
_N_FUNCTIONS = 20  # of the spline by which a path is bent
_HELD = 3  # spline functions at each end that stay zero: place, direction and bend of the path's ends
_ROUGHNESS = 1e-5  # weight of the detour's squared jerk against its squared size, in the least variance
_FARTHEST = 0.4  # [m] that a coefficient of the bending spline may reach
_SLACK = 1e-4  # [m] by which a found detour may come closer than asked for


class _Region(Protocol):
    """Where the path must not be, as seen from above."""

    def gaps(self, path: Array) -> Array:
        """How far each point is outside [m], shape (T,)."""
        ...

    def away(self, path: Array) -> Array:
        """From each point the direction that leads away fastest, unit vectors, shape (T, 2)."""
        ...


class _Disc(NamedTuple):
    """A circle that the path must not enter: its middle, shape (2,), and its radius [m]."""

    centre: Array
    radius: float

    def gaps(self, path: Array) -> Array:
        return np.asarray(np.linalg.norm(path - self.centre, axis=1) - self.radius)

    def away(self, path: Array) -> Array:
        away = path - self.centre
        return np.asarray(away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12))


class _Wall(NamedTuple):
    """A rectangle from which the path must keep a distance.

    Attributes:
        centre: Its middle [m], shape (2,).
        axes: The directions of its sides, as columns, shape (2, 2).
        half_size: Half its extent along them [m], shape (2,).
        clearance: The distance [m].
    """

    centre: Array
    axes: Array
    half_size: Array
    clearance: float

    def gaps(self, path: Array) -> Array:
        beyond = np.abs((path - self.centre) @ self.axes) - self.half_size
        outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
        return np.asarray(outside + np.minimum(beyond.max(axis=1), 0.0) - self.clearance)

    def away(self, path: Array) -> Array:
        local = (path - self.centre) @ self.axes
        beyond = np.abs(local) - self.half_size
        inside = (beyond <= 0.0).all(axis=1, keepdims=True)
        nearest = beyond == beyond.max(axis=1, keepdims=True)
        away = np.where(inside, nearest, np.maximum(beyond, 0.0)) * np.where(local < 0.0, -1.0, 1.0)
        return np.asarray(away / np.linalg.norm(away, axis=1, keepdims=True) @ self.axes.T)


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
        blocking = [i for i, disc in enumerate(discs) if disc.gaps(path.mean).min() < 0]
        if not 0 < len(blocking) <= _MOST_THINGS:
            continue
        found = []
        for sides in product((1.0, -1.0), repeat=len(blocking)):
            start = sum(_bump(path.mean, discs[i], side) for i, side in zip(blocking, sides, strict=True))
            found.append(_bent(path, discs, np.asarray(start)))
        yield from (bent for _, bent in sorted((f for f in found if f is not None), key=lambda f: f[0]))


def past_walls(path: GeneratedPath, goal: Obstacle, things: Sequence[Obstacle]) -> Iterator[Array]:
    """Paths that keep farther from the walls of what they end in, with little clearance first.

    A path that was generated for a place far from those of the demonstrations may cut the corner of a way
    in. It stays on the side of each wall on which it is, and the ends stay as they are.

    Args:
        path: Where the tool would go.
        goal: What the path ends in, its walls alone.
        things: What is passed at a distance.

    Yields:
        Positions [m], shape (T, 2).
    """
    aside = [_disc(thing, _CLEARANCES[0], path.mean) for thing in things]
    for clearance in _WALL_CLEARANCES:
        walls = _walls(goal, clearance, path.mean)
        if any(wall.gaps(path.mean).min() < 0 for wall in walls):
            found = _bent(path, [*walls, *aside], np.zeros((_N_FUNCTIONS - 2 * _HELD, 2)))
            if found is not None:
                yield found[1]


def _walls(goal: Obstacle, clearance: float, path: Array) -> list[_Wall]:
    """The rectangles of a thing's boxes, with as much clearance as the path's ends, which stay, allow."""
    axes = goal.pose.rotation[:2, :2]
    walls = []
    for centre, half_size in zip(goal.centres[:, :2], goal.half_sizes[:, :2], strict=True):
        touching = _Wall(goal.pose.position[:2] + axes @ centre, axes, half_size, 0.0)
        allowed = float(touching.gaps(path[[0, -1]]).min())
        if allowed > 0:  # Else the path ends above it: it is a floor.
            walls.append(touching._replace(clearance=min(clearance, max(allowed - _LEEWAY, 0.0))))
    return walls


def _disc(thing: Obstacle, clearance: float, path: Array) -> _Disc:
    """The circle round a thing, as large as the path's ends, which cannot give way, allow."""
    corners = np.abs(thing.centres[:, :2]) + thing.half_sizes[:, :2]
    centre = thing.pose.position[:2]
    wanted = float(np.linalg.norm(corners, axis=1).max()) + clearance
    return _Disc(centre, min(wanted, *np.linalg.norm(path[[0, -1]] - centre, axis=1)))


def _basis(n_steps: int) -> Array:
    """The spline functions of a detour over time, shape (T, B)."""
    return even_basis(_N_FUNCTIONS, n_steps)[:, _HELD:-_HELD]


def _bump(path: Array, disc: _Disc, side: float) -> Array:
    """A first guess, as coefficients (B, 2): out of the circle, to the left of the path or to its right."""
    nearest = int(disc.gaps(path).argmin())
    ahead = np.gradient(path, axis=0)[nearest]
    left = np.array([-ahead[1], ahead[0]]) / max(float(np.linalg.norm(ahead)), 1e-12)
    offset = float(left @ (path[nearest] - disc.centre))
    height = side * disc.radius - offset
    inside = np.abs(np.linalg.norm(path - path[nearest], axis=1)) < disc.radius
    wanted = np.where(inside, height, 0.0)[:, None] * left
    return np.asarray(np.linalg.lstsq(_basis(len(path)), wanted, rcond=None)[0])


def _bent(path: GeneratedPath, regions: Sequence[_Region], start: Array) -> tuple[float, Array] | None:
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
        return np.concatenate([region.gaps(bent) for region in regions])

    def gap_slopes(flat: Array) -> Array:
        bent = path.mean + basis @ flat.reshape(-1, 2)
        away = np.concatenate([region.away(bent) for region in regions])
        rows = np.tile(basis, (len(regions), 1))
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
