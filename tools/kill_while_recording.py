"""Kill a scripted recording of five episodes at random moments, and look whether anything kept is lost.

Run ``python tools/kill_while_recording.py --kills 200``; it says what it found and ends with 1 if
anything was lost.
"""

import argparse
import os
import select
import signal
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from cobot_lfd.app.demonstrations.folder import find_damage
from cobot_lfd.app.demonstrations.store import list_episodes, load_demonstrations, load_episode
from cobot_lfd.app.recording.record import record_session
from cobot_lfd.learning.model import TaskParameterisedGMM

_N_EPISODES = 5
_LONGEST = 12.0  # [s] after which a recorder is killed at the latest; an episode takes a few seconds


def main() -> int:
    """Kill recorders, each of which resumes in the folder of the one before, and check after every kill."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    n_kills = n_reported = n_sessions = 0
    while n_kills < options.kills:
        with tempfile.TemporaryDirectory() as scratch:
            folder, reported = Path(scratch) / "demos", set[str]()
            while n_kills < options.kills and _n_kept(folder) < _N_EPISODES:
                reported |= _record_and_kill(
                    folder, _N_EPISODES - _n_kept(folder), rng.uniform(0.0, _LONGEST)
                )
                n_kills += 1
                _check(folder, reported)
                print(f"{n_kills} kills: {_n_kept(folder)} of {_N_EPISODES} kept", flush=True)
            n_sessions += 1
            n_reported += len(reported)
            _check_use(folder)
    print(
        f"{n_kills} kills in {n_sessions} recordings: {n_reported} episodes were reported as kept, "
        "none is lost"
    )
    return 0


def _record_and_kill(folder: Path, n_episodes: int, seconds: float) -> set[str]:
    """Record in a process of its own, kill it after a time, and return the files that it reported as kept."""
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(read_end)

        def report(note: str) -> None:
            os.write(write_end, f"{note.partition(': ')[0]}\n".encode())

        record_session("pick_and_place", "panda", folder, n_episodes=n_episodes, first_seed=0, report=report)
        os._exit(0)
    os.close(write_end)
    told = _read_until(read_end, time.monotonic() + seconds)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    told += _read_until(read_end, time.monotonic() + 1.0)
    os.close(read_end)
    return set(told.decode().split())


def _read_until(descriptor: int, end: float) -> bytes:
    """What is written into a pipe until a time, or until nobody holds its other end."""
    told = b""
    while (left := end - time.monotonic()) > 0:
        if not select.select([descriptor], [], [], left)[0]:
            break
        part = os.read(descriptor, 4096)
        if not part:
            break
        told += part
    return told


def _n_kept(folder: Path) -> int:
    return len(list_episodes(folder)) if folder.is_dir() else 0


def _check(folder: Path, reported: set[str]) -> None:
    """Every file that was reported as kept is there and whole, and so is every other."""
    for file in reported:
        episode = load_episode(Path(file))
        if not episode.verdict.succeeded or len(episode.times) < 500:
            sys.exit(f"{file} is not complete: {episode.verdict.sentence}")
    damaged = find_damage(folder) if folder.is_dir() else []
    if damaged:
        sys.exit(f"damaged: {damaged[0].problem}")


def _check_use(folder: Path) -> None:
    """What is there can be learnt from."""
    if _n_kept(folder) >= 2:
        TaskParameterisedGMM.fit(load_demonstrations(folder))


if __name__ == "__main__":
    sys.exit(main())
