"""Every scene with every robot: success of the improved and the conventional method, as a table.

The demonstrations are recorded with one robot; all perform what is learnt from them. What has been run
stays in the folder, so that a benchmark that was stopped goes on where it was.
"""

import sys
from collections import Counter
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import tyro

from cobot_lfd.app.demonstrations.store import list_episodes
from cobot_lfd.app.evaluation.options import PlanOptions
from cobot_lfd.app.evaluation.run import Where, run
from cobot_lfd.app.provenance import Provenance
from cobot_lfd.app.recording.record import record_session
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.run_folder import PLAN, RunFolder
from cobot_lfd.app.summary import wilson_interval
from robots import has_urdf, load_robot, robot_names
from scenes import scene_names, variant_names

TEACHER = "panda"
METHODS = ("improved", "conventional")
TARGETS = {"": 0.97, "clutter": 0.95, "wide": 0.90}
MOST_SEEDS = 5  # of failed episodes that the table names


def main(
    *,
    out: Path,
    table: Path | None = None,
    scene: tuple[str, ...] = scene_names(),
    robot: tuple[str, ...] = robot_names(),
    variant: tuple[str, ...] = ("", *variant_names()),
    episodes: int = 100,
    seed: int = 5000,
    demos: int = 6,
    workers: int = 1,
) -> int:
    """Run the matrix of scenes, variants, robots and methods, and write its table.

    Args:
        out: Folder for demonstrations and results.
        table: File (.md) for the table; printed without it.
        scene: Names of the scenes.
        robot: Names of the robots.
        variant: Names of the variants; the empty name stands for the scene as it is.
        episodes: How many seeds.
        seed: The first of them; none of them may have been used while developing.
        demos: How many demonstrations each scene is learnt from.
        workers: How many episodes run at once.
    """
    installed = [name for name in robot if _installed(name)]
    for name, kind, arm in product(scene, variant, installed):
        _run(out, name, kind, arm, range(seed, seed + episodes), demos, workers)
    text = "\n".join(table_lines(out)) + "\n"
    if table is None:
        print(text)
    else:
        table.write_text(text, encoding="utf-8")
    return 0


def _installed(name: str) -> bool:
    robot = load_robot(name)
    return has_urdf(robot.urdf, robot.package)


def _run(out: Path, scene: str, variant: str, robot: str, seeds: range, demos: int, workers: int) -> None:
    """One cell of the matrix, or what remains of it."""
    folder = out / f"{scene}@{variant}" / robot
    if not (folder / PLAN).exists():
        options = PlanOptions(
            scene=(f"{scene}@{variant}" if variant else scene,),
            robot=(robot,),
            method=METHODS,
            demos=_demonstrations(out, scene, demos),
            episodes=len(seeds),
            seed=seeds.start,
        )
        plan = options.plan()
        told = Provenance.collect(seeds=plan.seeds, options=options.model_dump(mode="json"))
        RunFolder.create(folder, plan, told)
    summary = run(RunFolder.open(folder), Where(workers))
    print(
        f"{scene}@{variant} {robot}: {summary.successes} of {summary.episodes}", file=sys.stderr, flush=True
    )


def _demonstrations(out: Path, scene: str, n: int) -> Path:
    """A folder with demonstrations of a scene."""
    folder = out / "demonstrations" / scene
    missing = n - len(list_episodes(folder) if folder.is_dir() else ())
    if missing > 0:
        record_session(scene, TEACHER, folder, n_episodes=missing, first_seed=0)
    return folder


def table_lines(out: Path) -> Iterator[str]:
    """The table of all that has been run in a folder."""
    yield "| scene | variant | robot | improved | conventional | target | failures of the improved method |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    for plan in sorted(out.glob(f"*@*/*/{PLAN}")):
        scene, variant = plan.parent.parent.name.split("@")
        results = RunFolder.open(plan.parent).results()
        by_method = {m: [r for r in results if r.method == m] for m in METHODS}
        if not all(by_method.values()):
            continue
        target = "reached" if _rate(by_method["improved"]) >= TARGETS[variant] else "missed"
        cells = [scene, variant or "-", plan.parent.name, *(_told(by_method[m]) for m in METHODS)]
        yield f"| {' | '.join(cells)} | {target} | {_failures(by_method['improved'])} |"


def _rate(results: list[EpisodeResult]) -> float:
    return sum(result.verdict.succeeded for result in results) / len(results)


def _told(results: list[EpisodeResult]) -> str:
    successes = sum(result.verdict.succeeded for result in results)
    low, high = wilson_interval(successes, len(results))
    return f"{successes}/{len(results)} ({100 * low:.0f}–{100 * high:.0f} %)"


def _failures(results: list[EpisodeResult]) -> str:
    """Outcome counts, with the first seeds of each."""
    failed = [result for result in results if not result.verdict.succeeded]
    counts = Counter(result.verdict.outcome.kind for result in failed)
    told = []
    for kind, count in counts.most_common():
        seeds = [str(result.seed) for result in failed if result.verdict.outcome.kind == kind][:MOST_SEEDS]
        told.append(f"{count} × {kind} (seeds {', '.join(seeds)})")
    return "; ".join(told)


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
