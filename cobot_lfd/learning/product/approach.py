"""The angle at which a ring is approached, learnt from the direction of an oriented frame (in the plane).

A path that leaves an oriented frame sideways arrives at an orientation-less one sideways as well. So the
bearing of the path, relative to the direction in which the ring looks, is regressed at each time on the sines
of the oriented frames' directions relative to the lines of sight, with a ridge.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import Scenes
from cobot_lfd.learning.mixtures.kernel import kernel_weights

RIDGE = 0.3
"""Sum of squared sines that is worth no turn."""
WIDTH = 0.03
"""Width of the kernel over time."""


@dataclass(frozen=True, slots=True, eq=False)
class ApproachAngles:
    """Turn of a ring's direction per sine of each frame's direction.

    Attributes:
        slopes: Shape (J rings, J frames, T) [rad]; zero where a frame is not oriented.
    """

    slopes: Array

    def turn(self, scenes: Scenes, ring: int, directions: Array) -> Array:
        """Directions of a ring, shape (S, 2, T'), turned by what the oriented frames' directions tell."""
        n_steps = directions.shape[-1]
        table = self.slopes[ring]
        places = np.linspace(0, 1, table.shape[1])
        slopes = np.stack([np.interp(np.linspace(0, 1, n_steps), places, row) for row in table])
        angles = _sines(scenes, ring) @ slopes
        cos, sin = np.cos(angles), np.sin(angles)
        x, y = directions[:, 0], directions[:, 1]
        return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)


def learn_approach(
    paths: Array, scenes: Scenes, oriented: Sequence[bool], directions: dict[int, Array]
) -> ApproachAngles:
    """Regress the bearings of planar demonstrations.

    Args:
        paths: Positions over time [m], shape (N, T, 2).
        scenes: The N scenes.
        oriented: Which frames are oriented.
        directions: Where each ring looks in each demonstration, shape (N, 2, T), by its number.

    Raises:
        ValueError: If the paths are not planar.
    """
    if paths.shape[-1] != 2:
        raise ValueError("the approach angle is defined in the plane; switch approach_angle off in space.")
    n_frames, n_steps = len(oriented), paths.shape[1]
    slopes = np.zeros((n_frames, n_frames, n_steps))
    times = np.linspace(0, 1, n_steps)
    average = kernel_weights(times, times, WIDTH)
    chosen = np.flatnonzero(np.asarray(oriented))
    for ring, looks in directions.items():
        offset = np.swapaxes(paths - scenes.positions[:, None, ring], 1, 2)
        across = looks[:, 0] * offset[:, 1] - looks[:, 1] * offset[:, 0]
        bearing = np.arctan2(across, (looks * offset).sum(axis=1)) @ average.T
        sines = _sines(scenes, ring)[:, chosen]
        moments = sines.T @ sines + RIDGE * np.eye(len(chosen))
        slopes[ring, chosen] = np.linalg.solve(moments, sines.T @ bearing)
    return ApproachAngles(slopes)


def _sines(scenes: Scenes, ring: int) -> Array:
    """Sine of the angle from the line of sight (frame to ring) to each frame's x axis, shape (S, J)."""
    sight = scenes.positions[:, ring, None] - scenes.positions
    axis = scenes.rotations[..., 0]
    length = np.linalg.norm(sight, axis=-1)
    across = sight[..., 0] * axis[..., 1] - sight[..., 1] * axis[..., 0]
    return np.asarray(np.where(length > 0, across / np.where(length > 0, length, 1.0), 0.0))
