"""Kill scripted recordings of five episodes at random moments, and look whether anything kept is lost.

Run ``python tools/kill_while_recording.py --kills 200``; it says what it found and ends with 1 if anything
was lost. Moments are drawn in the recorder's own processor time, so that they mean the same on a busy
machine. Saving takes a few hundredths of a second, which a random moment seldom meets; ``--aimed`` kills
come in addition and are drawn from the time around it.
"""

import argparse
import io
import os
import select
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout, suppress
from pathlib import Path

import numpy as np

from cobot_lfd.app.cli import main as cobot_lfd
from cobot_lfd.app.demonstrations.store import list_episodes, load_episode
from cobot_lfd.app.recording.record import record_session

_N_EPISODES = 5
_LONGEST = (
    7.0  # [s] of processor time after which a recorder is killed at the latest; an episode takes 4 to 6
)
_AROUND_SAVING = 0.06  # [s] from the first sign of saving
_LOOK_EVERY = 0.003  # [s] between two looks at the recorder's clock
_SCENE, _ROBOT = "pick_and_place", "panda"


def main() -> int:
    """Kill recorders, each of which resumes in the folder of the one before, and check after every kill."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--aimed", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    aimed = np.zeros(options.kills + options.aimed, dtype=bool)
    aimed[: options.aimed] = True
    rng.shuffle(aimed)
    n_done = n_reported = n_sessions = 0
    while n_done < len(aimed):
        with tempfile.TemporaryDirectory() as scratch:
            folder, reported = Path(scratch) / "demos", set[str]()
            while _n_kept(folder) < _N_EPISODES and n_done < len(aimed):
                moment = _during_saving(folder, rng) if aimed[n_done] else _after(rng.uniform(0.0, _LONGEST))
                reported |= _record_and_kill(folder, _N_EPISODES - _n_kept(folder), moment)
                n_done += 1
                _check(folder, reported)
                print(f"{n_done} kills: {_n_kept(folder)} of {_N_EPISODES} kept", flush=True)
            n_sessions += 1
            n_reported += len(reported)
    print(
        f"{n_done} kills ({options.aimed} of them around saving) in {n_sessions} recordings: {n_reported} "
        "episodes were reported as kept, none is lost; list, check, fit and record worked after every kill"
    )
    return 0


def _after(seconds: float) -> Callable[[int], bool]:
    """The moment at which a process has used some processor time [s]."""
    return lambda process: _processor_time(process) >= seconds


def _during_saving(folder: Path, rng: np.random.Generator) -> Callable[[int], bool]:
    """A moment around saving, which begins when a hidden file appears."""
    wait, began = rng.uniform(0.0, _AROUND_SAVING), list[float]()

    def is_now(process: int) -> bool:
        if not began and list(folder.glob(".*.partial")):
            began.append(_processor_time(process))
        return bool(began) and _processor_time(process) >= began[0] + wait

    return is_now


def _processor_time(process: int) -> float:
    """Processor time that a process has used so far [s] (Linux numbers its clock so)."""
    return time.clock_gettime(((~process) << 3) | 2)


def _record_and_kill(folder: Path, n_episodes: int, is_now: Callable[[int], bool]) -> set[str]:
    """Record in a process of its own, kill it at a moment, and return the files that it reported as kept."""
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(read_end)

        def report(note: str) -> None:
            os.write(write_end, f"{note.partition(': ')[0]}\n".encode())

        record_session(_SCENE, _ROBOT, folder, n_episodes=n_episodes, first_seed=0, report=report)
        os._exit(0)
    os.close(write_end)
    told = b""
    while not is_now(child):
        if select.select([read_end], [], [], _LOOK_EVERY)[0]:
            part = os.read(read_end, 4096)
            if not part:
                break  # it has recorded all that it was asked for
            told += part
    with suppress(ProcessLookupError):
        os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    while part := os.read(read_end, 4096):
        told += part
    os.close(read_end)
    return set(told.decode().split())


def _n_kept(folder: Path) -> int:
    return len(list_episodes(folder)) if folder.is_dir() else 0


def _check(folder: Path, reported: set[str]) -> None:
    """Every file that was reported as kept is there and whole, and so is every other; list and fit work."""
    for file in reported:
        episode = load_episode(Path(file))
        if not episode.verdict.succeeded or len(episode.times) < 500:
            sys.exit(f"{file} is not complete: {episode.verdict.sentence}")
    if not _n_kept(folder):
        return
    _require(["demos", "list", str(folder)])
    _require(["demos", "check", str(folder)])
    if _n_kept(folder) >= 2:
        _require(["fit", str(folder), "--out", str(folder.parent / "model.npz")])


def _require(words: list[str]) -> None:
    """A command that must end well."""
    told = io.StringIO()
    with redirect_stdout(told), redirect_stderr(told):
        code = cobot_lfd(words)
    if code != 0:
        sys.exit(f"cobot-lfd {' '.join(words)} ended with {code}: {told.getvalue()}")


if __name__ == "__main__":
    sys.exit(main())
