"""The studio without a browser: orders, the hand, what is kept, and what is shown."""

import resource
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cobot_lfd.app.demonstrations.store import list_episodes, load_episode
from cobot_lfd.app.perceive import View
from cobot_lfd.app.recording.replay import replay
from cobot_lfd.app.studio.audience import Mode
from cobot_lfd.app.studio.session import Session
from cobot_lfd.app.studio.stage import Stage
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Outcome
from scenes import World

pytestmark = pytest.mark.simulator


@dataclass
class Listener:
    """Notes what the session shows."""

    said_so_far: list[str] = field(default_factory=list)
    n_scenes: int = 0
    n_pictures: int = 0

    def scene_changed(self, world: World, robot_body: int, view: View) -> None:
        """Count, after a look whether the robot is in this world."""
        assert world.client.getNumJoints(robot_body) > 0
        assert len(view.detections) == 2
        self.n_scenes += 1

    def moved(self, client: Any, stage: Stage) -> None:
        """Count, after a look whether the world is still there."""
        assert client.getNumBodies() == 4
        assert 0.0 < stage.clock.factor < 1.5
        self.n_pictures += 1

    def changed(self, session: Session) -> None:
        """Nothing to be noted."""

    def said(self, sentence: str, *, bad: bool = False) -> None:
        """Note it."""
        self.said_so_far.append(f"{'bad: ' if bad else ''}{sentence}")


@contextmanager
def at_work(folder: Path, listener: Listener) -> Iterator[Session]:
    """A session in a thread of its own, as in the studio."""
    session = Session("pick_and_place", "panda", folder, 0, listener)
    thread = threading.Thread(target=session.run)
    thread.start()
    try:
        yield session
    finally:
        session.close()
        thread.join(timeout=30)


def wait_for(what: Callable[[], object], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end, "it does not come about"
        time.sleep(0.02)


def record_a_pull(session: Session) -> None:
    """Record the arm being pulled some centimetres aside."""
    session.order(session.start)
    wait_for(lambda: session.mode is Mode.RECORDING)
    session.stage.hand.reach(np.array([0.5, 0.1, 0.3]))
    time.sleep(1.0)
    session.stage.hand.let_go()


@pytest.fixture(scope="module")
def story(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Listener, dict[str, Any]]:
    """Record, discard, undo, record again, replay, ask to learn, and leave in the middle of a recording."""
    folder, listener = tmp_path_factory.mktemp("studio") / "demos", Listener()
    seen: dict[str, Any] = {}
    with at_work(folder, listener) as session:
        wait_for(lambda: session.mode is Mode.READY)
        record_a_pull(session)
        session.order(session.stop)
        wait_for(lambda: session.mode is Mode.STOPPED)
        seen["kept"] = len(list_episodes(folder))
        session.order(session.discard_last)
        wait_for(lambda: session.keeper.can_undo)
        seen["discarded"] = len(list_episodes(folder))
        session.order(session.undo)
        wait_for(lambda: not session.keeper.can_undo)
        seen["undone"] = len(list_episodes(folder))
        session.order(session.learn)
        session.order(session.next_scene)
        wait_for(lambda: session.stage.seed != 0 and session.mode is Mode.READY)
        seen["latencies"] = session.latencies
        session.order(lambda: session.replay(0))
        wait_for(lambda: session.mode is Mode.REPLAYING)
        session.order(lambda: None)
        wait_for(lambda: session.mode is Mode.READY)
        record_a_pull(session)
    return folder, listener, seen


def test_what_is_stopped_is_on_the_disk_and_discarding_can_be_undone(
    story: tuple[Path, Listener, dict[str, Any]],
) -> None:
    _, _, seen = story
    assert (seen["kept"], seen["discarded"], seen["undone"]) == (1, 0, 1)


def test_the_physics_judges_and_the_hand_moved_the_arm(
    story: tuple[Path, Listener, dict[str, Any]],
) -> None:
    folder, _, _ = story
    episode = load_episode(list_episodes(folder)[0])
    assert episode.verdict.outcome is Outcome.NOT_PLACED
    start, end = episode.tool_positions[0], episode.tool_positions[-1]
    assert np.linalg.norm(end[:2] - [0.5, 0.1]) < 0.02  # [m]; from (0.48, 0) to where it was pulled
    assert np.linalg.norm(end[:2] - start[:2]) > 0.05  # [m]
    assert np.linalg.norm(episode.hand_forces, axis=1).max() <= 40.0 + 1e-9  # [N]
    assert np.diff(episode.times) == pytest.approx(0.01)  # [s]


def test_what_was_recorded_can_be_done_again_exactly(story: tuple[Path, Listener, dict[str, Any]]) -> None:
    """Every recording begins in a fresh world, so its wrenches move the arm the same way to the last bit."""
    folder, _, _ = story
    assert replay(load_episode(list_episodes(folder)[0]), "wrenches").worst == 0.0  # [m]


def test_a_session_that_ends_while_recording_keeps_an_incomplete_episode(
    story: tuple[Path, Listener, dict[str, Any]],
) -> None:
    folder, _, _ = story
    assert [load_episode(file).verdict.outcome for file in list_episodes(folder)][-1] is Outcome.INCOMPLETE


def test_the_session_says_what_happened(story: tuple[Path, Listener, dict[str, Any]]) -> None:
    _, listener, _ = story
    said = "\n".join(listener.said_so_far)
    for phrase in (
        "Kept as ",
        "Undo brings it back",
        "Back again",
        "Learning needs two demonstrations",
        "Next scene, seed 1",
        "The replay was stopped",
    ):
        assert phrase in said
    assert listener.n_scenes >= 3
    assert listener.n_pictures > 30


def test_a_pointer_event_becomes_a_force_at_once(story: tuple[Path, Listener, dict[str, Any]]) -> None:
    _, _, seen = story
    assert np.median(seen["latencies"]) < 0.05  # [s]


def test_on_a_full_disk_the_recording_goes_on_until_there_is_room(tmp_path: Path) -> None:
    listener = Listener()
    with at_work(tmp_path / "demos", listener) as session:
        wait_for(lambda: session.mode is Mode.READY)
        record_a_pull(session)
        soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, hard))
        try:
            session.order(session.stop)
            wait_for(lambda: any("cannot save" in sentence for sentence in listener.said_so_far))
            wait_for(lambda: session.mode is Mode.RECORDING)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        session.order(session.stop)
        wait_for(lambda: session.mode is Mode.STOPPED)
    [file] = list_episodes(tmp_path / "demos")
    assert np.ptp(load_episode(file).tool_positions[:, 1]) > 0.05  # [m]; the pull from before is in it


def test_a_folder_of_another_task_is_refused(demonstrations_folder: Path) -> None:
    with pytest.raises(DataError, match="record pick_and_place with iiwa into another folder"):
        Session("pick_and_place", "iiwa", demonstrations_folder, 0, Listener())
