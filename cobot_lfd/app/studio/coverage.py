"""Which scene to demonstrate next: where the model is unsure, and at first where nothing was shown yet."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cobot_lfd.demonstration import Demonstration
from cobot_lfd.errors import CobotError
from cobot_lfd.frame import Frame
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.learning.suggestion import suggest_demonstration
from scenes import SceneDescription
from scenes.placement import draw_placements

_N_CANDIDATES = 60
_FEWEST = 2  # demonstrations that a model is fitted to
_DIRECTION_WEIGHT = 0.15  # [m] that an opposite direction counts as much as


@dataclass(frozen=True, slots=True)
class NextScene:
    """A scene that is worth demonstrating.

    Attributes:
        seed: Lays it out.
        reason: Why this one, as a sentence.
    """

    seed: int
    reason: str


def suggest_next(
    scene: SceneDescription,
    first_seed: int,
    demonstrations: Sequence[Demonstration],
) -> NextScene:
    """The seed whose scene tells most.

    Where a model can be fitted, it is the scene after which the model would be least uncertain about all
    others; before that, the scene that is farthest from all that were shown, in the places and directions of
    its objects.

    Args:
        scene: The scene.
        first_seed: Candidates have the seeds from this one on.
        demonstrations: Those so far.
    """
    seeds = range(first_seed, first_seed + _N_CANDIDATES)
    candidates = [dict(draw_placements(scene, np.random.default_rng(seed))) for seed in seeds]
    if not demonstrations:
        return NextScene(first_seed, "Nothing was shown yet, so any scene is as good as another.")
    shown = [demonstration.frames for demonstration in demonstrations]
    model = _fitted(demonstrations)
    if model is not None:
        suggestion = suggest_demonstration(model, candidates, shown)
        return NextScene(seeds[suggestion.index], suggestion.reason)
    distances = np.array([[_distances(candidate, frames) for frames in shown] for candidate in candidates])
    nearest = distances.sum(axis=2).min(axis=1)
    best = int(nearest.argmax())
    return NextScene(seeds[best], _reason(candidates[best], shown))


def _fitted(demonstrations: Sequence[Demonstration]) -> TaskParameterisedGMM | None:
    """What can be learnt so far; None where it is not enough."""
    if len(demonstrations) < _FEWEST:
        return None
    try:
        return TaskParameterisedGMM.fit(demonstrations)
    except CobotError:
        return None


def _distances(a: Mapping[str, Frame], b: Mapping[str, Frame]) -> list[float]:
    """How unlike two scenes are, object by object [m]."""
    names = [name for name in a if name in b]
    return [_distance(a[name], b[name]) for name in names]


def _distance(a: Frame, b: Frame) -> float:
    direction = _DIRECTION_WEIGHT * np.sin(0.5 * (a.angle - b.angle))
    return float(np.hypot(np.linalg.norm(a.position - b.position), direction))


def _reason(frames: Mapping[str, Frame], shown: Sequence[Mapping[str, Frame]]) -> str:
    """What is new about a scene, for the object that is newest."""
    newest = max(frames, key=lambda name: min(_distance(frames[name], s[name]) for s in shown if name in s))
    seen = [s[newest] for s in shown if newest in s]
    far = min(float(np.linalg.norm(frames[newest].position - frame.position)) for frame in seen)
    turned = min(_turn(frames[newest].angle, frame.angle) for frame in seen)
    return (
        f"Its {newest} stands {100 * far:.0f} cm or more from wherever it was shown, and is turned by "
        f"{np.rad2deg(turned):.0f}° or more."
    )


def _turn(a: float, b: float) -> float:
    """Angle between two directions [rad]."""
    return float(abs(np.angle(np.exp(1j * (a - b)))))
