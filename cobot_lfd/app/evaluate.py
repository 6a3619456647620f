"""Batches of episodes: a result depends on its seed only, not on how many run, in which order or where."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path

from cobot_lfd.app.episode import Bench, run_episode
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.outcome import Outcome, Verdict
from robots import Kinematics, load_robot
from scenes import load_scene


@dataclass(frozen=True, slots=True)
class Job:
    """What is evaluated; small enough to be sent to another process.

    Attributes:
        scene: Name of the scene.
        robot: Name of the robot.
        model: File of the model.
        covered: Whether something covers the camera's lens.
    """

    scene: str
    robot: str
    model: Path
    covered: bool = False


def evaluate(job: Job, seeds: Sequence[int], *, executor: Executor | None = None) -> Iterator[EpisodeResult]:
    """The results of the episodes with these seeds, in the order of the seeds, each as soon as it is there.

    No episode ends the batch: whatever goes wrong in one becomes its outcome.

    Args:
        job: What is evaluated.
        seeds: One for each episode.
        executor: Where the episodes run; here and one after the other without it.

    Raises:
        DescriptionError: If there is no such scene or robot.
        ModelError: If the model cannot be read.
    """
    bench_for(job)
    run = partial(evaluate_one, job)
    yield from executor.map(run, seeds) if executor else map(run, seeds)


def evaluate_one(job: Job, seed: int) -> EpisodeResult:
    """The result of one episode; a fault in the program is a result, too."""
    bench = bench_for(job)
    try:
        return run_episode(bench, seed).result
    except Exception as error:  # whatever it is, the other episodes go on
        verdict = Verdict(Outcome.INTERNAL_ERROR, f"{type(error).__name__}: {error}")
        return EpisodeResult(
            seed=seed, scene=job.scene, robot=job.robot, method=bench.model.method, verdict=verdict
        )


@lru_cache(maxsize=4)
def bench_for(job: Job) -> Bench:
    """What all episodes of a job share, read once in each process.

    Raises:
        DescriptionError: If there is no such scene or robot.
        ModelError: If the model cannot be read.
    """
    robot = load_robot(job.robot)
    return Bench(
        scene_name=job.scene,
        robot_name=job.robot,
        scene=load_scene(job.scene),
        robot=robot,
        kinematics=Kinematics(robot),
        model=TaskParameterisedGMM.load(job.model),
        covered=job.covered,
    )
