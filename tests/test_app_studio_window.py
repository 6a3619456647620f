"""The simulator's window, with a real mouse and real keys, on a display that exists in memory only."""

import os
import shutil
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from cobot_lfd.app.cli import main
from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.store import list_episodes, load_episode
from cobot_lfd.app.recording.replay import replay
from cobot_lfd.app.studio.audience import Mode
from cobot_lfd.app.studio.session import Session
from cobot_lfd.app.studio.window import open_window
from cobot_lfd.outcome import Outcome

pytestmark = [pytest.mark.browser, pytest.mark.simulator]

HAND = (505, 335)  # [px] where the window shows the arm's hand when it is ready


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    """Name of a new display."""
    for program in ("Xvfb", "xdotool"):
        if shutil.which(program) is None:
            reason = f"{program} is not installed (Debian, Ubuntu: apt-get install xvfb xdotool)"
            if os.environ.get("CI"):
                pytest.fail(reason)
            pytest.skip(reason)
    read_end, write_end = os.pipe()
    command = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1100x800x24", "-nolisten", "tcp"]
    with subprocess.Popen(command, pass_fds=[write_end], stderr=subprocess.DEVNULL) as server:
        os.close(write_end)
        with os.fdopen(read_end) as numbers:
            yield f":{numbers.readline().strip()}"
        server.terminate()


def wait_for(what: Callable[[], object], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end, "it does not come about"
        time.sleep(0.05)


def xdotool(*words: object) -> None:
    """Move the mouse, press keys."""
    subprocess.run(["xdotool", *map(str, words)], check=True, stdout=subprocess.DEVNULL)


@contextmanager
def window_at_work(folder: Path) -> Iterator[Session]:
    """A session with its window, in a thread of this process."""
    opened: list[Session] = []
    thread = threading.Thread(
        target=open_window,
        args=("pick_and_place", "panda", folder),
        kwargs={"first_seed": 0, "started": opened.append},
    )
    thread.start()
    try:
        wait_for(lambda: opened, 120)
        stage = opened[0].stage
        wait_for(lambda: opened[0].mode is Mode.READY)
        wait_for(lambda: abs(stage.shown_tool[2] - stage.scene.task.travel_height) < 0.005)  # [m]
        yield opened[0]
    finally:
        if opened:
            opened[0].close()
        thread.join(timeout=60)
    assert not thread.is_alive()


@pytest.fixture(scope="module")
def recorded(display: str, tmp_path_factory: pytest.TempPathFactory) -> list[RecordedEpisode]:
    """Two recordings: the arm dragged aside; and the window closed in the middle of a drag."""
    folder = tmp_path_factory.mktemp("window") / "demos"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DISPLAY", display)
        with window_at_work(folder) as session:
            hand = session.stage.hand
            xdotool("search", "--sync", "--name", "Bullet Physics", "windowfocus")
            xdotool("key", "r")
            wait_for(lambda: session.mode is Mode.RECORDING)
            xdotool("mousemove", *HAND, "mousedown", 1)
            for _ in range(20):
                xdotool("mousemove_relative", "--", 6, 1)
            wait_for(lambda: hand.pulls)
            pulled_to = hand.pointer
            assert pulled_to is not None
            wait_for(lambda: np.linalg.norm(session.stage.shown_tool[:2] - pulled_to[:2]) < 0.02)
            xdotool("mouseup", 1)
            wait_for(lambda: not hand.pulls)
            xdotool("key", "g")
            wait_for(lambda: hand.is_closed)
            xdotool("key", "t")
            wait_for(lambda: session.mode is Mode.STOPPED)
            xdotool("key", "n")
            wait_for(lambda: session.mode is Mode.READY and session.stage.seed != 0)
            xdotool("key", "r")
            wait_for(lambda: session.mode is Mode.RECORDING)
            xdotool("mousemove", *HAND, "mousedown", 1, "mousemove_relative", "--", 30, 0)
            wait_for(lambda: session.stage.hand.pulls)
            xdotool("search", "--name", "Bullet Physics", "windowclose")
            wait_for(lambda: not session.is_open)
    return [load_episode(path) for path in list_episodes(folder)]


def test_an_arm_that_is_dragged_in_the_window_is_recorded(recorded: list[RecordedEpisode]) -> None:
    episode = recorded[0]
    assert episode.verdict.outcome is Outcome.NOT_PLACED
    assert np.linalg.norm(episode.tool_positions[-1, :2] - episode.tool_positions[0, :2]) > 0.05  # [m]
    assert 5.0 < np.linalg.norm(episode.hand_forces, axis=1).max() <= 40.0 + 1e-9  # [N]
    assert np.ptp(episode.tool_positions[:, 2]) < 0.02  # [m]; the guide keeps it in the plane
    assert episode.gripper_orders[0] > 0.0 == episode.gripper_orders[-1]


def test_what_was_dragged_in_the_window_can_be_done_again_exactly(recorded: list[RecordedEpisode]) -> None:
    assert replay(recorded[0], "wrenches").worst == 0.0  # [m]


def test_a_window_that_is_closed_in_a_drag_keeps_an_incomplete_episode(
    recorded: list[RecordedEpisode],
) -> None:
    assert [episode.verdict.outcome for episode in recorded[1:]] == [Outcome.INCOMPLETE]


def test_without_a_display_the_mouse_is_told_so_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    assert main(["record", "pick_and_place", "--out", str(tmp_path), "--hand", "mouse"]) == 2
    [line] = capsys.readouterr().err.splitlines()
    assert line.endswith("--hand mouse needs a display (DISPLAY is not set); use --hand browser instead.")


def test_a_display_that_is_not_there_is_told_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("DISPLAY", ":987")
    assert main(["record", "pick_and_place", "--out", str(tmp_path), "--hand", "mouse"]) == 2
    [line] = capsys.readouterr().err.splitlines()
    assert line.endswith("no window opens on the display ':987'; use --hand browser instead.")
