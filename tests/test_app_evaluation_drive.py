"""Driving workers: an episode whose process dies, hangs or raises costs itself and no other."""

import time
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from cobot_lfd.app.evaluation.drive import drive
from cobot_lfd.app.evaluation.perform import Performed
from cobot_lfd.app.evaluation.plan import Trial
from cobot_lfd.app.evaluation.workers import WorkerProcesses
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.errors import CobotError
from cobot_lfd.outcome import Outcome
from tests.evaluation_examples import DIES, DIES_ONCE, HANGS, RAISES, IllBehaved, small_plan, stand_in

pytestmark = pytest.mark.simulator


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[int, EpisodeResult]:
    """Eight episodes, four of which misbehave, in two processes."""
    perform = IllBehaved(tmp_path_factory.mktemp("notes"))
    with WorkerProcesses(2, time_limit=4.0) as executor:
        done = list(drive(executor, perform, small_plan().trials(), at_once=4, time_limit=4.0))
    assert len(done) == 8
    return {performed.result.seed: performed.result for performed in done}


def test_every_other_episode_has_its_result(results: dict[int, EpisodeResult]) -> None:
    for trial in small_plan().trials():
        if trial.seed not in (DIES, HANGS, RAISES):
            expected = stand_in(trial).result.comparable_json()
            assert results[trial.seed].comparable_json() == expected


def test_what_dies_twice_counts_as_crashed(results: dict[int, EpisodeResult]) -> None:
    assert results[DIES].verdict.sentence == "the process that ran the episode died: twice"
    assert results[DIES_ONCE].verdict.outcome is not Outcome.CRASHED


def test_what_hangs_counts_as_a_timeout(results: dict[int, EpisodeResult]) -> None:
    verdict = results[HANGS].verdict
    assert verdict.outcome is Outcome.TIMEOUT
    assert verdict.detail == "the program took longer than 4 s, twice"


def test_what_raises_counts_as_an_internal_error(results: dict[int, EpisodeResult]) -> None:
    verdict = results[RAISES].verdict
    assert verdict.outcome is Outcome.INTERNAL_ERROR
    assert verdict.detail == "ZeroDivisionError: on purpose"


def test_an_executor_that_never_ends_a_trial_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """A cluster cannot end a task; the trial is given up after its limit and a grace."""

    class Silent(Executor):
        def submit(self, *_: Any, **__: Any) -> Future[Any]:
            return Future()

    monkeypatch.setattr("cobot_lfd.app.evaluation.drive._GRACE", 0.1)
    monkeypatch.setattr("cobot_lfd.app.evaluation.drive._LOOK_EVERY", 0.05)
    start = time.monotonic()
    done = list(drive(Silent(), stand_in, small_plan(2).trials(), at_once=1, time_limit=0.1))
    assert [performed.result.verdict.outcome for performed in done] == [Outcome.TIMEOUT] * 2
    assert time.monotonic() - start < 5.0  # [s]


def test_what_a_user_can_mend_is_a_failed_generation_and_not_tried_again() -> None:
    attempts = []

    def refuse(trial: Trial) -> Performed:
        attempts.append(trial.seed)
        raise CobotError("no such frame")

    with ThreadPoolExecutor(1) as executor:
        done = list(drive(executor, refuse, small_plan(1).trials(), at_once=1, time_limit=9.0))
    assert done[0].result.verdict.outcome is Outcome.GENERATION_FAILED
    assert attempts == [0]


def test_an_executor_that_is_broken_altogether_ends_in_results() -> None:
    executor = ThreadPoolExecutor(1)
    executor.shutdown()
    done = list(drive(executor, stand_in, small_plan(2).trials(), at_once=1, time_limit=9.0))
    assert [performed.result.verdict.outcome for performed in done] == [Outcome.INTERNAL_ERROR] * 2


def test_workers_end_with_their_executor() -> None:
    with WorkerProcesses(1, time_limit=60.0) as executor:
        pid = executor.submit(_process_id).result()
    assert not Path(f"/proc/{pid}").exists()


def _process_id() -> int:
    import os

    return os.getpid()
