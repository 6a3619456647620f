"""Recording with the mouse in the simulator's window, on a display that exists in memory only."""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from cobot_lfd.app.cli import main
from cobot_lfd.app.store import list_episodes, load_episode

pytestmark = [pytest.mark.window, pytest.mark.simulator]


@pytest.fixture
def display() -> Iterator[dict[str, str]]:
    """The environment for programs on a new display."""
    for program in ("Xvfb", "xdotool"):
        if shutil.which(program) is None:
            reason = f"{program} is not installed (Debian, Ubuntu: apt-get install xvfb xdotool)"
            if os.environ.get("CI"):
                pytest.fail(reason)
            pytest.skip(reason)
    read_end, write_end = os.pipe()
    command = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1100x800x24", "-nolisten", "tcp"]
    server = subprocess.Popen(command, pass_fds=[write_end], stderr=subprocess.DEVNULL)
    os.close(write_end)
    with os.fdopen(read_end) as numbers:
        number = numbers.readline().strip()
    yield os.environ | {"DISPLAY": f":{number}", "OMP_NUM_THREADS": "1"}
    server.terminate()
    server.wait(timeout=20)


def wait_for(what: Callable[[], object], seconds: float) -> None:
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end, "it does not come about"
        time.sleep(0.2)


def test_an_arm_dragged_in_the_window_is_recorded(tmp_path: Path, display: dict[str, str]) -> None:
    def xdotool(*words: str) -> str:
        done = subprocess.run(["xdotool", *words], env=display, capture_output=True, text=True, check=False)
        return done.stdout.strip()

    def windows() -> list[str]:
        return xdotool("search", "--name", "Bullet Physics").split()

    command = [sys.executable, "-m", "cobot_lfd", "record", "pick_and_place", "--out", str(tmp_path / "d")]
    log = (tmp_path / "log").open("w")
    recorder = subprocess.Popen(
        [*command, "--hand", "mouse", "--demos", "1"], env=display, stdout=log, stderr=subprocess.STDOUT
    )
    try:
        wait_for(windows, 60)
        window = windows()[-1]
        wait_for(lambda: "lead the arm" in (tmp_path / "log").read_text(), 60)
        time.sleep(4.0)  # [s] until the arm has come down to the plane
        xdotool("windowfocus", window)
        xdotool("mousemove", "--window", window, "512", "384")
        xdotool("mousedown", "1")
        for _ in range(20):
            xdotool("mousemove_relative", "--", "5", "2")
            time.sleep(0.05)
        time.sleep(1.5)
        xdotool("mouseup", "1")
        time.sleep(0.5)
        for _ in range(30):
            xdotool("key", "Return")
            if recorder.poll() is not None:
                break
            time.sleep(0.5)
        assert recorder.wait(timeout=60) == 1, (tmp_path / "log").read_text()  # nothing was placed
    finally:
        recorder.kill()
        recorder.wait()
        log.close()
    episode = load_episode(list_episodes(tmp_path / "d")[0])
    moved = np.linalg.norm(episode.tool_positions[-1, :2] - episode.tool_positions[0, :2])
    assert moved > 0.03  # [m]
    assert 5.0 < np.linalg.norm(episode.hand_forces, axis=1).max() <= 40.0 + 1e-9  # [N]


def test_without_a_display_the_mouse_is_told_so_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    assert main(["record", "pick_and_place", "--out", str(tmp_path), "--hand", "mouse"]) == 2
    [line] = capsys.readouterr().err.splitlines()
    assert line.endswith("--hand mouse needs a display (DISPLAY is not set); use --hand browser instead.")
