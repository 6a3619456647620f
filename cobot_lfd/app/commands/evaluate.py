"""cobot-lfd evaluate: many new scenes, counted."""

import shlex
import sys
from pathlib import Path
from time import monotonic
from typing import Literal

from tyro.conf import OmitArgPrefixes, Positional

from cobot_lfd.app.commands.exit_codes import DONE, INTERRUPTED, NOT_ALL_SUCCEEDED
from cobot_lfd.app.commands.options import require_at_least, require_positive
from cobot_lfd.app.evaluation.options import PlanOptions
from cobot_lfd.app.evaluation.perturbation import Sweep
from cobot_lfd.app.evaluation.run import Where, run
from cobot_lfd.app.progress import Reporter, progress
from cobot_lfd.app.provenance import Provenance
from cobot_lfd.app.report.cells import cells_of, cells_text
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.run_folder import RESULTS, RunFolder
from cobot_lfd.app.summary import Summary
from cobot_lfd.errors import CobotError

_UNSPOILT = Sweep()
"""Nothing is made harder."""


def evaluate(
    models: Positional[tuple[Path, ...]] = (),
    *,
    scene: tuple[str, ...] = (),
    robot: tuple[str, ...] = ("panda",),
    method: tuple[str, ...] = (),
    demos: Path | None = None,
    out: Path | None = None,
    resume: Path | None = None,
    plan: Path | None = None,
    episodes: int = 100,
    seed: int = 0,
    workers: int = 1,
    scheduler: str | None = None,
    time_limit: float = 300.0,
    videos: Literal["none", "failures"] = "none",
    covered: bool = False,
    camera: Path | None = None,
    sweep: OmitArgPrefixes[Sweep] = _UNSPOILT,
    json: bool = False,
) -> int:
    """Perform the task in many new scenes and count how often it is done.

    Every combination of models, methods, scenes, robots, perturbations and seeds is run. Each result is on
    disk as soon as it is there; a run that was stopped goes on with --resume.

    Args:
        models: Files of fitted models.
        scene: Names of the scenes.
        robot: Names of the robots.
        method: Methods that are fitted to the demonstrations: improved, paper, conventional, line, world-gmr,
            dmp, or package.module:Class for one of your own.
        demos: Folder of the demonstrations that methods learn from.
        out: New folder for the results: the plan, a line per episode, a summary, and where they come from.
        resume: Folder of a run that was stopped; nothing else needs to be said.
        plan: TOML file that says what is evaluated, in place of the options that do.
        episodes: How many seeds.
        seed: Of the first episode; each further one has the next.
        workers: How many episodes run at once; the results do not depend on it.
        scheduler: Address of a dask.distributed scheduler whose workers run the episodes.
        time_limit: Time for one episode [s], after which its process is ended.
        videos: Of which episodes videos are made.
        covered: Cover the camera's lens; no episode can then succeed.
        camera: File of a calibrated camera (cobot-lfd calibrate), by which pictures are read.
        sweep: What is made harder; several values of an option are all tried.
        json: Print the summary as JSON.
    """
    require_positive("workers", workers)
    require_at_least(0, "seed", seed)
    where = Where(workers, scheduler, time_limit, videos == "failures")
    if resume is not None:
        folder = RunFolder.open(resume)
        folder.require_unchanged()
        return _carry_out(folder, where, json=json)
    require_positive("episodes", episodes)
    options = PlanOptions(
        models=models, scene=scene, robot=robot, method=method, demos=demos,
        episodes=episodes, seed=seed, covered=covered, camera=camera, sweep=sweep,
    )  # fmt: skip
    if plan is not None:
        if options != PlanOptions(scene=()):
            raise CobotError("--plan says what is evaluated; leave out models and options that say so, too.")
        options = PlanOptions.read(plan)
    return _carry_out(_begin(options, out), where, json=json)


def _begin(options: PlanOptions, out: Path | None) -> RunFolder:
    """A new folder with the plan of these options."""
    if out is None:
        raise CobotError("say where the results go: --out FOLDER (or --resume FOLDER to go on with a run).")
    if not options.scene:
        raise CobotError("say what is performed: --scene NAME; see 'cobot-lfd scenes'.")
    plan = options.plan()
    provenance = Provenance.collect(seeds=plan.seeds, options=options.model_dump(mode="json"))
    return RunFolder.create(out, plan, provenance)


def _carry_out(folder: RunFolder, where: Where, *, json: bool) -> int:
    """Run what remains, and tell."""
    n_remaining = len(folder.remaining())
    if n_remaining < len(folder.plan):
        print(f"{len(folder.plan) - n_remaining} of {len(folder.plan)} episodes are done", file=sys.stderr)
    try:
        with progress("evaluating", n_remaining) as report:
            summary = run(folder, where, report=Teller(report, n_remaining))
    except KeyboardInterrupt:
        print(
            f"\ncobot-lfd: interrupted; every result so far is kept. Go on with:\n"
            f"  cobot-lfd evaluate --resume {shlex.quote(str(folder.path))}",
            file=sys.stderr,
        )
        return INTERRUPTED
    print(summary.to_json() if json else _told(folder, summary))
    return DONE if summary.successes == summary.episodes else NOT_ALL_SUCCEEDED


class Teller:
    """Tells each result with the success, the rate and the time left so far."""

    def __init__(self, report: Reporter, n_episodes: int) -> None:
        self._report = report
        self._left = n_episodes
        self._done = self._successes = 0
        self._since = monotonic()

    def __call__(self, result: EpisodeResult) -> None:
        """One more episode has ended."""
        self._done += 1
        self._left -= 1
        self._successes += result.verdict.succeeded
        rate = self._done / max(monotonic() - self._since, 1e-9)
        so_far = f"{self._successes / self._done:.0%} so far, {rate:.2f}/s, {self._left / rate:.0f} s left"
        self._report(f"{result.contender}, seed {result.seed}: {result.verdict.sentence} ({so_far})")


def _told(folder: RunFolder, summary: Summary) -> str:
    cells = cells_of(folder.results())
    lines = [summary.to_text(), *([cells_text(cells)] if len(cells) > 1 else [])]
    lines += [
        f"the results are in {folder.path / RESULTS}; look at them with: cobot-lfd report {folder.path}"
    ]
    return "\n".join(lines)
