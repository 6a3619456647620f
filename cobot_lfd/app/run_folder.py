"""A folder for one evaluation: where it came from, a line per episode as it ends, and the summary."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from pathlib import Path

from cobot_lfd.app.disk import told, write_file
from cobot_lfd.app.evaluate import Job, evaluate
from cobot_lfd.app.provenance import Provenance
from cobot_lfd.app.result_log import append_result
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.summary import Summary
from cobot_lfd.errors import DataError

RESULTS, SUMMARY, PROVENANCE = "results.jsonl", "summary.json", "provenance.json"


def evaluate_into(
    folder: Path,
    job: Job,
    seeds: Sequence[int],
    *,
    executor: Executor | None = None,
    report: Callable[[EpisodeResult], None] | None = None,
) -> Summary:
    """Evaluate, and keep every result as soon as it is there.

    Args:
        folder: A new folder, or one without results.
        job: What is evaluated.
        seeds: One for each episode.
        executor: Where the episodes run; here and one after the other without it.
        report: Called with each result.

    Raises:
        DataError: If the folder holds results already, or cannot be written.
        DescriptionError: If there is no such scene or robot.
        ModelError: If the model cannot be read.
    """
    if (folder / RESULTS).exists():
        raise DataError(f"{folder} holds the results of an evaluation already; choose another folder.")
    options: dict[str, str | float | bool | None] = {
        "scene": job.scene,
        "robot": job.robot,
        "covered": job.covered,
    }
    provenance = Provenance.collect(seeds=seeds, options=options, model=job.model)
    results = []
    episodes = evaluate(job, seeds, executor=executor)
    with told(folder, "write results to"):
        folder.mkdir(parents=True, exist_ok=True)
    provenance.save(folder / PROVENANCE)
    for result in episodes:
        append_result(folder / RESULTS, result)
        results.append(result)
        if report is not None:
            report(result)
    summary = Summary.of(results)
    write_file(folder / SUMMARY, f"{summary.to_json()}\n".encode())
    return summary
