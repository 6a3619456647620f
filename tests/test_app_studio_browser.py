"""The studio as a person meets it: a real browser, real mouse events, the physics behind it."""

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from cobot_lfd.app.demonstrations.store import list_episodes, load_episode
from cobot_lfd.app.studio.audience import Mode
from cobot_lfd.app.studio.launch import Studio
from cobot_lfd.outcome import Outcome
from tests.studio_browser import FLAGS, PATIENCE, Person, find_chromium, studio_at_work, wait_for
from tests.studio_pose_age import Ages, Places, ages, begin_watching, end_watching

pytestmark = [
    pytest.mark.browser,
    pytest.mark.simulator,
    pytest.mark.filterwarnings("default"),  # of the browser's driver
]


@pytest.fixture
def browser() -> Iterator[object]:
    """A browser for each test, so that no page of another one goes on drawing."""
    chromium = find_chromium()
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=chromium, args=list(FLAGS))
        yield opened
        opened.close()


def demonstrate(person: Person) -> None:
    """Lead the cube into the container, by mouse and keys."""
    frames, task = person.session.stage.view.frames, person.session.stage.scene.task
    person.press("Start [R]")
    person.wait_for_mode(Mode.RECORDING)
    with person.in_a_hurry():
        person.at_height(task.carry_height)
    person.page.keyboard.press("a")
    person.drag_to(frames["cube"].position)
    grip(person, task.grasp_height)
    person.drag_to(frames["container"].position)
    grip(person, task.release_height)
    person.press("Stop [T]")
    person.wait_for_mode(Mode.STOPPED)


def grip(person: Person, height: float) -> None:
    """Lower the tool to a height [m], close or open the gripper, and lift it again."""
    hand, carry_height = person.session.stage.hand, person.session.stage.scene.task.carry_height
    closed = hand.is_closed
    with person.in_a_hurry():
        person.page.keyboard.press("s")
        person.at_height(height)
        person.page.keyboard.press("g")
        person.wait_until(lambda: hand.is_closed is not closed, "the gripper is told")
        person.let_pass(1.0)
        person.page.keyboard.press("w")
        person.at_height(carry_height)


def test_a_person_teaches_the_arm_in_a_browser(
    browser: object, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Load, drag, record, keep, list, discard, undo, replay, learn, and let the arm do it in a new scene."""
    with studio_at_work(tmp_path / "demos", seed=0) as studio:
        person = Person(browser, studio)
        person.wait_for_mode(Mode.READY)
        session, places = studio.session, Places(studio.session.stage)
        begin_watching(person.page)
        for i in range(2):
            demonstrate(person)
            assert len(session.kept.good) == i + 1, session.kept.episodes[i].verdict.sentence
            person.page.screenshot(path=tmp_path / f"kept_{i}.png")
            if i == 0:
                _discard_and_undo(person)
            with person.in_a_hurry():
                person.press("Keep, next scene [N]")
                person.wait_until(lambda: session.stage.seed not in _seeds(studio), "a new scene")
                person.wait_for_mode(Mode.READY)
        age = ages(end_watching(person.page), places.history)
        _look_at_kept(person, tmp_path)
        person.press("Learn")
        person.press("Learn [L]")
        person.wait_until(lambda: session.model is not None, "a model")
        person.wait_for_mode(Mode.READY)
        person.page.get_by_text("Nothing is learnt yet").wait_for(state="hidden")
        person.page.screenshot(path=tmp_path / "learnt.png")
        said = _listen(studio)
        with person.in_a_hurry():
            person.press("Let the arm try [Y]")
            person.wait_for_mode(Mode.TRYING)
            person.wait_for_mode(Mode.READY)
        assert any("the task is done" in sentence for sentence in said), said
        _report(person, age, capsys)
    for file in list_episodes(tmp_path / "demos"):
        carry = load_episode(file).demonstration()
        assert np.linalg.norm(carry.path[-1] - carry.frames["container"].position) < 0.03


def test_one_tab_drags_and_a_closed_tab_loses_nothing(browser: object, tmp_path: Path) -> None:
    """Two tabs: the second sees the same and cannot drag; the first is closed in the middle of a drag."""
    with studio_at_work(tmp_path, seed=3) as studio:
        first = Person(browser, studio)
        first.wait_for_mode(Mode.READY)
        second = Person(browser, studio)
        first.press("Start [R]")
        first.wait_for_mode(Mode.RECORDING)
        first.at_height(studio.session.stage.scene.task.carry_height)
        goal = first.tool()[:2] + np.array([0.05, 0.1])
        first.drag_to(goal, let_go=False)
        assert studio.session.stage.hand.pulls
        first.wait_until(lambda: np.linalg.norm(first.tool()[:2] - goal) < 0.02, "the tool follows")
        second.drag_to(goal - np.array([0.0, 0.2]), steps=8, let_go=False)
        second.pause(0.5)
        assert np.linalg.norm(first.tool()[:2] - goal) < 0.03  # the second tab did not move it
        second.page.mouse.up()
        first.page.close()
        second.wait_until(lambda: not studio.session.stage.hand.pulls, "the arm rests")
        assert studio.session.mode is Mode.RECORDING  # the second tab is still there
        second.page.close()
        wait_for(lambda: studio.session.kept.episodes, PATIENCE, "the recording is kept", time.sleep)
    [file] = list_episodes(tmp_path)
    assert load_episode(file).verdict.outcome is Outcome.INCOMPLETE


def _discard_and_undo(person: Person) -> None:
    person.press("Discard")
    person.wait_until(lambda: not person.session.kept.episodes, "it is in the trash")
    person.press("Undo [Z]")
    person.wait_until(lambda: person.session.kept.episodes, "it is back")


def _look_at_kept(person: Person, folder: Path) -> None:
    """The list, and a replay."""
    person.press("Kept")
    person.page.get_by_text("done").first.wait_for()
    person.page.screenshot(path=folder / "list.png")
    said = _listen(person.studio)
    with person.in_a_hurry():
        person.press("Replay")
        person.wait_for_mode(Mode.REPLAYING)
        person.wait_for_mode(Mode.READY)
    assert any("the tool deviates by" in sentence for sentence in said), said


def _seeds(studio: Studio) -> set[int]:
    return {episode.seed for episode in studio.session.kept.episodes.values()}


def _listen(studio: Studio) -> list[str]:
    """All that the studio says from now on."""
    said: list[str] = []
    audience = studio.session.stage.audience
    speak = audience.said

    def hear(sentence: str, *, bad: bool = False) -> None:
        said.append(sentence)
        speak(sentence, bad=bad)

    audience.said = hear  # type: ignore[method-assign]  # the test listens in
    return said


def _report(person: Person, age: Ages, capsys: pytest.CaptureFixture[str]) -> None:
    """Print what was measured; how fast a shared machine is, is no fault of the program."""
    latencies, clock = 1000 * np.array(person.session.latencies), person.session.stage.clock
    watched = clock.simulated - person.hurried
    with capsys.disabled():
        print(
            f"\nstudio: drag event to force {np.median(latencies):.1f} ms (median), {latencies.max():.1f} ms "
            f"(worst of {len(latencies)}); physics {watched / (watched + clock.lost):.2f}x real time "
            f"({clock.lost:.1f} s of {watched + clock.lost:.0f} s given up); the shown pose's age: {age}"
        )
    assert np.median(latencies) < 50.0  # [ms]
    assert len(age.given)
