"""Experiments on made-up tasks: a method, trained on many sets, tried in many new scenes."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.frame import FrameKind
from cobot_lfd.learning import metrics
from cobot_lfd.learning.data import TaskDemonstration, stack_scenes
from cobot_lfd.learning.experiments.synthetic import (
    TASKS,
    SyntheticTask,
    demonstrations,
    draw_scene,
    human_timing,
    paper_like,
    planar,
    recorded,
    true_path,
)
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.pose import Pose

Fit = Callable[[Sequence[TaskDemonstration]], TaskParameterisedGMM]
"""A method: from demonstrations to a model."""
PASSING = 0.05
"""How near the path must pass a via frame [m]."""


@dataclass(frozen=True, slots=True)
class Case:
    """A task to learn, and the task of the new scenes.

    Attributes:
        name: For tables.
        task: Where the demonstrations come from.
        tried: Where the new scenes come from.
        n_demonstrations: Size of a training set.
    """

    name: str
    task: SyntheticTask
    tried: SyntheticTask
    n_demonstrations: int = 6


@dataclass(frozen=True, slots=True)
class Scores:
    """Figures of one trained model over its new scenes; percentages in 0..100.

    Attributes:
        reach: Reachability at 0.05 (eq. 31) [%].
        d_total: Mean distance from the truth (Table 5) [m].
        d_start: The same at the start [m].
        d_end: The same at the end [m].
        edges: Sharp edges as printed (eq. 24).
        efficiency: Shortest over covered distance (eq. 27).
        detour: Covered over shortest distance (as in the paper's Table 4).
        turns: Turns, whatever the axes.
        jerk: Log dimensionless jerk.
        length: Length over the truth's.
        kinds: Whether all frames' kinds were found [%]; a frame that may be left out does not count.
        passes: Share of paths that pass the via frame, nan without one [%].
        dropped: Whether the irrelevant frame was left out, nan without one [%].
    """

    reach: float
    d_total: float
    d_start: float
    d_end: float
    edges: float
    efficiency: float
    detour: float
    turns: float
    jerk: float
    length: float
    kinds: float
    passes: float
    dropped: float


def paper_cases() -> list[Case]:
    """The cases on which methods are compared."""
    cases = [Case(f"Task {i}, slots 25 %", TASKS[i], TASKS[i]) for i in (1, 2, 3)]
    cases += [Case(f"Task {i}, paper-like", paper_like(TASKS[i]), paper_like(TASKS[i])) for i in (1, 2)]
    for i in (1, 2, 3):
        task = human_timing(paper_like(TASKS[i]))
        cases.append(Case(f"Task {i}, paper-like, bell speed and waits", task, task))
    for i in (1, 2, 3):
        task = replace(TASKS[i], irrelevant=True)
        cases.append(Case(f"Task {i}, irrelevant third frame", task, task))
    via = replace(TASKS[1], via=True)
    cases.append(Case("Task 1, third frame to be passed", via, via))
    cases += [
        Case(f"Task {i}, new scenes 1.5 times as wide", TASKS[i], replace(TASKS[i], widen=1.5))
        for i in (1, 2, 3)
    ]
    for i in (1, 2):
        task = replace(TASKS[i], frame_noise=0.005, angle_noise=np.radians(5))
        cases.append(Case(f"Task {i}, noisy frames (5 mm, 5°)", task, task))
    cases.append(Case("Task 2, three demonstrations", TASKS[2], TASKS[2], 3))
    cases += [Case(f"Task {i}, other demonstrator", _other(TASKS[i]), _other(TASKS[i])) for i in (1, 2, 3)]
    return cases


def _other(task: SyntheticTask) -> SyntheticTask:
    """Other frames, curves and habits than those on which the defaults were tuned."""
    return replace(
        task,
        slot=0.18,
        slot_spread=np.radians(70),
        half_box=(0.15, 0.5),
        handle=0.28,
        bow=0.05,
        warp=0.3,
        noise=(0.001, 0.004),
    )


def run(
    fits: Mapping[str, Fit], case: Case, rng: np.random.Generator, n_scenes: int = 100
) -> dict[str, Scores]:
    """Train each method on one set of demonstrations, try all in the same new scenes."""
    demos = demonstrations(case.task, case.n_demonstrations, rng)
    scenes = [draw_scene(case.tried, rng) for _ in range(n_scenes)]
    d = case.tried.dimension
    truth = np.stack([true_path(case.tried, scene) for scene in scenes])
    seen = [recorded(case.tried, scene, rng) for scene in scenes]
    frames = [planar(scene) for scene in seen] if d == 2 else seen
    scores = {}
    for name, fit in fits.items():
        model = fit(demos)
        paths, _ = model.generate(stack_scenes(frames, model.used_frames), truth.shape[1])
        scores[name] = _scored(model, paths, truth, case, scenes)
    return scores


def _scored(
    model: TaskParameterisedGMM, paths: Array, truth: Array, case: Case, scenes: Sequence[dict[str, Pose]]
) -> Scores:
    """The figures of one model's paths, shape (S, T, d)."""
    d = case.task.dimension
    ends = [np.stack([scene[name].position[:d] for scene in scenes]) for name in ("start", "end")]
    apart = metrics.distances(paths, truth)
    return Scores(
        reach=metrics.reachability(paths, ends[0], ends[1]),
        d_total=apart.total,
        d_start=apart.start,
        d_end=apart.end,
        edges=metrics.smoothness(paths) if d == 2 else float("nan"),
        efficiency=metrics.efficiency(paths),
        detour=metrics.detour(paths),
        turns=metrics.turns(paths),
        jerk=metrics.log_dimensionless_jerk(paths),
        length=metrics.length_ratio(paths, truth),
        kinds=100.0 * kinds_right(model, case.task),
        passes=_passes(paths, np.stack([scene["via"].position[:d] for scene in scenes]))
        if case.task.via
        else float("nan"),
        dropped=100.0 * ("bystander" not in model.used_frames) if case.task.irrelevant else float("nan"),
    )


def kinds_right(model: TaskParameterisedGMM, task: SyntheticTask) -> bool:
    """Whether the kinds of all frames that matter were found."""
    return all(
        (model.frame_kinds[name] is FrameKind.ORIENTED) == oriented
        for name, oriented in task.kinds.items()
        if name != "bystander"
    )


COUNTED = frozenset({"kinds", "dropped", "passes"})
"""Figures that are shares of yes-or-no answers, of which means are taken."""


def medians(scores: Sequence[Scores]) -> Scores:
    """The figures over many training sets: medians; of the yes-or-no ones, shares."""
    return Scores(
        **{
            f.name: float((np.mean if f.name in COUNTED else np.median)([getattr(s, f.name) for s in scores]))
            for f in fields(Scores)
        }
    )


def _passes(paths: Array, via: Array) -> float:
    """Share of paths that pass a point [%]."""
    nearest = np.linalg.norm(paths - via[:, None], axis=-1).min(axis=1)
    return float(100 * (nearest < PASSING).mean())
