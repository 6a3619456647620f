"""Which scene to demonstrate next: the one that leaves least uncertainty about all the others."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course.course import Course
from cobot_lfd.learning.data import Scenes, TaskFrame, stack_scenes
from cobot_lfd.learning.kinds.identification import Certainty
from cobot_lfd.learning.model import TaskParameterisedGMM

DOUBT_WEIGHT = 1.0
"""What showing the opposite direction of an undecided frame is worth, relative to the best scene's gain."""


@dataclass(frozen=True, slots=True)
class Suggestion:
    """A scene worth demonstrating.

    Attributes:
        index: Which of the candidates.
        uncertainty: Root mean square standard deviation of its path, as the model predicts it [m].
        reason: Why, in sentences for the user, in which the scene is "it".
    """

    index: int
    uncertainty: float
    reason: str


def suggest_demonstration(
    model: TaskParameterisedGMM,
    candidates: Sequence[Mapping[str, TaskFrame]],
    shown: Sequence[Mapping[str, TaskFrame]],
) -> Suggestion:
    """Choose the candidate whose demonstration would tell the model most.

    The predicted covariance of a path grows with how unlike the demonstrated scenes its scene is, in those
    vectors that the path depends on. The scene is chosen after whose demonstration this covariance would be
    least on average over the candidates; for models that know no such dependence, the least certain one.
    Where a frame's kind is undecided, directions of it that were not shown yet count as well.

    Args:
        model: Learnt from the demonstrations so far.
        candidates: Scenes that could be set up next.
        shown: The scenes of the demonstrations so far.

    Raises:
        ValueError: If there are no candidates.
        ModelError: If a candidate lacks a frame.
    """
    if not candidates:
        raise ValueError("candidates is empty; offer at least one scene.")
    scenes = stack_scenes(candidates, model.used_frames)
    _, covariance = model.generate(scenes)
    uncertainty = np.sqrt(np.trace(covariance, axis1=-2, axis2=-1).mean(axis=1))
    gain = uncertainty
    if isinstance(model.generator, Course):
        after = model.generator.regression.spread_after(scenes)
        gain = after.max() - after
    doubtful = [f.name for f in model.findings if f.certainty is Certainty.UNDECIDED]
    novelty = np.zeros(len(candidates))
    if doubtful and shown:
        novelty = _new_directions(stack_scenes(candidates, doubtful), stack_scenes(shown, doubtful))
    value = gain / max(gain.max(), 1e-12) + DOUBT_WEIGHT * novelty
    best = int(np.argmax(value))
    reason = (
        "It would teach most: with it, the model would be surest of its paths in all other scenes. "
        f"In this one, it knows the path to about {uncertainty[best] * 1000:.0f} mm so far."
    )
    if doubtful:
        reason += f" It also shows '{doubtful[0]}' turned another way, to tell whether its direction matters."
    return Suggestion(best, float(uncertainty[best]), reason)


def _new_directions(candidates: Scenes, shown: Scenes) -> Array:
    """How far each candidate's frames are turned from all shown ones, 0 to 1, mean over the frames."""
    cosine = (
        np.einsum("cjab,sjab->csj", candidates.rotations, shown.rotations) / candidates.rotations.shape[-1]
    )
    return np.asarray((1 - cosine.max(axis=1)).mean(axis=1) / 2)
