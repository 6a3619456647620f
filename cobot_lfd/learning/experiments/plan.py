"""The paper's experiments as pieces of work: which results there are, and how each comes about."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cobot_lfd.frame import FrameKind
from cobot_lfd.learning.data import TaskDemonstration, collect
from cobot_lfd.learning.experiments.calinon import read_calinon
from cobot_lfd.learning.experiments.cases import Case, Fit, paper_cases, run
from cobot_lfd.learning.experiments.ledger import Unit
from cobot_lfd.learning.experiments.synthetic import (
    TASKS,
    SyntheticTask,
    demonstrate,
    demonstrations,
    draw_scene,
    human_timing,
    paper_like,
    planar,
    true_path,
)
from cobot_lfd.learning.fitting import identify
from cobot_lfd.learning.metrics import identifier_f1
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.learning.settings import CONVENTIONAL, IMPROVED, PAPER, LearningSettings
from cobot_lfd.learning.suggestion import suggest_demonstration

SLOTS = (0.0, 0.10, 0.15, 0.20, 0.25)
CELLS = tuple((k, n) for k in (3, 4) for n in (4, 5, 6))
COUNTS = tuple(range(3, 11))


@dataclass(frozen=True, slots=True)
class Plan:
    """How much is worked out.

    Attributes:
        sets: Training sets per figure.
        scenes: New scenes per training set.
        identifier_sets: Training sets per cell of the identifier's tables.
        seed: First part of every seed.
        calinon: Folder of the public two-frame data; None: leave that row out.
    """

    sets: int
    scenes: int
    identifier_sets: int
    seed: int
    calinon: Path | None


def without_kernel(settings: LearningSettings) -> LearningSettings:
    """Plain EM: no exchange of responsibilities between demonstrations."""
    return replace(settings, em=replace(settings.em, sharing=None))


METHODS = {"conventional": CONVENTIONAL, "paper": PAPER, "ours": IMPROVED}
IDENTIFIERS = {
    "paper, with kernel": PAPER,
    "paper, without": without_kernel(PAPER),
    "this product": IMPROVED,
}
TABLE_4 = {
    ("conventional", True): replace(CONVENTIONAL, em=PAPER.em),
    ("conventional", False): CONVENTIONAL,
    ("improved", True): PAPER,
    ("improved", False): without_kernel(PAPER),
    ("ours", True): IMPROVED,
}


def hard_generators() -> dict[str, list[SyntheticTask]]:
    """Tasks 1-3 where frames are turned little, or seen badly."""
    changes: Mapping[str, Mapping[str, Any]] = {
        "slots 10 %": {"slot": 0.10},
        "slots 25 %": {},
        "orientation-less frames turned within ±45°": {"loose_spread": np.radians(45)},
        "slots within ±45° of the line of sight": {"slot_spread": np.radians(45)},
        "slots within ±20° of the line of sight": {"slot_spread": np.radians(20)},
        "angles noisy by 5°": {"angle_noise": np.radians(5)},
        "angles noisy by 10°": {"angle_noise": np.radians(10)},
    }
    generators = {name: [replace(TASKS[i], **change) for i in (1, 2, 3)] for name, change in changes.items()}
    generators["paper-like"] = [paper_like(TASKS[i]) for i in (1, 2, 3)]
    generators["paper-like, bell speed and waits"] = [human_timing(paper_like(TASKS[i])) for i in (1, 2, 3)]
    return generators


def table_4_case(task: int) -> Case:
    """A row of the paper's Table 4, with the paper's number of demonstrations."""
    return Case(f"Task {task}", TASKS[task], TASKS[task], 4 if task == 1 else 6)


def rounds(plan: Plan) -> Iterator[list[Unit]]:
    """The work in rounds, each with the next training sets of every row."""
    for number in range(plan.sets):
        yield [
            *_comparison(plan, number),
            *_table_4(plan, number),
            *_identifiers(plan, number),
            *(_suggestions(plan, number // 2) if number % 2 == 0 else []),
            *(_public_data(plan) if number == 0 else []),
        ]


def _fit(settings: LearningSettings, demos: Sequence[TaskDemonstration]) -> TaskParameterisedGMM:
    """A fit with settings put first, to be completed by ``partial``."""
    return TaskParameterisedGMM.fit(demos, settings=settings)


def _with_components(settings: LearningSettings, n_components: int) -> LearningSettings:
    """The same settings with another number of Gaussians."""
    return replace(settings, em=replace(settings.em, n_components=n_components))


def _scores(fits: Mapping[str, Fit], case: Case, number: int, plan: Plan) -> dict[str, float]:
    """The figures of all methods, named method/figure."""
    scores = run(fits, case, np.random.default_rng([plan.seed, number]), plan.scenes)
    return {f"{name}/{key}": value for name, s in scores.items() for key, value in asdict(s).items()}


def _comparison(plan: Plan, number: int) -> Iterator[Unit]:
    """All cases with the three methods."""
    fits = {name: partial(_fit, settings) for name, settings in METHODS.items()}
    for case in paper_cases():
        yield Unit(f"case/{case.name}", number, partial(_scores, fits, case, number, plan))


def _table_4(plan: Plan, number: int) -> Iterator[Unit]:
    """Smoothness, efficiency and reachability."""
    for task in (1, 2, 3):
        fits = {
            f"{name}-{kernel}": partial(_fit, _with_components(settings, 3 if task == 1 else 4))
            for (name, kernel), settings in TABLE_4.items()
        }
        yield Unit(f"table4/{task}", number, partial(_scores, fits, table_4_case(task), number, plan))


def _identifiers(plan: Plan, number: int) -> Iterator[Unit]:
    """This round's share of the identifier's training sets."""
    first, last = (plan.identifier_sets * n // plan.sets for n in (number, number + 1))
    for i in range(first, last):
        for slot in SLOTS:
            for k, n in CELLS:
                task = replace(TASKS[2], slot=slot)
                work = partial(_identified, task, n, k, IDENTIFIERS, (plan.seed, 1, n, i))
                yield Unit(f"identifier/{slot:.0%}/{k}/{n}", i, work)
        for name, tasks in hard_generators().items():
            for n in (4, 6):
                # The three tasks take turns, so a cell has as many training sets as the other table's.
                seed = (plan.seed, 2, n, i)
                work = partial(_identified, tasks[i % 3], n, 4, {"this product": IMPROVED}, seed)
                yield Unit(f"hard/{name}/{n}", i, work)


def _identified(
    task: SyntheticTask, n: int, k: int, methods: Mapping[str, LearningSettings], seed: Sequence[int]
) -> dict[str, float]:
    """Whether all kinds were found in one training set, and the F1 score, by each method."""
    data = collect(demonstrations(task, n, np.random.default_rng(list(seed))))
    true = {
        name: FrameKind.ORIENTED if oriented else FrameKind.ORIENTATION_LESS
        for name, oriented in task.kinds.items()
    }
    values = {}
    for name, settings in methods.items():
        findings = identify(data, _with_components(settings, k), np.random.default_rng(0))
        found = {finding.name: finding.kind for finding in findings}
        values[f"{name}/right"] = float(found == true)
        values[f"{name}/f1"] = identifier_f1(found, true).score
    return values


def _suggestions(plan: Plan, number: int) -> Iterator[Unit]:
    """The error over the number of demonstrations, with random and with suggested scenes."""
    for suggested in (False, True):
        key = f"curve/{'suggested' if suggested else 'random'}"
        yield Unit(key, number, partial(_learning_curve, TASKS[1], suggested, (plan.seed, 3, number)))


def _learning_curve(task: SyntheticTask, suggested: bool, seed: Sequence[int]) -> dict[str, float]:
    """The error after each demonstration."""
    rng = np.random.default_rng(list(seed))
    tried = [draw_scene(task, rng) for _ in range(50)]
    truth = np.stack([true_path(task, scene) for scene in tried])
    demos = [demonstrate(task, rng) for _ in range(COUNTS[0])]
    curve = {}
    for count in COUNTS:
        model = TaskParameterisedGMM.fit(demos)
        paths = np.stack([p.mean for p in model.reproduce_many([planar(scene) for scene in tried])])
        curve[str(count)] = float(np.linalg.norm(paths - truth, axis=-1).mean())
        offered = [draw_scene(task, rng) for _ in range(30)]
        frames = [planar(scene) for scene in offered]
        index = suggest_demonstration(model, frames, [d.frames for d in demos]).index if suggested else 0
        demos.append(demonstrate(task, rng, scene=offered[index]))
    return curve


def _public_data(plan: Plan) -> Iterator[Unit]:
    """Each of the public demonstrations predicted from the others."""
    if plan.calinon is None:
        return
    demos = read_calinon(plan.calinon)
    for held_out in range(len(demos)):
        yield Unit("public", held_out, partial(_left_out, demos, held_out))


def _left_out(demos: Sequence[TaskDemonstration], held_out: int) -> dict[str, float]:
    """Distance from one demonstration that was left out, as a share of the frames' distance, per method."""
    demo = demos[held_out]
    others = [d for i, d in enumerate(demos) if i != held_out]
    start, end = (frame.position for frame in demo.frames.values())
    values = {}
    for name, settings in METHODS.items():
        path = _fit(settings, others).reproduce(demo.frames, len(demo.path)).mean
        values[name] = float(np.linalg.norm(path - demo.path, axis=1).mean() / np.linalg.norm(end - start))
    return values
