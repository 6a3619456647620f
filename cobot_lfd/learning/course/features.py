"""Vectors that turn and move with a scene: what a path is made of."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import Scenes


@dataclass(frozen=True, slots=True)
class FeatureSet:
    """Which vectors of a scene a path may be made of.

    Always: the lines from the first frame's origin to the others', and the axes of oriented frames.

    Attributes:
        oriented: Whether each frame's axes count.
        sight: Whether unit vectors along the lines of sight to and from orientation-less frames count; they
            carry the radius of a ring.
        unit: Length in which everything is measured [m].
    """

    oriented: tuple[bool, ...]
    sight: bool
    unit: float


def scene_features(scenes: Scenes, chosen: FeatureSet) -> Array:
    """The vectors [m], one per column, shape (S, d, F)."""
    s, n_frames, d = scenes.positions.shape
    origin = scenes.positions[:, 0]
    columns = [scenes.positions[:, j] - origin for j in range(1, n_frames)]
    for j in range(n_frames):
        if chosen.oriented[j]:
            columns += [chosen.unit * scenes.rotations[:, j, :, axis] for axis in range(d)]
    if chosen.sight:
        columns += [_sight(scenes, j, k, chosen.unit) for j, k in _sight_pairs(chosen.oriented)]
    return np.stack(columns, axis=2) if columns else np.zeros((s, d, 0))


def _sight_pairs(oriented: tuple[bool, ...]) -> list[tuple[int, int]]:
    """Pairs of frames of which one at least is a ring."""
    n = len(oriented)
    return [(j, k) for j in range(n) for k in range(j + 1, n) if not (oriented[j] and oriented[k])]


def _sight(scenes: Scenes, frame: int, other: int, unit: float) -> Array:
    """The direction from one frame to another, scaled; it fades where the frames nearly coincide."""
    line = scenes.positions[:, other] - scenes.positions[:, frame]
    length = np.sqrt((line**2).sum(axis=1, keepdims=True) + (0.05 * unit) ** 2)
    return np.asarray(unit * line / length)
