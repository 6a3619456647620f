"""The paper's experiments, and ours beside them: prints the tables and writes them as a page.

    python tools/paper_tables.py --sets 40 --out docs

Every training set has its own seed, made of --seed and its number; the same seeds serve every method.
"""

import argparse
import sys
import warnings
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from cobot_lfd.frame import FrameKind
from cobot_lfd.learning.data import TaskDemonstration, collect
from cobot_lfd.learning.experiments.cases import Case, Fit, Scores, medians, paper_cases, run
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
PAPER_TABLE_1 = {
    0.0: (1, 1, 1, 1, 1, 1),
    0.10: (0.67, 0.67, 1, 1, 0.67, 1),
    0.15: (1, 1, 1, 1, 1, 1),
    0.20: (1, 0.67, 1, 1, 1, 1),
    0.25: (1, 1, 1, 1, 1, 1),
}
PAPER_TABLE_4 = {
    (1, "conventional", True): (43.52, 2.2506, 99.0),
    (1, "conventional", False): (43.85, 2.2368, 96.0),
    (2, "conventional", True): (46.55, 1.499, 62.5),
    (2, "improved", True): (29.95, 1.456, 100.0),
    (2, "conventional", False): (45.83, 1.5143, 64.0),
    (2, "improved", False): (36.78, 1.4527, 100.0),
    (3, "conventional", True): (50.76, 1.1123, 62.5),
    (3, "improved", True): (29.78, 1.0698, 100.0),
    (3, "conventional", False): (53.63, 1.1207, 70.0),
    (3, "improved", False): (31.80, 1.0628, 100.0),
}


def fit_with(
    settings: LearningSettings, n_components: int, demos: Sequence[TaskDemonstration]
) -> TaskParameterisedGMM:
    """A fit with settings put first, to be completed by ``partial``."""
    return TaskParameterisedGMM.fit(demos, settings=settings, n_components=n_components)


def without_kernel(settings: LearningSettings) -> LearningSettings:
    """Plain EM: no exchange of responsibilities between demonstrations."""
    return replace(settings, em=replace(settings.em, sharing=None))


def score(fit: Fit, case: Case, options: argparse.Namespace) -> Scores:
    """Medians over the training sets."""
    print(f"  {case.name}", file=sys.stderr, flush=True)
    runs = [
        run(fit, case, np.random.default_rng([options.seed, number]), options.scenes)
        for number in range(options.sets)
    ]
    return medians(runs)


def row(*cells: object) -> str:
    """A line of a Markdown table."""
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def table(head: Sequence[object], rows: Sequence[Sequence[object]]) -> list[str]:
    """A Markdown table."""
    return [row(*head), row(*("---" for _ in head)), *(row(*cells) for cells in rows), ""]


def identified(
    task: SyntheticTask, n: int, settings: LearningSettings, n_components: int, seed: Sequence[int]
) -> tuple[bool, float]:
    """Whether all kinds were found in one training set, and the F1 score."""
    data = collect(demonstrations(task, n, np.random.default_rng(list(seed))))
    chosen = replace(settings, em=replace(settings.em, n_components=n_components))
    found = {f.name: f.kind for f in identify(data, chosen, np.random.default_rng(0))}
    true = {
        name: FrameKind.ORIENTED if oriented else FrameKind.ORIENTATION_LESS
        for name, oriented in task.kinds.items()
    }
    return found == true, identifier_f1(found, true).score


def identifier_table(options: argparse.Namespace) -> list[str]:
    """F1 of the identifiers over N, K and L (the paper's Tables 1 and 2)."""
    methods = {
        "paper, with kernel": PAPER,
        "paper, without": without_kernel(PAPER),
        "improved": IMPROVED,
    }
    rows: list[list[object]] = []
    shares: dict[str, list[float]] = {name: [] for name in methods}
    for slot in SLOTS:
        task = replace(TASKS[2], slot=slot)
        for column, (k, n) in enumerate((k, n) for k in (3, 4) for n in (4, 5, 6)):
            print(f"  identifier L={slot:.0%} N={n} K={k}", file=sys.stderr, flush=True)
            cells: list[object] = [f"{slot:.0%}", n, k, PAPER_TABLE_1[slot][column]]
            for name, settings in methods.items():
                count = options.identifier_sets if name == "improved" else options.sets
                found = [identified(task, n, settings, k, (options.seed, 1, n, i)) for i in range(count)]
                right = 100 * np.mean([r for r, _ in found])
                shares[name].append(float(right))
                f1 = np.array([f for _, f in found])
                known = f"{f1[~np.isnan(f1)].mean():.2f}" if (~np.isnan(f1)).any() else "–"
                cells.append(f"{known} ({right:.1f} %)")
            rows.append(cells)
    head = ["L", "N", "K", "paper's single run", *(f"{name}: F1 (both right)" for name in methods)]
    lines = table(head, rows)
    lines += [
        f"Both frames right, {name}: mean {np.mean(share):.1f} %, worst cell {min(share):.1f} % of the runs."
        for name, share in shares.items()
    ]
    return [*lines, ""]


def hard_identifier_table(options: argparse.Namespace) -> list[str]:
    """The identifier where frames are turned little, or seen badly."""
    changes = {
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
    rows = []
    for name, tasks in generators.items():
        print(f"  identifier {name}", file=sys.stderr, flush=True)
        cells: list[object] = [name]
        for n in (4, 6):
            found = [
                identified(task, n, IMPROVED, 4, (options.seed, 2, n, j, i))[0]
                for j, task in enumerate(tasks)
                for i in range(options.identifier_sets // 2)
            ]
            cells.append(f"{100 * np.mean(found):.1f}")
        rows.append(cells)
    return table(["generator", "N = 4 [%]", "N = 6 [%]"], rows)


def table_4(options: argparse.Namespace) -> list[str]:
    """Smoothness, efficiency and reachability on Tasks 1-3 (the paper's Table 4)."""
    rows = []
    for task in (1, 2, 3):
        case = Case(f"Task {task}", TASKS[task], TASKS[task], 4 if task == 1 else 6)
        for name, settings in (("conventional", CONVENTIONAL), ("improved", PAPER)):
            for kernel in (True, False):
                sharing = PAPER.em.sharing if kernel else None
                chosen = replace(settings, em=replace(settings.em, sharing=sharing))
                s = score(partial(fit_with, chosen, 3 if task == 1 else 4), case, options)
                paper = PAPER_TABLE_4.get((task, name, kernel))
                printed = "; ".join(f"{v:g}" for v in paper) if paper else "–"
                label = f"{name}, {'with' if kernel else 'without'} kernel"
                rows.append([case.name, label, printed, *_four(s)])
        s = score(partial(fit_with, IMPROVED, 4), case, options)
        rows.append([case.name, "this product's default", "–", *_four(s)])
    head = [
        "task",
        "method",
        "paper: edges; d/sd; reach %",
        "edges",
        "d/sd",
        "sd/d",
        "reach %",
        "turns",
        "log jerk",
    ]
    return table(head, rows)


def _four(s: Scores) -> list[str]:
    """The figures of Table 4."""
    return [
        f"{s.edges:.1f}",
        f"{s.detour:.3f}",
        f"{s.efficiency:.3f}",
        f"{s.reach:.1f}",
        f"{s.turns:.1f}",
        f"{s.jerk:.1f}",
    ]


def comparison(options: argparse.Namespace) -> list[str]:
    """All cases with the three methods."""
    rows = []
    for case in paper_cases():
        conventional, paper, ours = (
            score(partial(fit_with, settings, 4), case, options)
            for settings in (CONVENTIONAL, PAPER, IMPROVED)
        )
        rows.append(
            [
                case.name,
                *(f"{s.reach:.1f}; {s.d_total:.4f}; {s.edges:.1f}" for s in (conventional, paper, ours)),
                f"{ours.d_total / paper.d_total:.2f}",
                f"{ours.edges / paper.edges:.2f}" if paper.edges else "–",
                f"{paper.jerk:.1f} / {ours.jerk:.1f}",
                f"{paper.kinds:.0f} / {ours.kinds:.0f}",
                _shares(paper, ours),
            ]
        )
        print(row(*rows[-1]), file=sys.stderr, flush=True)
    head = [
        "case",
        "conventional: reach %; d_total; edges",
        "paper's method",
        "this product",
        "d_total ratio",
        "edges ratio",
        "log jerk, paper / ours",
        "kinds right %, paper / ours",
        "third frame",
    ]
    return table(head, rows)


def _shares(paper: Scores, ours: Scores) -> str:
    """What became of a third frame."""
    if not np.isnan(ours.passes):
        return f"passes {paper.passes:.0f} / {ours.passes:.0f} %"
    return "–" if np.isnan(ours.dropped) else f"dropped in {ours.dropped:.0f} %"


def suggestion_table(options: argparse.Namespace) -> list[str]:
    """The error over the number of demonstrations, with random and with suggested scenes."""
    task, counts = TASKS[1], range(3, 11)
    errors = {
        suggested: np.median(
            [
                _learning_curve(task, suggested, counts, [options.seed, 3, i])
                for i in range(options.sets // 2)
            ],
            axis=0,
        )
        for suggested in (False, True)
    }
    rows = [[n, f"{errors[False][i]:.4f}", f"{errors[True][i]:.4f}"] for i, n in enumerate(counts)]
    return table(["demonstrations", "random scenes: d_total", "suggested scenes: d_total"], rows)


def _learning_curve(task: SyntheticTask, suggested: bool, counts: range, seed: list[int]) -> list[float]:
    """The error after each demonstration."""
    rng = np.random.default_rng(seed)
    tried = [draw_scene(task, rng) for _ in range(50)]
    truth = np.stack([true_path(task, scene) for scene in tried])
    demos = [demonstrate(task, rng) for _ in range(counts[0])]
    curve = []
    for _ in counts:
        model = TaskParameterisedGMM.fit(demos)
        paths = np.stack([p.mean for p in model.reproduce_many([planar(scene) for scene in tried])])
        curve.append(float(np.linalg.norm(paths - truth, axis=-1).mean()))
        offered = [draw_scene(task, rng) for _ in range(30)]
        frames = [planar(scene) for scene in offered]
        index = suggest_demonstration(model, frames, [d.frames for d in demos]).index if suggested else 0
        demos.append(demonstrate(task, rng, scene=offered[index]))
    return curve


def page(options: argparse.Namespace) -> str:
    """The whole page."""
    intro = Path(__file__).with_name("paper_tables_intro.md").read_text(encoding="utf-8")
    parts = [
        intro.format(sets=options.sets, scenes=options.scenes, seed=options.seed),
        "## Finding the frames' kinds (the paper's Tables 1 and 2)\n",
        *identifier_table(options),
        "Frames turned little, or seen badly; Tasks 1-3 mixed, share of runs with both kinds right:\n",
        *hard_identifier_table(options),
        "## Smoothness, efficiency, reachability (the paper's Table 4)\n",
        *table_4(options),
        "## All cases\n",
        *comparison(options),
        "## Which scene to demonstrate next\n",
        "Task 1, median error in new scenes; a suggested scene is the best of 30 drawn at random:\n",
        *suggestion_table(options),
    ]
    return "\n".join(parts)


def main() -> int:
    """Run all experiments."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--sets", type=int, default=40, help="training sets per figure")
    parser.add_argument("--scenes", type=int, default=100, help="new scenes per training set")
    parser.add_argument("--identifier-sets", type=int, default=200, help="training sets per identifier cell")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("docs"), help="folder of the page")
    options = parser.parse_args()
    warnings.filterwarnings("ignore", message="component", category=UserWarning)
    text = page(options)
    options.out.mkdir(parents=True, exist_ok=True)
    target = options.out / "paper_tables.md"
    target.write_text(text + "\n", encoding="utf-8")
    print(text)
    print(f"written to {target}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
