"""Every scene and variant with every robot: success of the improved and the conventional method, as a table.

The demonstrations are recorded with one robot; all perform what is learnt from them. Work is done in rounds
of a few seeds, the cells that matter most first, so that it can be stopped at any time: what has been run
stays in the folder, the same command goes on where it was, and the table is made of what is there.
"""

import fcntl
import sys
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path

import tyro

from cobot_lfd.app.demonstrations.store import list_episodes
from cobot_lfd.app.evaluation.drive import drive
from cobot_lfd.app.evaluation.options import PlanOptions
from cobot_lfd.app.evaluation.perform import Performed, perform
from cobot_lfd.app.evaluation.plan import Trial
from cobot_lfd.app.evaluation.workers import WorkerProcesses
from cobot_lfd.app.provenance import Provenance
from cobot_lfd.app.recording.record import record_session
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.run_folder import PLAN, RunFolder
from cobot_lfd.app.summary import wilson_interval
from robots import has_urdf, load_robot, robot_names
from scenes import scene_names, variant_names

TEACHER = "panda"
IMPROVED, CONVENTIONAL = "improved", "conventional"
PLAIN = "-"
"""Stands for a scene as it is, among its variants."""

TARGETS = {PLAIN: 0.97, "clutter": 0.95, "wide": 0.90}
MOST_SEEDS = 6  # of failed episodes that the table names, for each kind of failure
TIME_LIMIT = 1200.0  # [s] for one episode; generous, since the machine may be busy with other work
DriveTrials = Callable[[Sequence[Trial]], Iterator[Performed]]

AHEAD = 2  # episodes handed over beyond those that run, so that no worker waits


@dataclass(frozen=True, slots=True, order=True)
class Cell:
    """One row of the table.

    Attributes:
        scene: Name of the scene.
        variant: Name of the variant, or ``PLAIN``.
        robot: Name of the robot.
    """

    scene: str
    variant: str
    robot: str

    @property
    def scene_name(self) -> str:
        """The scene's name with its variant."""
        return self.scene if self.variant == PLAIN else f"{self.scene}@{self.variant}"

    @property
    def folder(self) -> str:
        """Where its results lie, below the folder of all."""
        return f"{self.scene}@{self.variant}/{self.robot}"


@dataclass(frozen=True, slots=True)
class Block:
    """What is run at a time: one method on a few seeds of one cell."""

    cell: Cell
    method: str
    seeds: range

    @property
    def folder(self) -> str:
        """Where its results lie, below the folder of all."""
        return f"{self.cell.folder}/{self.method}-{self.seeds.start}-{self.seeds.stop - 1}"


def main(
    *,
    out: Path,
    table: Path | None = None,
    scene: tuple[str, ...] = scene_names(),
    robot: tuple[str, ...] = robot_names(),
    variant: tuple[str, ...] = (PLAIN, *variant_names()),
    variants_with: tuple[str, ...] = (TEACHER,),
    rounds: int = 4,
    per_round: int = 25,
    seed: int = 10_000,
    demos: int = 6,
    workers: int = 1,
    only_table: bool = False,
) -> int:
    """Run the matrix of scenes, variants, robots and methods, and write its table.

    Each round runs the improved method on the same seeds of all cells; the first also the conventional one.

    Args:
        out: Folder for demonstrations and results.
        table: File (.md) for the table, written anew after each block; printed at the end without it.
        scene: Names of the scenes.
        robot: Names of the robots.
        variant: Names of the variants; '-' stands for the scene as it is.
        variants_with: Robots that perform the variants, too.
        rounds: How many rounds.
        per_round: Seeds of a round.
        seed: The first of them; none of them may have been used while developing.
        demos: How many demonstrations each scene is learnt from.
        workers: How many episodes run at once.
        only_table: Make the table of what is there, and run nothing.
    """
    arms = [name for name in robot if _installed(name)]
    cells = list(_cells(scene, variant, arms, variants_with))
    if not only_table:
        with WorkerProcesses(workers, time_limit=TIME_LIMIT) as executor:
            for block in _blocks(cells, rounds, per_round, seed):
                _carry_out(out, block, demos, partial(_drive, executor, workers + AHEAD))
                if table is not None:
                    _write(out, table)
    if table is None:
        print("\n".join(table_lines(out)))
    else:
        _write(out, table)
    return 0


def _installed(name: str) -> bool:
    robot = load_robot(name)
    return has_urdf(robot.urdf, robot.package)


def _cells(
    scenes: Sequence[str], variants: Sequence[str], robots: Sequence[str], variants_with: Sequence[str]
) -> Iterator[Cell]:
    """Scenes as they are before variants, and the robot that taught before the others."""
    arms = sorted(robots, key=lambda name: name != TEACHER)
    plain_first = sorted(variants, key=lambda name: name != PLAIN)
    for kind, arm, name in product(plain_first, arms, scenes):
        if kind == PLAIN or arm in variants_with:
            yield Cell(name, kind, arm)


def _blocks(cells: Sequence[Cell], rounds: int, per_round: int, seed: int) -> Iterator[Block]:
    for i in range(rounds):
        seeds = range(seed + i * per_round, seed + (i + 1) * per_round)
        for method in (IMPROVED, CONVENTIONAL) if i == 0 else (IMPROVED,):
            yield from (Block(cell, method, seeds) for cell in cells)


def _carry_out(out: Path, block: Block, demos: int, drive_trials: DriveTrials) -> None:
    """Run a block, or what remains of it."""
    path = out / block.folder
    if not (path / PLAN).exists():
        options = PlanOptions(
            scene=(block.cell.scene_name,),
            robot=(block.cell.robot,),
            method=(block.method,),
            demos=_demonstrations(out, block.cell.scene, demos),
            episodes=len(block.seeds),
            seed=block.seeds.start,
        )
        plan = options.plan()
        told = Provenance.collect(seeds=plan.seeds, options=options.model_dump(mode="json"))
        RunFolder.create(path, plan, told)
    folder = RunFolder.open(path)
    if not folder.remaining():
        return
    summary = folder.carry_out(drive_trials)
    print(f"{block.folder}: {summary.successes} of {summary.episodes}", file=sys.stderr, flush=True)


def _drive(executor: Executor, at_once: int, trials: Sequence[Trial]) -> Iterator[Performed]:
    return drive(executor, perform, trials, at_once=at_once, time_limit=TIME_LIMIT)


def _demonstrations(out: Path, scene: str, n: int) -> Path:
    """A folder with demonstrations of a scene; two processes that want the same ones do not both record."""
    folder = out / "demonstrations" / scene
    folder.mkdir(parents=True, exist_ok=True)
    with (out / "demonstrations" / f"{scene}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        missing = n - len(list_episodes(folder))
        if missing > 0:
            record_session(scene, TEACHER, folder, n_episodes=missing, first_seed=0)
    return folder


def _write(out: Path, table: Path) -> None:
    table.write_text("\n".join(table_lines(out)) + "\n", encoding="utf-8")


def table_lines(out: Path) -> Iterator[str]:
    """The table of all that has been run in a folder."""
    yield "| scene | variant | robot | improved | conventional | target | failures of the improved method |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    results = _results(out)
    for cell in sorted({cell for cell, _ in results}):
        improved, conventional = (results.get((cell, method), []) for method in (IMPROVED, CONVENTIONAL))
        yield (
            f"| {cell.scene} | {cell.variant} | {cell.robot} | {_told(improved)} | {_told(conventional)} "
            f"| {_reached(improved, TARGETS[cell.variant])} | {_failures(improved)} |"
        )


def _results(out: Path) -> Mapping[tuple[Cell, str], list[EpisodeResult]]:
    """All results in a folder, by cell and method."""
    results: dict[tuple[Cell, str], list[EpisodeResult]] = defaultdict(list)
    for plan in sorted(out.glob(f"*@*/*/*/{PLAN}")):
        block = plan.parent
        scene, variant = block.parent.parent.name.split("@")
        cell = Cell(scene, variant, block.parent.name)
        results[cell, block.name.split("-")[0]] += RunFolder.open(block).results()
    return results


def _told(results: Sequence[EpisodeResult]) -> str:
    if not results:
        return "not run"
    successes = sum(result.verdict.succeeded for result in results)
    low, high = wilson_interval(successes, len(results))
    return f"{successes}/{len(results)} ({100 * low:.0f}–{100 * high:.0f} %)"


def _reached(results: Sequence[EpisodeResult], target: float) -> str:
    """Whether the rate reaches the target; an interval around it may still reach below."""
    if not results:
        return ""
    rate = sum(result.verdict.succeeded for result in results) / len(results)
    return f"{'reached' if rate >= target else 'missed'} ({100 * target:.0f} %)"


def _failures(results: Sequence[EpisodeResult]) -> str:
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
