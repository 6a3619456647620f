"""From a profile and scenes to the Gaussians of the path (paper, sections 3.3 and 4.5)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from operator import add

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import Scenes, TaskData
from cobot_lfd.learning.mixtures.profile import Profile
from cobot_lfd.learning.product.approach import ApproachAngles
from cobot_lfd.learning.product.directions import nearest_directions, sequence_directions
from cobot_lfd.learning.product.information import (
    Information,
    oriented_information,
    oriented_means,
    ring_information,
)


@dataclass(frozen=True, slots=True, eq=False)
class Visits:
    """In which order, and when, the path comes closest to each frame.

    Attributes:
        times: Normalised time of the closest approach, median over the demonstrations, shape (J,).
    """

    times: Array

    @property
    def order(self) -> list[int]:
        """The frames by their times."""
        return [int(j) for j in np.argsort(self.times, kind="stable")]


def find_visits(data: TaskData) -> Visits:
    """When the demonstrations come closest to each frame."""
    nearest = np.argmin(np.linalg.norm(data.local, axis=-1), axis=-1)
    return Visits(np.median(data.times[nearest], axis=0))


def gather(
    profile: Profile,
    scenes: Scenes,
    oriented: Sequence[bool],
    times: Array,
    visits: Visits | None,
    approach: ApproachAngles | None = None,
) -> Information:
    """The product of all frames' Gaussians and of the rings' stand-ins.

    Args:
        profile: What is known at ``times``.
        scenes: The scenes.
        oriented: Which frames are oriented.
        times: Normalised times, shape (T,).
        visits: Rings look along this sequence; None: towards the nearest frame (paper, Table 1).
        approach: Turns the rings' directions by what was learnt; None: leaves them.
    """
    parts = []
    for frame, is_oriented in enumerate(oriented):
        if is_oriented:
            parts.append(oriented_information(profile, scenes, frame))
        else:
            directions = ring_directions(profile, scenes, oriented, times, visits, frame)
            turned = directions if approach is None else approach.turn(scenes, frame, directions)
            parts.append(ring_information(profile, scenes, frame, turned))
    return reduce(add, parts)


def ring_directions(
    profile: Profile,
    scenes: Scenes,
    oriented: Sequence[bool],
    times: Array,
    visits: Visits | None,
    ring: int,
) -> Array:
    """Which way a ring looks, shape (S, d, T); arguments as for ``gather``."""
    means = oriented_means(profile, scenes)
    if visits is None:
        return nearest_directions(scenes, means, oriented, ring)
    landmarks = _landmarks(profile, scenes, means, oriented, ring)
    return sequence_directions(scenes, landmarks, visits.order, _past(times, visits, ring), ring)


def _past(times: Array, visits: Visits, frame: int) -> NDArray[np.bool_]:
    """Whether the closest approach to the frame is past."""
    return np.asarray(times > visits.times[frame])


def _landmarks(profile: Profile, scenes: Scenes, means: Array, oriented: Sequence[bool], ring: int) -> Array:
    """Where each frame stands, as seen from a ring, shape (S, J, d).

    An oriented frame stands where its Gaussian's mean is at the time next to the ring's at which it is still
    surer than the ring; an orientation-less one at its origin.
    """
    out = scenes.positions.copy()
    spread = np.trace(profile.covariance, axis1=-2, axis2=-1) / profile.mean.shape[-1]
    for frame, is_oriented in enumerate(oriented):
        if is_oriented:
            surer = np.flatnonzero(spread[frame] < profile.radius_variance[ring])
            if len(surer):
                towards = np.argmin(profile.radius[ring]) if profile.radius[ring].any() else 0
                step = surer[np.argmin(np.abs(surer - towards))]
                out[:, frame] = means[:, frame, :, step]
    return out
