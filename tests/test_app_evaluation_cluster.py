"""A real dask cluster of processes of its own: the same results, also when a worker is killed on the way."""

import gc
import os
import re
import signal
import subprocess
import sys
import time
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
def process(log: Path, *words: str) -> Iterator[None]:
    """A process of the library, whose words go to a file."""
    with log.open("w") as stream:
        started = subprocess.Popen([*DASK, *words], stderr=stream, start_new_session=True)
        try:
            yield
        finally:
            os.killpg(started.pid, signal.SIGKILL)
            started.wait()


def said(log: Path, pattern: str, n_times: int = 1) -> str:
    """The first match in what a process says, as soon as it has said such a thing so many times."""
    for _ in range(1200):
        found = re.findall(pattern, log.read_text())
        if len(found) >= n_times:
            return str(found[0])
        time.sleep(0.05)
    raise AssertionError(f"the process did not say {pattern}:\n{log.read_text()}")


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A scheduler and two workers, each with a nanny that starts it again when it dies."""
    folder = tmp_path_factory.mktemp("dask")
    with process(
        folder / "scheduler.log", "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"
    ):
        address = said(folder / "scheduler.log", r"Scheduler at:\s+(tcp://\S+)")
        options = ["--nworkers", "2", "--nthreads", "1", "--no-dashboard", "--local-directory", str(folder)]
        with process(folder / "workers.log", "worker", address, *options):
            said(folder / "workers.log", "Registered to", n_times=2)
            yield address
    gc.collect()  # while its warnings are still known to be the library's


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
