"""cobot-lfd evaluate: many new scenes, counted."""

from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import AbstractContextManager, nullcontext
from multiprocessing import get_context
from pathlib import Path

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE, NOT_ALL_SUCCEEDED
from cobot_lfd.app.commands.options import require_positive
from cobot_lfd.app.evaluate import Job
from cobot_lfd.app.progress import progress
from cobot_lfd.app.run_folder import RESULTS, evaluate_into


def evaluate(
    model: Positional[Path],
    *,
    scene: str,
    out: Path,
    robot: str = "panda",
    episodes: int = 100,
    seed: int = 0,
    workers: int = 1,
    covered: bool = False,
    json: bool = False,
) -> int:
    """Perform the task in many new scenes and count how often it is done.

    Args:
        model: File of the model.
        scene: Name of the scene.
        out: New folder for the results: a line per episode, a summary, and where they come from.
        robot: Name of the robot.
        episodes: How many episodes.
        seed: Of the first episode; each further one has the next.
        workers: How many episodes run at once; the results do not depend on it.
        covered: Cover the camera's lens; no episode can then succeed.
        json: Print the summary as JSON.
    """
    require_positive("episodes", episodes)
    require_positive("workers", workers)
    job = Job(scene, robot, model, covered)
    with _executor(workers) as executor, progress("evaluating", episodes) as report:
        summary = evaluate_into(
            out,
            job,
            range(seed, seed + episodes),
            executor=executor,
            report=lambda result: report(f"seed {result.seed}: {result.verdict.sentence}"),
        )
    print(summary.to_json() if json else f"{summary.to_text()}\nthe results are in {out / RESULTS}")
    return DONE if summary.successes == summary.episodes else NOT_ALL_SUCCEEDED


def _executor(workers: int) -> AbstractContextManager[Executor | None]:
    """Processes that share nothing with this one; none for a single worker."""
    return nullcontext() if workers == 1 else ProcessPoolExecutor(workers, mp_context=get_context("spawn"))
