"""Running a plan: here, in processes of this machine, or on a cluster."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from cobot_lfd.app.evaluation.cluster import PerformWithin, cluster_at
from cobot_lfd.app.evaluation.drive import drive
from cobot_lfd.app.evaluation.perform import Performed, perform
from cobot_lfd.app.evaluation.plan import Trial
from cobot_lfd.app.evaluation.workers import WorkerProcesses
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.run_folder import RunFolder
from cobot_lfd.app.summary import Summary

_AHEAD = 2  # trials that are handed over beyond those that run, so that no worker waits


@dataclass(frozen=True, slots=True)
class Where:
    """Where episodes run.

    Attributes:
        workers: How many processes of this machine.
        scheduler: Address of a dask scheduler; its workers are used instead.
        time_limit: For one episode [s].
        film_failures: Whether failed episodes are run again for a video.
    """

    workers: int = 1
    scheduler: str | None = None
    time_limit: float = 300.0
    film_failures: bool = False


def run(folder: RunFolder, where: Where, *, report: Callable[[EpisodeResult], None] | None = None) -> Summary:
    """Run what remains of a plan.

    Args:
        folder: Where the plan is and the results go.
        where: Where episodes run; the results do not depend on it.
        report: Called with each new result.

    Raises:
        CobotError: If the folder cannot be used, or there is no such cluster.
    """
    drive_there = _on_cluster if where.scheduler else _in_processes
    return folder.carry_out(partial(drive_there, where), report)


def _in_processes(where: Where, trials: Sequence[Trial]) -> Iterator[Performed]:
    if not trials:
        return
    task = partial(perform, film_failures=where.film_failures)
    n_workers = min(where.workers, len(trials))
    with WorkerProcesses(n_workers, time_limit=where.time_limit) as executor:
        at_once = n_workers + _AHEAD
        yield from drive(executor, task, trials, at_once=at_once, time_limit=where.time_limit)


def _on_cluster(where: Where, trials: Sequence[Trial]) -> Iterator[Performed]:
    task = PerformWithin(where.time_limit, where.film_failures)
    with cluster_at(where.scheduler or "") as cluster:
        # None is handed over ahead: what waits at a worker that dies would be suspected with it.
        at_once, limit = cluster.n_workers, where.time_limit
        yield from drive(cluster.executor, task, trials, at_once=at_once, time_limit=limit)
