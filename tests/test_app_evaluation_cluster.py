"""A real dask cluster of processes of its own: the same results, also when a worker is killed on the way."""

import os
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from cobot_lfd.app.evaluation.cluster import cluster_at
from cobot_lfd.app.evaluation.drive import drive
from cobot_lfd.errors import CobotError
from tests.evaluation_examples import DIES, DIES_ONCE, HANGS, RAISES, IllBehaved, small_plan, stand_in

pytest.importorskip(
    "distributed", reason="the cluster's library is an extra: pip install 'cobot-lfd[cluster]'"
)
# The library leaves event loops and sockets to be collected; nothing of that is ours.
pytestmark = [pytest.mark.simulator, pytest.mark.filterwarnings("ignore::ResourceWarning")]

DASK = [sys.executable, "-m", "dask"]


@contextmanager
def process(*words: str) -> Iterator["subprocess.Popen[str]"]:
    started = subprocess.Popen([*DASK, *words], stderr=subprocess.PIPE, text=True, start_new_session=True)
    try:
        yield started
    finally:
        os.killpg(started.pid, signal.SIGKILL)
        started.wait()


def read_until(started: "subprocess.Popen[str]", pattern: str) -> str:
    """The first match in what the process says; what it says later is read and dropped."""
    assert started.stderr is not None
    for line in started.stderr:
        found = re.search(pattern, line)
        if found:
            threading.Thread(target=started.stderr.read, daemon=True).start()
            return found[1]
    raise AssertionError(f"the process ended without saying {pattern}")


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A scheduler and two workers, each with a nanny that starts it again when it dies."""
    folder = str(tmp_path_factory.mktemp("dask"))
    with process("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard") as scheduler:
        address = read_until(scheduler, r"Scheduler at:\s+(tcp://\S+)")
        options = ["--nworkers", "2", "--nthreads", "1", "--no-dashboard", "--local-directory", folder]
        with process("worker", address, *options) as workers:
            for _ in range(2):
                read_one(workers)
            threading.Thread(target=workers.stderr.read, daemon=True).start()  # type: ignore[union-attr]
            yield address


def read_one(workers: "subprocess.Popen[str]") -> None:
    """Wait until one more worker is there."""
    assert workers.stderr is not None
    for line in workers.stderr:
        if "Registered to" in line:
            return
    raise AssertionError("a worker did not start")


def test_a_cluster_gives_the_same_results_though_a_worker_is_killed(cluster: str, tmp_path: Path) -> None:
    """One seed kills the worker that runs it first."""
    perform = IllBehaved(tmp_path)
    trials = [trial for trial in small_plan(12).trials() if trial.seed not in (DIES, HANGS, RAISES)]
    with cluster_at(cluster) as connected:
        assert connected.n_workers == 2
        done = list(drive(connected.executor, perform, trials, at_once=2, time_limit=60.0))
    assert (tmp_path / str(DIES_ONCE)).exists()
    assert len(done) == len(trials)
    lines = {performed.result.seed: performed.result.comparable_json() for performed in done}
    assert lines == {trial.seed: stand_in(trial).result.comparable_json() for trial in trials}


def test_a_missing_scheduler_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cobot_lfd.app.evaluation.cluster._CONNECTING", 0.5)
    with (
        pytest.raises(CobotError, match=r"no dask scheduler answers at tcp://127\.0\.0\.1:9"),
        cluster_at("tcp://127.0.0.1:9"),
    ):
        pass
