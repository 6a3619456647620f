"""One trial of a plan, wherever it runs: the episode, its measures, and a picture where it failed."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from traceback import format_exception_only
from typing import Any

from cobot_lfd.app.compliance import Compliance
from cobot_lfd.app.episode import Bench, EpisodeRun, run_episode
from cobot_lfd.app.evaluation.contender import Contender, learnt
from cobot_lfd.app.evaluation.measures import path_measures
from cobot_lfd.app.evaluation.perturbation import Perturbation
from cobot_lfd.app.evaluation.plan import Trial
from cobot_lfd.app.pictures.draw import encode_small
from cobot_lfd.app.pictures.film import filming
from cobot_lfd.app.pictures.illustrate import drawn_view
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.errors import CobotError
from cobot_lfd.outcome import Outcome, Verdict
from robots import Kinematics, load_robot
from scenes import connect, load_scene

_PICTURE_WIDTH = 480  # [px]; readable on a phone, and a thousand of them in a report of a few megabytes


@dataclass(frozen=True, slots=True)
class Performed:
    """What comes back from a trial.

    Attributes:
        result: What happened.
        picture: Of a failed episode: what the camera saw, with frames and path, as WebP; empty for others.
        video: Of a failed episode, where videos were asked for, as WebM; empty for others.
    """

    result: EpisodeResult
    picture: bytes = b""
    video: bytes = b""


def perform(trial: Trial, *, film_failures: bool = False) -> Performed:
    """Run a trial; equal trials give equal results, computation times aside.

    Args:
        trial: What to run.
        film_failures: Whether a failed episode is run again for a video of it.
    """
    bench = bench_of(trial)
    run = run_episode(bench, trial.seed)
    metrics = {**run.result.metrics, **_measures(bench, run)}
    result = labelled(trial, replace(run.result, metrics=metrics))
    if result.verdict.succeeded:
        return Performed(result)
    return Performed(result, _picture(bench, run), film(trial) if film_failures else b"")


def film(trial: Trial) -> bytes:
    """A video of a trial, as WebM."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "episode.webm"
        with filming(file) as camera:
            run_episode(bench_of(trial), trial.seed, film=camera)
        return file.read_bytes() if file.exists() else b""


def bench_of(trial: Trial) -> Bench:
    """What the episode of a trial needs."""
    return _bench(trial.scene, trial.robot, trial.perturbation, trial.contender)


def fallen(trial: Trial, verdict: Verdict) -> Performed:
    """What is recorded of a trial that gave no result."""
    method = trial.contender.method or trial.contender.label
    result = EpisodeResult(
        seed=trial.seed, scene=trial.scene, robot=trial.robot, method=method, verdict=verdict
    )
    return Performed(labelled(trial, result))


def verdict_on(error: BaseException) -> Verdict:
    """How an episode counts that ended with an error of the program."""
    if isinstance(error, CobotError):
        return Verdict(Outcome.GENERATION_FAILED, str(error))
    return Verdict(Outcome.INTERNAL_ERROR, "".join(format_exception_only(error)).strip())


def labelled(trial: Trial, result: EpisodeResult) -> EpisodeResult:
    """The result with its place in the plan."""
    return replace(
        result,
        run=trial.run,
        trial=trial.number,
        contender=trial.contender.label,
        perturbation=trial.perturbation.told(),
    )


@lru_cache(maxsize=64)
def _bench(scene: str, robot: str, perturbation: Perturbation, contender: Contender) -> Bench:
    described = load_scene(scene)
    tool = described.task.tool
    return Bench(
        scene_name=scene,
        robot_name=robot,
        scene=perturbation.of_scene(described),
        robot=load_robot(robot, tool),
        kinematics=_kinematics(robot, tool),
        model=learnt(contender, perturbation.demonstrations),
        covered=perturbation.covered,
        misjudge=perturbation.of_view,
        compliance=Compliance() if perturbation.compliant else None,
        timing=perturbation.timing,
        client=_simulation(),
    )


@lru_cache(maxsize=1)
def _simulation() -> Any:
    """One for all episodes of this process: to empty it takes far less time than to start another."""
    return connect()


@lru_cache(maxsize=8)
def _kinematics(robot: str, tool: str) -> Kinematics:
    return Kinematics(load_robot(robot, tool))


def _measures(bench: Bench, run: EpisodeRun) -> dict[str, float]:
    if run.path is None:
        return {}
    return path_measures(bench.scene, run.true_frames, run.result.seed, run.path.mean)


def _picture(bench: Bench, run: EpisodeRun) -> bytes:
    return encode_small(drawn_view(bench.scene, run.view, run.path, detour=run.detour), width=_PICTURE_WIDTH)
