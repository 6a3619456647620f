"""A person at the studio's page, for tests: a real browser, real mouse and keys."""

import os
import shutil
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cobot_lfd.app.studio.audience import Mode
from cobot_lfd.app.studio.launch import Studio, open_studio
from cobot_lfd.arrays import Array

FLAGS = (
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)


def find_chromium() -> str:
    """The browser's program; without one the test is skipped, or fails where it must not be skipped."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None:
        reason = "no Chromium is installed (Debian, Ubuntu: apt-get install chromium)"
        if os.environ.get("CI") or os.environ.get("COBOT_LFD_REQUIRE_BROWSER") == "1":
            pytest.fail(reason)
        pytest.skip(reason)
    return found


def wait_for(what: Callable[[], object], seconds: float, why: str, pause: Callable[[float], object]) -> None:
    """Wait until something holds."""
    end = time.monotonic() + seconds
    while not what():
        if time.monotonic() > end:
            raise AssertionError(f"not within {seconds:.0f} s: {why}")
        pause(0.05)


@contextmanager
def studio_at_work(folder: Path, seed: int) -> Iterator[Studio]:
    """A studio in a thread of this process."""
    opened: list[Studio] = []
    failures: list[BaseException] = []

    def work() -> None:
        try:
            open_studio("pick_and_place", "panda", folder, first_seed=seed, show=False, started=opened.append)
        except BaseException as error:
            failures.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    try:
        wait_for(lambda: opened or failures, PATIENCE, "the studio opens", time.sleep)
        assert not failures, failures
        yield opened[0]
    finally:
        if opened:
            opened[0].session.close()
        thread.join(timeout=60)
    assert not failures, failures


WINDOW = {"width": 900, "height": 480}  # [px]
PATIENCE = 300.0  # [s] for what happens at once, but on a machine that is busy with other work
PROJECTION = """(point) => {
    const {camera, canvas, nodeRefFromName} = window.__viserMutable;
    const handle = nodeRefFromName['/handle'];
    const place = handle.position.clone().set(...point).applyMatrix4(handle.parent.matrixWorld);
    const seen = place.project(camera);
    const frame = canvas.getBoundingClientRect();
    return [frame.left + frame.width * (1 + seen.x) / 2, frame.top + frame.height * (1 - seen.y) / 2];
}"""
FAST = 4.0  # times real time, where the arm moves by itself and nobody needs to watch


class Person:
    """Somebody who looks at the page and moves the mouse.

    Attributes:
        hurried: Simulated time that passed in a hurry, of which real time is not asked [s].
    """

    def __init__(self, browser: Any, studio: Studio) -> None:
        self.studio = studio
        self.session = studio.session
        self.hurried = 0.0
        self._nudge = 0.5  # [px]
        # The browser's library is imported only where there is a browser, so its type is not named here.
        self.page = browser.new_page(viewport=WINDOW)
        self.page.set_default_timeout(1000 * PATIENCE)
        before = set(studio.server.get_clients())
        self.page.goto(studio.address)
        self.page.get_by_text("Start [R]", exact=True).wait_for()
        self.wait_until(lambda: set(studio.server.get_clients()) - before, "the tab is known")
        [self.tab] = set(studio.server.get_clients()) - before

    def pause(self, seconds: float) -> None:
        """Wait, while the browser goes on."""
        self.page.wait_for_timeout(1000 * seconds)

    def wait_until(self, what: Callable[[], object], why: str) -> None:
        """Wait until something holds."""
        wait_for(what, PATIENCE, why, self.pause)

    @contextmanager
    def in_a_hurry(self) -> Iterator[None]:
        """Let time pass faster for a while."""
        clock = self.session.stage.clock
        before, clock.pace = clock.simulated, FAST
        try:
            yield
        finally:
            clock.pace = 1.0
            self.hurried += clock.simulated - before

    def let_pass(self, seconds: float) -> None:
        """Wait until so much simulated time has passed."""
        clock = self.session.stage.clock
        end = clock.simulated + seconds
        self.wait_until(lambda: clock.simulated >= end, f"{seconds} s pass in the simulation")

    def wait_for_mode(self, mode: Mode) -> None:
        """Wait until the studio is in a mode."""
        self.wait_until(lambda: self.session.mode is mode, f"{mode} (it is {self.session.mode})")

    def press(self, label: str) -> None:
        """Press a button, as soon as it is there, rests and can be pressed."""
        self.page.get_by_role("tab", name=label, exact=True).or_(
            self.page.get_by_role("button", name=label, exact=True)
        ).click()

    def tool(self) -> Array:
        """Where the tool is [m]; read from the simulation's last state, as shown."""
        return np.array(self.session.stage.shown_tool)

    def pixel(self, point: Array) -> tuple[float, float]:
        """Where a point of the world is on the page [px], by the page's own camera: the server's may lag."""
        u, v = self.page.evaluate(PROJECTION, np.asarray(point).tolist())
        return float(u), float(v)

    def drag_to(self, goal: Array, steps: int = 25, *, let_go: bool = True) -> None:
        """Drag the handle until the tool is over a place on the table [m], shape (2,)."""
        mouse = self.page.mouse
        self.wait_until(self._meets_handle, "the mouse is over the handle")
        tool = self.tool()
        place = self.pixel(tool)
        mouse.down()
        way = np.array([*(goal - tool[:2]), 0.0])
        for share in 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, steps)):
            place = self.pixel(tool + share * way)
            mouse.move(*place)
            self.pause(0.04)
        if let_go:
            self._correct(goal, np.array(place))
            mouse.up()

    def _meets_handle(self) -> bool:
        """Move the mouse to where the tool is now; tell whether the page knew it over the handle before."""
        known = self._is_over_handle()
        self._nudge = -self._nudge  # A mouse that does not move is not looked for again.
        u, v = self.pixel(self.tool())
        self.page.mouse.move(u + self._nudge, v)
        return known and self._is_over_handle()

    def _is_over_handle(self) -> bool:
        """Whether the page knows that the mouse is over something that can be dragged."""
        return bool(
            self.page.evaluate(
                "() => [...document.querySelectorAll('canvas')].some((c) => c.style.cursor === 'pointer')"
            )
        )

    def _correct(self, goal: Array, place: Array) -> None:
        """Look where the tool has come to, and move the mouse by what is missing, as everybody does."""
        for _ in range(12):
            tool = self._at_rest()
            missing = np.array([*(goal - tool[:2]), 0.0])
            if np.linalg.norm(missing) < 0.008:
                return
            place = place + np.array(self.pixel(tool + missing)) - np.array(self.pixel(tool))
            self.page.mouse.move(*place)
        raise AssertionError(f"the tool is at {self.tool()}, not at {goal}")

    def _at_rest(self) -> Array:
        """Where the tool is as soon as it rests [m]."""
        place = self.tool()
        while True:
            self.let_pass(0.25)
            before, place = place, self.tool()
            if np.linalg.norm(place - before) < 0.002:
                return place

    def at_height(self, height: float) -> None:
        """Wait until the tool is at a height [m] and rests."""
        self.wait_until(lambda: abs(self.tool()[2] - height) < 0.006, f"the tool is at {height} m")
        self.let_pass(0.3)
