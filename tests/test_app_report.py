"""Reports: counted rightly, compared on the same seeds, whole in one file, and usable in a browser."""

import csv
import io
import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from scipy.stats import binom

from cobot_lfd.app.cli import main
from cobot_lfd.app.evaluation.contender import Contender
from cobot_lfd.app.evaluation.perform import Performed, labelled
from cobot_lfd.app.evaluation.perturbation import Sweep
from cobot_lfd.app.evaluation.plan import Plan, Trial
from cobot_lfd.app.provenance import Provenance
from cobot_lfd.app.report.cells import cells_of
from cobot_lfd.app.report.content import Report, gather
from cobot_lfd.app.report.html import to_html
from cobot_lfd.app.report.markdown import to_markdown
from cobot_lfd.app.report.paired import comparisons_of, mcnemar
from cobot_lfd.app.report.plots import AXIS_LABELS
from cobot_lfd.app.report.tables import to_csv, to_json
from cobot_lfd.app.run_folder import RunFolder
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Outcome
from tests.app_examples import result

SEEDS = range(5000, 5020)


def made_up(trial: Trial) -> Performed:
    """The good one fails at each tenth seed, the bad one at each second; both at the first five in noise."""
    every = 10 if trial.contender.label == "good" else 2
    noisy = trial.perturbation.detection_noise_mm > 0 and trial.seed < SEEDS.start + 5
    failed = trial.seed % every == 0 or noisy
    outcome = Outcome.GRASP_LOST if failed else Outcome.SUCCESS
    detail = "<script>alert(1)</script>" if failed else ""
    metrics = {"d_total": 0.012, "d_start": 0.001, "d_end": 0.002}
    one = labelled(trial, replace(result(trial.seed, outcome, detail), metrics=metrics))
    return Performed(one, b"a picture" if failed else b"")


def make_run(path: Path) -> RunFolder:
    plan = Plan.of(
        scenes=("pick_and_place",),
        robots=("panda",),
        contenders=tuple(Contender(name, "line", name.encode()) for name in ("good", "bad")),
        perturbations=Sweep(detection_noise_mm=(0.0, 5.0)).perturbations(),
        seeds=SEEDS,
    )
    return RunFolder.create(path, plan, Provenance.collect(seeds=plan.seeds, options={"scene": ["x"]}))


def all_of(trials: Sequence[Trial]) -> Iterator[Performed]:
    return map(made_up, trials)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = make_run(tmp_path_factory.mktemp("report") / "first run")
    folder.carry_out(all_of)
    return folder.path


@pytest.fixture(scope="module")
def report(run: Path) -> Report:
    return gather([run])


def test_cells_count_by_condition(report: Report) -> None:
    counts = {(c.condition.contender, c.condition.perturbed): (c.successes, c.episodes) for c in report.cells}
    assert counts == {
        ("good", "none"): (18, 20),
        ("bad", "none"): (10, 20),
        ("good", "detection noise 5 mm"): (14, 20),
        ("bad", "detection noise 5 mm"): (8, 20),
    }


def test_the_title_says_what_was_compared(report: Report) -> None:
    assert report.title == "good and bad in pick_and_place with panda"
    assert report.runs == ("first run",)
    assert "<title>Evaluation: good and bad in pick_and_place with panda</title>" in to_html(report)


def test_every_perturbation_has_an_axis_with_a_unit() -> None:
    numbers = {name for name, value in Sweep() if not isinstance(value[0], bool | str)}
    assert set(AXIS_LABELS) == numbers
    assert all(re.search(r" \[.+\]$", label) for label in AXIS_LABELS.values())


def test_contenders_are_compared_on_the_same_seeds(report: Report) -> None:
    plain, noisy = report.comparisons
    assert (plain.first, plain.second, plain.pairs) == ("good", "bad", 20)
    assert (plain.both, plain.only_first, plain.only_second) == (10, 8, 0)
    assert plain.p_value == pytest.approx(2 * 0.5**8)
    assert (noisy.both, noisy.only_first, noisy.only_second) == (8, 6, 0)


@pytest.mark.parametrize(("a", "b"), [(0, 0), (1, 0), (3, 9), (9, 3), (5, 5)])
def test_mcnemar_is_twice_the_tail_of_a_fair_coin(a: int, b: int) -> None:
    tail = 2 * binom.cdf(min(a, b), a + b, 0.5)
    assert mcnemar(a, b) == pytest.approx(min(1.0, tail))


def test_what_shares_no_seed_is_not_compared() -> None:
    results = [replace(result(seed), contender=name) for seed, name in ((1, "a"), (2, "b"))]
    assert comparisons_of(results) == []
    assert len(cells_of(results)) == 2


def test_every_failure_has_the_command_that_runs_it_again(report: Report, run: Path) -> None:
    assert len(report.failures) == 30
    assert report.failures[0].command == f"cobot-lfd replay '{run}' 0 --picture seen.png"


def test_the_page_needs_no_network_and_runs_nothing_that_it_shows(report: Report) -> None:
    page = to_html(report)
    namespaces = r"http://www\.w3\.org/|http://purl\.org/|http://creativecommons\.org/"
    addresses = [match for match in re.findall(r"https?://\S+", page) if not re.match(namespaces, match)]
    assert addresses == []
    assert not re.search(r'(src|href)="(?!data:|file:|#)', page)
    assert "<script>alert(1)" not in page
    assert page.count('src="data:image/webp;base64,') == 30


def test_csv_has_a_line_per_episode(report: Report) -> None:
    rows = list(csv.DictReader(io.StringIO(to_csv(report))))
    assert len(rows) == 80
    assert rows[2]["perturbation.detection_noise_mm"] == "5.0"
    assert float(rows[0]["cube.position_error"]) == 0.0004
    assert sum(row["success"] == "True" for row in rows) == report.summary.successes


def test_json_holds_cells_comparisons_and_provenance(report: Report) -> None:
    content = json.loads(to_json(report))
    assert content["cells"][0]["successes"] == 18
    assert content["comparisons"][0]["only_first"] == 8
    assert content["provenance"]["first run"]["seeds"] == "5000 to 5019"
    assert len(content["failures"]) == 30


def test_markdown_holds_a_row_per_condition(report: Report) -> None:
    text = to_markdown(report)
    assert "| good | pick_and_place | panda | none | 18 of 20 (90.0%) | 69.9% to 97.2% | 0.012 |" in text
    assert "`cobot-lfd replay" in text


def test_several_runs_are_told_apart(run: Path, tmp_path: Path) -> None:
    other = make_run(tmp_path / "second")
    other.carry_out(lambda trials: map(made_up, trials[:8]))
    both = gather([run, other.path])
    assert both.contenders == ["first run/good", "first run/bad", "second/good", "second/bad"]
    assert (both.planned, len(both.episodes)) == (160, 88)
    pairs = {(c.first, c.second): c for c in both.comparisons}
    same = pairs["first run/good", "second/good"]
    assert (same.only_first, same.only_second, same.p_value) == (0, 0, 1.0)


def test_a_run_without_results_is_told(tmp_path: Path) -> None:
    folder = make_run(tmp_path / "run")
    with pytest.raises(DataError, match="no episode has ended yet; there is nothing to report"):
        gather([folder.path])


def test_the_command_writes_what_the_endings_ask_for(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [str(tmp_path / f"report.{ending}") for ending in ("html", "md", "csv", "json")]
    assert main(["report", str(run), "--out", *files]) == 0
    assert all(Path(file).stat().st_size > 1000 for file in files)
    assert "good, pick_and_place, panda, perturbation none: 18 of 20" in capsys.readouterr().out
    assert main(["report", str(run), "--out", str(tmp_path / "report.pdf")]) == 2
    assert "must end in one of: .html, .md, .csv, .json" in capsys.readouterr().err
