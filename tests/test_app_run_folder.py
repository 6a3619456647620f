"""A run's folder: nothing is lost when the coordinator is killed, and a resumed run leaves the same lines."""

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from cobot_lfd.app.evaluation.drive import drive
from cobot_lfd.app.evaluation.perform import Performed
from cobot_lfd.app.evaluation.plan import Plan, Trial
from cobot_lfd.app.evaluation.workers import WorkerProcesses
from cobot_lfd.app.provenance import Provenance
from cobot_lfd.app.run_folder import PLAN, RESULTS, RunFolder
from cobot_lfd.errors import DataError
from tests.evaluation_examples import slow_stand_in, small_plan, stand_in

pytestmark = pytest.mark.simulator

N = 40


def begin(path: Path, plan: Plan) -> RunFolder:
    return RunFolder.create(path, plan, Provenance.collect(seeds=plan.seeds, options={}))


def here(trials: Sequence[Trial]) -> Iterator[Performed]:
    return map(stand_in, trials)


def backwards(trials: Sequence[Trial]) -> Iterator[Performed]:
    return map(stand_in, reversed(trials))


def comparable(folder: RunFolder) -> list[str]:
    return [result.comparable_json() for result in folder.results()]


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    folder = begin(tmp_path_factory.mktemp("run") / "undisturbed", small_plan(N))
    folder.carry_out(here)
    return folder


def test_the_plan_is_on_disk_before_the_first_episode(tmp_path: Path) -> None:
    folder = begin(tmp_path / "run", small_plan(3))
    plan = json.loads((folder.path / PLAN).read_text())
    assert (plan["trials"], plan["first_seed"], plan["episodes"]) == (3, 0, 3)
    assert RunFolder.open(folder.path).plan == folder.plan
    assert [trial.seed for trial in folder.remaining()] == [0, 1, 2]


def test_lines_do_not_depend_on_the_order_in_which_episodes_end(
    undisturbed: RunFolder, tmp_path: Path
) -> None:
    folder = begin(tmp_path / "run", small_plan(N))
    folder.carry_out(backwards)
    seeds = [json.loads(line)["seed"] for line in (folder.path / RESULTS).read_text().splitlines()]
    assert seeds == list(range(N))
    assert comparable(folder) == comparable(undisturbed)


def test_failed_episodes_have_their_picture(undisturbed: RunFolder) -> None:
    for result in undisturbed.results():
        assert undisturbed.picture(result.trial).exists() is not result.verdict.succeeded


def test_a_killed_coordinator_loses_nothing(undisturbed: RunFolder, tmp_path: Path) -> None:
    """Killed again and again, at moments that vary with the machine, until the run is whole."""
    folder = begin(tmp_path / "run", small_plan(N))
    kills = 0
    for wait in (1, 3):
        coordinator = _coordinator(folder.path)
        _wait_for_lines(folder.path / RESULTS, len(folder.results()) + wait, coordinator)
        if coordinator.poll() is None:
            kills += 1
        coordinator.send_signal(signal.SIGKILL)
        coordinator.wait()
        if wait == 1:
            with (folder.path / RESULTS).open("a") as stream:
                stream.write('{"half a li')
    assert kills == 2
    assert 0 < len(folder.results()) < N
    with WorkerProcesses(1, time_limit=60.0) as executor:
        folder.carry_out(lambda trials: drive(executor, stand_in, trials, at_once=2, time_limit=60.0))
    assert comparable(folder) == comparable(undisturbed)


def _coordinator(path: Path) -> "subprocess.Popen[bytes]":
    return subprocess.Popen([sys.executable, "-m", "tests.test_app_run_folder", str(path)])


def _wait_for_lines(file: Path, n: int, coordinator: "subprocess.Popen[bytes]") -> None:
    deadline = time.monotonic() + 60.0
    while coordinator.poll() is None and time.monotonic() < deadline:
        if file.exists() and file.read_bytes().count(b"\n") >= n:
            return
        time.sleep(0.005)


def _drive_slowly(path: Path) -> None:
    RunFolder.open(path).carry_out(lambda trials: map(slow_stand_in, trials))


def test_an_interrupted_run_keeps_what_it_has(tmp_path: Path) -> None:
    def interrupted(trials: Sequence[Trial]) -> Iterator[Performed]:
        yield stand_in(trials[0])
        raise KeyboardInterrupt

    folder = begin(tmp_path / "run", small_plan(3))
    with pytest.raises(KeyboardInterrupt):
        folder.carry_out(interrupted)
    assert [trial.seed for trial in folder.remaining()] == [1, 2]


def test_results_are_never_overwritten(undisturbed: RunFolder) -> None:
    with pytest.raises(DataError, match=r"holds an evaluation already; go on with it by --resume"):
        begin(undisturbed.path, small_plan(3))


def test_two_processes_do_not_work_on_one_run(tmp_path: Path) -> None:
    folder = begin(tmp_path / "run", small_plan(1))

    def meanwhile(trials: Sequence[Trial]) -> Iterator[Performed]:
        with pytest.raises(DataError, match="another process works on"):
            folder.carry_out(here)
        return here(trials)

    folder.carry_out(meanwhile)


def test_a_changed_scene_cannot_be_gone_on_with(tmp_path: Path) -> None:
    folder = begin(tmp_path / "run", small_plan(1))
    folder.require_unchanged()
    text = (folder.path / PLAN).read_text()
    checksum = folder.plan.fingerprints["scene pick_and_place"]
    (folder.path / PLAN).write_text(text.replace(checksum, "0" * 64))
    with pytest.raises(DataError, match=r"scene pick_and_place changed since .* start a new run"):
        RunFolder.open(folder.path).require_unchanged()


def test_lines_of_another_run_are_noticed(undisturbed: RunFolder, tmp_path: Path) -> None:
    folder = begin(tmp_path / "run", small_plan(N + 1))
    (folder.path / RESULTS).write_bytes((undisturbed.path / RESULTS).read_bytes())
    with pytest.raises(DataError, match="trial 0 belongs to another run"):
        folder.results()


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"format": "other", "version": 1}'])
def test_a_damaged_plan_is_told(tmp_path: Path, text: str) -> None:
    folder = begin(tmp_path / "run", small_plan(1))
    (folder.path / PLAN).write_text(text)
    with pytest.raises(DataError, match="the plan cannot be read"):
        RunFolder.open(folder.path)


def test_a_folder_without_a_plan_is_told(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"holds no evaluation \(no plan.json\)"):
        RunFolder.open(tmp_path)


if __name__ == "__main__":
    _drive_slowly(Path(sys.argv[1]))
