"""Figures of a generated path, beside the path that the scripted hand takes in the same scene."""

from collections.abc import Mapping

import numpy as np

from cobot_lfd.app.recording.script import HAND_STREAM, write_script
from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from cobot_lfd.learning.metrics import (
    distances,
    efficiency,
    log_dimensionless_jerk,
    reachability,
    smoothness,
    turns,
)
from cobot_lfd.pose import Pose
from cobot_lfd.tool import ToolTurn
from scenes import SceneDescription

REACHED = 0.05
"""Distance within which a start or an end counts as reached (paper, section 5.3) [m]."""


def path_measures(
    scene: SceneDescription, frames: Mapping[str, Frame], seed: int, path: Array
) -> dict[str, float]:
    """The paper's measures of one path, and two that do not depend on the world's axes.

    Args:
        scene: The scene.
        frames: Where its objects really are.
        seed: Of the episode; with it the hand varies as in the recording of a demonstration.
        path: The generated path [m], shape (T, 2).

    Returns:
        ``sharp_edges`` (eqs. 21-24), ``efficiency`` in 0..1 (eq. 27), ``reachability`` in percent (eqs.
        28-31), ``d_total``, ``d_start`` and ``d_end`` [m] (Table 5), ``turns`` and ``log_jerk``.
    """
    truth = resampled(hand_path(scene, frames, seed), len(path))
    return measures_beside(path, truth)


def measures_beside(path: Array, truth: Array) -> dict[str, float]:
    """The measures of a path beside the true one, both at the same times, shape (T, 2) [m]."""
    paths, truths = path[None], truth[None]
    apart = distances(paths, truths)
    values = {
        "sharp_edges": smoothness(paths),
        "turns": turns(paths),
        "reachability": reachability(paths, truths[:, 0], truths[:, -1], REACHED),
        "d_total": apart.total,
        "d_start": apart.start,
        "d_end": apart.end,
    }
    if np.linalg.norm(np.diff(path, axis=0), axis=1).sum() > 0:  # a path that stays where it is has no shape
        with np.errstate(divide="ignore"):  # constant speed along a line has no jerk at all
            values |= {"efficiency": efficiency(paths), "log_jerk": log_dimensionless_jerk(paths)}
    return {name: float(value) for name, value in values.items() if np.isfinite(value)}


def hand_path(scene: SceneDescription, frames: Mapping[str, Frame], seed: int) -> Array:
    """How the scripted hand would carry the part in this scene [m], one position per tick, shape (M, 2)."""
    script = write_script(
        scene.task,
        frames,
        start=Pose.identity(),
        turn=ToolTurn.none(0.0),
        maximum_opening=0.0,
        time_step=scene.physics.time_step,
        rng=np.random.default_rng([seed, HAND_STREAM]),
    )
    return np.asarray(script.positions[script.carrying, :2])


def resampled(path: Array, n_steps: int) -> Array:
    """The path at equal steps of time, shape (n_steps, 2)."""
    old, new = np.linspace(0.0, 1.0, len(path)), np.linspace(0.0, 1.0, n_steps)
    return np.column_stack([np.interp(new, old, column) for column in path.T])
