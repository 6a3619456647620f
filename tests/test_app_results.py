"""Results of episodes: exact lines, crash-safe files, honest summaries."""

import json
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import binomtest

from cobot_lfd.app.result_log import append_result, append_results, read_results
from cobot_lfd.app.results import EpisodeResult, SeenObject, symmetric_angle_error
from cobot_lfd.app.summary import Summary, wilson_interval
from cobot_lfd.errors import DataError
from cobot_lfd.frame import Frame
from cobot_lfd.outcome import Outcome
from tests.app_examples import detection, result, seen


def test_a_line_brings_back_every_bit() -> None:
    original = result(outcome=Outcome.OBJECT_NOT_SEEN, detail="cube: größer\nals 1 cm")
    assert EpisodeResult.from_json(original.to_json()) == original
    assert "\n" not in original.to_json()


def test_lines_differ_in_their_times_only() -> None:
    slow = replace(result(), times={"render": 9.0})
    assert slow.to_json() != result().to_json()
    assert slow.comparable_json() == result().comparable_json()
    with_times, without = json.loads(slow.to_json()), json.loads(slow.comparable_json())
    assert with_times.pop("times") == {"render": 9.0}
    assert with_times == without


def test_a_result_travels_between_processes() -> None:
    assert pickle.loads(pickle.dumps(result())) == result()


@pytest.mark.parametrize("line", ["", "[1]", "{}", '{"outcome": "won"}', result().to_json()[:-20]])
def test_a_line_that_is_no_result_is_told(line: str) -> None:
    with pytest.raises(DataError, match="is no result of an episode"):
        EpisodeResult.from_json(line)


@pytest.mark.parametrize("symmetry", [1, 2, 4])
def test_turns_that_look_the_same_are_no_error(symmetry: int) -> None:
    for turns in range(-3, 4):
        error = symmetric_angle_error(0.3 + turns * 2 * np.pi / symmetry + 0.01, 0.3, symmetry)
        assert_allclose(error, 0.01, atol=1e-12)  # [rad]


def test_angle_error_is_largest_half_a_turn_away() -> None:
    angles = np.linspace(-7.0, 7.0, 1001)
    errors = [symmetric_angle_error(angle, 0.2, 4) for angle in angles]
    assert min(errors) >= 0
    assert_allclose(max(errors), np.pi / 4, atol=0.014)  # [rad]
    assert_allclose(symmetric_angle_error(0.2 + np.pi / 4, 0.2, 4), np.pi / 4)


def test_the_position_error_is_the_distance_to_the_truth() -> None:
    compared = SeenObject.of(detection(x=0.503, y=0.104), Frame(np.array([0.5, 0.1]), 0.3))
    assert_allclose(compared.position_error, 0.005)  # [m]
    assert compared.angle_error == 0


def test_appended_results_are_read_back_in_their_order(tmp_path: Path) -> None:
    results = [result(seed) for seed in range(5)]
    append_result(tmp_path / "r.jsonl", results[0])
    append_results(tmp_path / "r.jsonl", results[1:])
    log = read_results(tmp_path / "r.jsonl")
    assert list(log.results) == results
    assert log.notes == ()


@pytest.mark.parametrize("length", [1, 50, 10_000])
def test_a_half_written_last_line_is_left_out_and_told(tmp_path: Path, length: int) -> None:
    file = tmp_path / "r.jsonl"
    append_result(file, result(1))
    with file.open("a") as stream:
        stream.write("x" * length)
    log = read_results(file)
    assert list(log.results) == [result(1)]
    assert log.notes == (f"{file}: the last line is half written and left out; run its episode again.",)


@pytest.mark.parametrize("length", [1, 50, 10_000])
@pytest.mark.parametrize("n_before", [0, 1, 30])
def test_appending_cuts_a_half_written_line_off(tmp_path: Path, length: int, n_before: int) -> None:
    file = tmp_path / "r.jsonl"
    append_results(file, [result(seed) for seed in range(n_before)])
    with file.open("a") as stream:
        stream.write("x" * length)
    append_result(file, result(99))
    log = read_results(file)
    assert [r.seed for r in log.results] == [*range(n_before), 99]
    assert log.notes == ()


def test_a_damaged_line_is_told_with_its_number(tmp_path: Path) -> None:
    file = tmp_path / "r.jsonl"
    file.write_text(f"{result(1).to_json()}\nrubbish\n{result(2).to_json()}\n")
    with pytest.raises(DataError, match=r"r\.jsonl, line 2: 'rubbish' is no result"):
        read_results(file)


def test_results_cannot_be_appended_in_a_missing_folder(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"cannot append a result to .*r\.jsonl: No such file or directory"):
        append_result(tmp_path / "nowhere" / "r.jsonl", result())


@pytest.mark.parametrize(("successes", "trials"), [(0, 1), (1, 1), (0, 100), (97, 100), (100, 100), (3, 7)])
def test_wilson_interval_is_scipys(successes: int, trials: int) -> None:
    theirs = binomtest(successes, trials).proportion_ci(0.95, method="wilson")
    assert_allclose(wilson_interval(successes, trials), (theirs.low, theirs.high), atol=1e-12)


def test_wilson_interval_refuses_more_successes_than_trials() -> None:
    with pytest.raises(ValueError, match="5 successes in 4 trials; give 0 <= successes <= trials"):
        wilson_interval(5, 4)


def test_summary_counts_what_happened() -> None:
    results = [result(seed) for seed in range(7)]
    results += [result(7, Outcome.GRASP_LOST), result(8, Outcome.GRASP_LOST), result(9, Outcome.TIMEOUT)]
    summary = Summary.of(results)
    assert (summary.episodes, summary.successes, summary.success_rate) == (10, 7, 0.7)
    assert list(summary.outcomes.items()) == [("success", 7), ("grasp_lost", 2), ("timeout", 1)]


def test_medians_are_taken_over_all_objects_seen() -> None:
    several = [
        replace(result(), objects=(seen(0.001), seen(0.002))),
        replace(result(), objects=(seen(0.009),)),
    ]
    assert Summary.of(several).median_position_error == 0.002


def test_summary_does_not_depend_on_the_order_of_results() -> None:
    results = [replace(result(seed), objects=(seen(0.001 * seed),)) for seed in range(9)]
    assert Summary.of(results) == Summary.of(results[::-1])


def test_nothing_seen_has_no_median() -> None:
    blind = replace(result(outcome=Outcome.OBJECT_NOT_SEEN), objects=(), duration=None, times={}, metrics={})
    summary = Summary.of([blind])
    assert summary.median_position_error is None
    assert json.loads(summary.to_json())["median_angle_error_deg"] is None
    assert "median" not in summary.to_text()


def test_summary_says_lengths_in_mm_and_angles_in_degrees() -> None:
    values = json.loads(Summary.of([result()]).to_json())
    assert_allclose(values["median_position_error_mm"], 0.4)
    assert_allclose(values["median_angle_error_deg"], np.rad2deg(0.002))
    assert values["success_rate"] == 1.0
    assert values["outcomes"] == {"success": 1}
    assert values["median_times"] == {"render": 0.1 + 0.2, "execute": 1.0}


def test_summary_for_a_person_explains_each_failure() -> None:
    text = Summary.of([result(1), result(2, Outcome.TIMEOUT)]).to_text()
    assert text.splitlines()[0] == "1 of 2 episodes succeeded: 50.0% (95 % interval 9.5% to 90.5%)"
    assert "1 x timeout: the time for the episode is over" in text
    assert "0.40 mm, 0.11°" in text


def test_nothing_cannot_be_summarised() -> None:
    with pytest.raises(DataError, match="there is no result to summarise; run at least one episode"):
        Summary.of([])
