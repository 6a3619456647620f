"""Evaluation: a result depends on its seed only, and nothing that happens in an episode ends the batch."""

import json
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest

import cobot_lfd.app.evaluate as evaluation
from cobot_lfd.app.evaluate import Job, evaluate
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.run_folder import PROVENANCE, RESULTS, SUMMARY, evaluate_into
from cobot_lfd.errors import DataError, DescriptionError, ModelError
from cobot_lfd.outcome import Outcome

pytestmark = pytest.mark.simulator

SEEDS = range(1000, 1003)


@pytest.fixture(scope="module")
def job(model_file: Path) -> Job:
    return Job("pick_and_place", "panda", model_file)


def lines(results: Iterable[EpisodeResult]) -> list[str]:
    return [result.comparable_json() for result in results]


def test_results_do_not_depend_on_the_number_of_workers(job: Job) -> None:
    here = lines(evaluate(job, SEEDS))
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        assert lines(evaluate(job, SEEDS, executor=executor)) == here
    assert lines(evaluate(job, SEEDS[-1:])) == here[-1:]


def test_a_fault_in_one_episode_does_not_end_the_others(job: Job, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: object, seed: int) -> EpisodeResult:
        raise ZeroDivisionError(f"at {seed}")

    monkeypatch.setattr(evaluation, "run_episode", fail)
    results = list(evaluate(job, SEEDS))
    assert [result.verdict.outcome for result in results] == [Outcome.INTERNAL_ERROR] * 3
    assert results[1].verdict.detail == "ZeroDivisionError: at 1001"


def test_a_run_folder_holds_a_line_per_episode_and_its_summary(job: Job, tmp_path: Path) -> None:
    summary = evaluate_into(tmp_path / "run", job, SEEDS[:2])
    kept = [json.loads(line) for line in (tmp_path / "run" / RESULTS).read_text().splitlines()]
    assert [line["seed"] for line in kept] == [1000, 1001]
    assert json.loads((tmp_path / "run" / SUMMARY).read_text())["episodes"] == 2
    assert json.loads((tmp_path / "run" / PROVENANCE).read_text())["seeds"] == [1000, 1001]
    assert summary.successes == sum(line["success"] for line in kept)


def test_results_are_never_overwritten(job: Job, tmp_path: Path) -> None:
    (tmp_path / RESULTS).write_text("")
    with pytest.raises(DataError, match=r"holds the results of an evaluation already; choose another folder"):
        evaluate_into(tmp_path, job, SEEDS)


def test_what_is_missing_is_told_before_the_first_episode(job: Job, tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match="no scene named 'nowhere'"):
        next(evaluate(Job("nowhere", "panda", job.model), SEEDS))
    with pytest.raises(ModelError, match=r"none\.npz"):
        next(evaluate(Job("pick_and_place", "panda", tmp_path / "none.npz"), SEEDS))
