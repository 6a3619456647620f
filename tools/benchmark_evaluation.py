"""How evaluation does: workers, memory, start-up, killed coordinators, large reports, an episode's profile.

Everything is measured in one run on one machine, so that ratios hold whatever else the machine does. Killing
is tried on stand-ins for episodes (20 ms each, by the same coordinator, workers and files), all else on real
episodes.
"""

import cProfile
import pstats
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import tyro

from cobot_lfd.app.demonstrations.store import load_demonstrations
from cobot_lfd.app.evaluation.contender import Contender
from cobot_lfd.app.evaluation.demonstration_bytes import demonstrations_to_bytes
from cobot_lfd.app.evaluation.drive import drive
from cobot_lfd.app.evaluation.perform import Performed, labelled, perform
from cobot_lfd.app.evaluation.perturbation import Perturbation
from cobot_lfd.app.evaluation.plan import Plan, Trial
from cobot_lfd.app.evaluation.run import Where, run
from cobot_lfd.app.evaluation.workers import WorkerProcesses
from cobot_lfd.app.provenance import Provenance
from cobot_lfd.app.recording.record import record_session
from cobot_lfd.app.report.content import gather
from cobot_lfd.app.report.write import write_report
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.run_folder import RESULTS, RunFolder
from cobot_lfd.outcome import Outcome, Verdict

N_STAND_INS = 200
STAND_IN_TIME = 0.02  # [s]
_FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
)


def main(
    *,
    demos: Path | None = None,
    episodes: int = 20,
    rounds: int = 2,
    memory_episodes: int = 60,
    kills: int = 50,
    report_episodes: int = 1000,
    only: tuple[str, ...] = ("speed", "memory", "kill", "report", "profile"),
) -> None:
    """Measure and print.

    Args:
        demos: Folder of demonstrations of pick_and_place; recorded first if it is not given.
        episodes: Episodes for each measurement of speed.
        rounds: How often one and two workers take turns.
        memory_episodes: Episodes that one worker runs while its memory is watched.
        kills: How often the coordinator is killed.
        report_episodes: Episodes of the large report, half of them failures with a picture.
        only: What to measure.
    """
    with TemporaryDirectory() as scratch:
        folder = Path(scratch)
        demos = demos or _recorded(folder / "demos")
        contender = Contender("improved", "improved", demonstrations_to_bytes(load_demonstrations(demos)))
        parts: dict[str, Callable[[], None]] = {
            "speed": partial(_speed, contender, folder, episodes, rounds),
            "memory": partial(_memory, contender, memory_episodes),
            "kill": partial(_kill, folder, kills),
            "report": partial(_report, contender, folder, report_episodes),
            "profile": partial(_profile, contender),
        }
        for name in only:
            parts[name]()


def _recorded(folder: Path) -> Path:
    record_session("pick_and_place", "panda", folder, n_episodes=6, first_seed=0)
    return folder


def _plan(contender: Contender, n: int) -> Plan:
    return Plan.of(
        scenes=("pick_and_place",),
        robots=("panda",),
        contenders=(contender,),
        perturbations=(Perturbation(),),
        seeds=range(5000, 5000 + n),
    )


def _begin(path: Path, plan: Plan) -> RunFolder:
    return RunFolder.create(path, plan, Provenance.collect(seeds=plan.seeds, options={}))


def _speed(contender: Contender, folder: Path, n: int, rounds: int) -> None:
    """Episodes per second with one and with two workers, taking turns; and the time before the first."""
    rates: dict[int, list[float]] = {1: [], 2: []}
    processor: dict[int, list[float]] = {1: [], 2: []}
    coordinator: list[float] = []
    starts: list[float] = []
    lines = set()
    for i in range(rounds):
        for workers, measured in rates.items():
            one = _begin(folder / f"speed_{i}_{workers}", _plan(contender, n))
            ends: list[float] = []
            begin, own, workers_own = time.perf_counter(), time.process_time(), _children_time()
            run(one, Where(workers=workers), report=partial(_note_time, ends))
            processor[workers].append((_children_time() - workers_own) / n)
            coordinator.append((time.process_time() - own) / n)
            # The first episodes of the workers carry their start-up; the rate is that of the others.
            measured.append((n - workers) / (ends[-1] - ends[workers - 1]))
            if workers == 1:
                starts.append(ends[0] - begin - sum(one.results()[0].times.values()))
            lines.add(tuple(result.comparable_json() for result in one.results()))
    ratios = [two / alone for alone, two in zip(rates[1], rates[2], strict=True)]
    print(f"episodes per second: one worker {_told(rates[1])}, two workers {_told(rates[2])}")
    print(f"two workers over one, {n} episodes, {rounds} rounds taking turns: {_told(ratios)}")
    print(
        f"processor time of the workers per episode, start-up included: one {_told(processor[1])} s, ", end=""
    )
    print(f"two {_told(processor[2])} s; of the coordinator {_told(coordinator)} s")
    print(f"all {2 * rounds} runs gave the same lines: {len(lines) == 1}")
    print(f"start-up until the first episode begins: {_told(starts)} s")


def _children_time() -> float:
    """Processor time of the processes that have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _note_time(times: list[float], _: EpisodeResult) -> None:
    times.append(time.perf_counter())


def _told(values: Sequence[float]) -> str:
    return f"{np.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"


def _memory(contender: Contender, n: int) -> None:
    """Memory of one worker, told as it goes on, since a long run takes hours."""
    with WorkerProcesses(1, time_limit=3600.0) as executor:
        sizes: list[float] = []
        for trial in _plan(contender, n).trials():
            sizes.append(executor.submit(_resident_after, trial).result())
            if len(sizes) % max(1, n // 40) == 0:
                print(f"memory of a worker after {len(sizes)} episodes: {sizes[-1]:.0f} MB", flush=True)
    warm = sizes[n // 10 :]
    growth, start = np.polyfit(np.linspace(0.0, 1.0, len(warm)), warm, 1)
    print(f"from {n // 10} to {n} episodes: {min(warm):.0f} to {max(warm):.0f} MB", end="; ")
    print(f"a line through all of them grows by {growth:.1f} MB ({growth / start:+.1%})")


def _resident_after(trial: Trial) -> float:
    """Resident memory after a trial [MB]."""
    perform(trial)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


def _kill(folder: Path, kills: int) -> None:
    """Kill the coordinator at random moments; whatever remains is resumed, and the lines are compared."""
    plan = _plan(Contender("line", "line", b"[]"), N_STAND_INS)
    undisturbed, killed = _begin(folder / "undisturbed", plan), _begin(folder / "killed", plan)
    _resume(undisturbed.path)
    rng = np.random.default_rng(0)
    done = restarts = 0
    while done < kills:
        if not killed.remaining():
            shutil.rmtree(killed.path)
            killed = _begin(folder / "killed", plan)
            restarts += 1
        coordinator = subprocess.Popen([sys.executable, __file__, "--resume-stand-ins", str(killed.path)])
        try:
            coordinator.wait(timeout=float(rng.uniform(0.5, 5.0)))
        except subprocess.TimeoutExpired:
            coordinator.send_signal(signal.SIGKILL)
            coordinator.wait()
            done += 1
    _resume(killed.path)
    same = _comparable(undisturbed) == _comparable(killed)
    print(f"coordinator killed {done} times over {restarts + 1} runs of {N_STAND_INS} stand-ins: ", end="")
    print(f"after --resume the file equals the undisturbed one: {same}")


def _comparable(folder: RunFolder) -> list[str]:
    lines = (folder.path / RESULTS).read_text().splitlines()
    return [EpisodeResult.from_json(line).comparable_json() for line in lines]


def _resume(path: Path) -> None:
    """What the coordinator does, with stand-ins for episodes."""

    def in_processes(trials: Sequence[Trial]) -> Iterator[Performed]:
        executor: Executor
        with WorkerProcesses(2, time_limit=60.0) as executor:
            yield from drive(executor, _stand_in, trials, at_once=4, time_limit=60.0)

    RunFolder.open(path).carry_out(in_processes)


def _stand_in(trial: Trial) -> Performed:
    time.sleep(STAND_IN_TIME)
    verdict = Verdict(Outcome.GRASP_LOST if trial.seed % 3 == 0 else Outcome.SUCCESS)
    result = EpisodeResult(
        seed=trial.seed, scene=trial.scene, robot=trial.robot, method="stand-in", verdict=verdict
    )
    return Performed(labelled(trial, result), b"picture" if not verdict.succeeded else b"")


def _report(contender: Contender, folder: Path, n: int) -> None:
    """Size of a large report whose every second episode failed, and the time until a browser shows it."""
    plan = _plan(contender, n)
    seen = perform(plan.trial(0)).result
    astray = Perturbation(detection_noise_mm=60.0)  # so far that episodes fail and have a picture
    failed_trials = [replace(plan.trial(number), perturbation=astray) for number in range(3)]
    pictures = [perform(trial).picture for trial in failed_trials]

    def made_up(trial: Trial) -> Performed:
        failed = trial.number % 2 == 1
        verdict = Verdict(Outcome.GRASP_LOST, "during 'lift'") if failed else seen.verdict
        result = labelled(trial, replace(seen, seed=trial.seed, verdict=verdict))
        return Performed(result, pictures[trial.number % 3] if failed else b"")

    run_folder = _begin(folder / "large", plan)
    run_folder.carry_out(lambda trials: map(made_up, trials))
    file = write_report(gather([run_folder.path]), run_folder.path / "report.html")
    size = file.stat().st_size / 1e6
    print(f"report of {n} episodes, {n // 2} failures with pictures: {size:.1f} MB, {_load_time(file)}")


def _load_time(file: Path) -> str:
    """Time until the page is loaded, in headless Chromium."""
    chromium = shutil.which("chromium")
    if chromium is None:
        return "not loaded (Chromium is not installed)"
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=list(_FLAGS))
        times = []
        for _ in range(5):
            page = browser.new_page(viewport={"width": 1366, "height": 768})
            begin = time.perf_counter()
            page.goto(file.as_uri(), wait_until="load")
            page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
            times.append(time.perf_counter() - begin)
            page.close()
        browser.close()
    return f"loaded and drawn in {_told(times)} s"


def _profile(contender: Contender) -> None:
    """Where the time of an episode goes."""
    trials = list(_plan(contender, 4).trials())
    perform(trials[0])
    begin = time.process_time()
    times = [perform(trial).result.times for trial in trials[1:]]
    print(f"processor time per episode: {(time.process_time() - begin) / len(times):.2f} s")
    for stage in times[0]:
        print(f"  {stage}: {np.median([one[stage] for one in times]):.3f} s")
    profiler = cProfile.Profile()
    profiler.runcall(perform, trials[1])
    pstats.Stats(profiler).sort_stats("tottime").print_stats(12)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--resume-stand-ins"]:
        _resume(Path(sys.argv[2]))
    else:
        tyro.cli(main)
