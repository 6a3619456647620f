"""Where along the task a point of a path lies, whatever the speed: its phase, from 0 to 1.

Timing differs between demonstrations, and a longer way between two frames shifts everything in time. What
comes back in every demonstration is tied to *places*: so many centimetres after leaving the first frame, so
many before arriving at the next. The phase therefore runs with the way travelled since the last landmark,
and then with the way left to the next one; what a demonstration's way is longer than the shortest one's is
spread over the middle: s(p) = p l_min + (l - l_min) h(p), with h from 0 to 1 and flat at both ends.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from cobot_lfd.arrays import Array

SMOOTHING = 0.02
"""Trembling is filtered out before a way is measured: standard deviation in units of the duration."""

STRIDE = 0.04
"""The way is measured in strides of this part of the path's extent, several times a hand's trembling."""

FINE = 400
"""Places at which the relation between way and phase is tabulated."""

LARGEST_STEP = 0.1
"""Largest correction of a demonstration's progress at once, as a share of the way."""


@dataclass(frozen=True, slots=True, eq=False)
class Phases:
    """The demonstrations told by phase, and how far along they are over time.

    Attributes:
        paths: Positions at equally spaced phases [m], shape (N, U, d).
        shares: Share of the way that each demonstration has done at each time of the grid, shape (N, T).
    """

    paths: Array
    shares: Array


def way_travelled(paths: Array) -> Array:
    """Length of the path up to each point [m], shape (..., T)."""
    steps = np.linalg.norm(np.diff(paths, axis=-2), axis=-1)
    return np.concatenate([np.zeros((*steps.shape[:-1], 1)), np.cumsum(steps, axis=-1)], axis=-1)


def way_despite_trembling(paths: Array) -> Array:
    """Length of the path up to each point [m], not counting trembling on the spot, shape (N, T).

    The way grows by the greatest distance reached from an anchor; the anchor follows in strides.
    """
    n, t, _ = paths.shape
    from_centre = np.linalg.norm(paths - paths.mean(axis=1, keepdims=True), axis=-1)
    stride = STRIDE * 2 * from_centre.max(axis=1)
    anchor, behind, ahead = paths[:, 0].copy(), np.zeros(n), np.zeros(n)
    way = np.zeros((n, t))
    for step in range(1, t):
        ahead = np.maximum(ahead, np.linalg.norm(paths[:, step] - anchor, axis=1))
        way[:, step] = behind + ahead
        arrived = ahead >= stride
        behind = np.where(arrived, way[:, step], behind)
        anchor = np.where(arrived[:, None], paths[:, step], anchor)
        ahead = np.where(arrived, 0.0, ahead)
    return way


def by_phase(paths: Array, landmarks: NDArray[np.intp], reach: float | None, n_phases: int) -> Phases:
    """Tell the demonstrations by phase instead of time.

    Args:
        paths: Positions over time [m], shape (N, T, d).
        landmarks: Steps at which each demonstration passes the inner landmarks, shape (N, M), in order.
        reach: How far from a landmark the way alone counts, as a share of the shortest way between landmarks,
            below 0.5; None: phase is time.
        n_phases: U.
    """
    n, t, _ = paths.shape
    times = np.linspace(0.0, 1.0, t)
    smooth = gaussian_filter1d(paths, max(SMOOTHING * t, 1e-3), axis=1, mode="nearest")
    way = way_despite_trembling(smooth)
    length = way[:, -1:]
    shares = np.where(length > 0, way / np.where(length > 0, length, 1.0), times)
    phases = np.tile(times, (n, 1)) if reach is None else _piecewise(way, landmarks, reach)
    phases = phases + 1e-9 * times
    phases = (phases - phases[:, :1]) / (phases[:, -1:] - phases[:, :1])
    at = np.linspace(0.0, 1.0, n_phases)
    told = np.stack(
        [
            np.stack([np.interp(at, phase, axis) for axis in path.T], axis=1)
            for phase, path in zip(phases, paths, strict=True)
        ]
    )
    return Phases(told, shares)


def _piecewise(way: Array, landmarks: NDArray[np.intp], reach: float) -> Array:
    """Phase of each sample, with the landmarks at the same phase in all demonstrations, shape (N, T)."""
    n, t = way.shape
    stops = np.concatenate([np.zeros((n, 1), int), landmarks, np.full((n, 1), t - 1)], axis=1)
    at_stops = np.take_along_axis(way, stops, axis=1)
    legs = np.maximum(np.diff(at_stops, axis=1), 1e-9)
    shortest = legs.min(axis=0)
    at = np.linspace(0.0, 1.0, FINE)
    stretch = _step(np.clip((at - reach) / (1 - 2 * reach), 0.0, 1.0))
    out = np.zeros((n, t))
    for leg, short in enumerate(shortest):
        for demonstration, length in enumerate(legs[:, leg]):
            done = way[demonstration] - at_stops[demonstration, leg]
            own = np.interp(done, short * at + (length - short) * stretch, at)
            out[demonstration] += short / shortest.sum() * own
    return out


def _step(u: Array) -> Array:
    """From 0 to 1 with flat ends."""
    return u * u * (3 - 2 * u)


@dataclass(frozen=True, slots=True, eq=False)
class Progress:
    """How far along the way the demonstrations are.

    Attributes:
        mean: Share of the way that is done, over time, from 0 to 1, shape (T,).
        spread: Its standard deviation between demonstrations, shape (T,).
    """

    mean: Array
    spread: Array


def common_progress(paths: Array, shares: Array, fitted: Array) -> Progress:
    """How the demonstrations progress on average.

    A demonstration's trembling lengthens its way, most where it waits. So its progress is read off the
    fitted way of its scene instead: from the share of the way travelled, by steps along the tangent to the
    point next to it.

    Args:
        paths: Positions over time [m], shape (N, T, d).
        shares: First guess of each demonstration's progress, shape (N, T).
        fitted: The fitted ways [m], shape (N, U, d).
    """
    n_steps = fitted.shape[1]
    even = follow(fitted, np.linspace(0, 1, n_steps))
    length = np.maximum(way_travelled(even)[:, -1], 1e-9)[:, None]
    tangent = np.gradient(even, axis=1)
    tangent = tangent / np.maximum(np.linalg.norm(tangent, axis=-1, keepdims=True), 1e-12)
    for _ in range(2):
        place = np.clip(shares, 0.0, 1.0) * (n_steps - 1)
        low = np.minimum(place.astype(int), n_steps - 2)[..., None]
        part = place[..., None] - low
        point, direction = (
            np.take_along_axis(table, low, axis=1) * (1 - part)
            + np.take_along_axis(table, low + 1, axis=1) * part
            for table in (even, tangent)
        )
        ahead = ((paths - point) * direction).sum(axis=-1) / length
        shares = place / (n_steps - 1) + np.clip(ahead, -LARGEST_STEP, LARGEST_STEP)
    spread = shares.std(axis=0, ddof=min(1, len(shares) - 1))
    mean = _smoothed(shares.mean(axis=0), 0.5 * SMOOTHING)
    mean = np.maximum.accumulate(np.clip(mean, 0.0, 1.0))
    span = mean[-1] - mean[0]
    return Progress((mean - mean[0]) / span if span > 1e-9 else np.linspace(0, 1, len(mean)), spread)


def _smoothed(shares: Array, width: float) -> Array:
    """Filtered over time, shape (T,); beyond its ends it goes on as it came, so that the pace there stays."""
    n_beyond = min(len(shares) - 1, round(4 * width * len(shares)) + 1)
    longer = np.pad(shares, n_beyond, mode="reflect", reflect_type="odd")
    return np.asarray(gaussian_filter1d(longer, max(width * len(shares), 1e-3)))[
        n_beyond : len(longer) - n_beyond
    ]


def follow(paths: Array, progress: Array, carried: Array | None = None) -> Array:
    """Run along paths so that at each time the given share of the way is done.

    Args:
        paths: S polylines [m], shape (S, U, d).
        progress: Shares in 0..1, not decreasing, shape (T,).
        carried: What is wanted along the way instead of the positions, shape (S, U, e).

    Returns:
        Positions over time [m], shape (S, T, d), or what was carried, shape (S, T, e).
    """
    s, u, _ = paths.shape
    way = way_travelled(paths)
    length = way[:, -1:]
    stands = length <= 0
    shares = way / np.where(stands, 1.0, length)
    if stands.any():
        shares = np.where(stands, np.linspace(0, 1, u), shares)
    # One search for all scenes: scene i's shares are moved to [2 i, 2 i + 1].
    offsets = 2.0 * np.arange(s)[:, None]
    known = (shares + offsets).ravel()
    first = np.arange(s)[:, None] * u
    found = np.searchsorted(known, (progress + offsets).ravel()).reshape(s, -1)
    right = np.clip(found, first + 1, first + u - 1).ravel()
    left = shares.ravel()[right - 1]
    step = shares.ravel()[right] - left
    part = (np.tile(progress, s) - left) / np.maximum(step, np.finfo(float).tiny)
    part = np.clip(part, 0.0, 1.0)[:, None]
    table = (paths if carried is None else carried).reshape(s * u, -1)
    before = table.take(right - 1, axis=0)  # Several times as fast as indexing with brackets.
    return np.asarray(before + (table.take(right, axis=0) - before) * part).reshape(s, len(progress), -1)
