"""A session in the simulator's window: mouse and keys there move the same hand as on the page."""

import multiprocessing
import os
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from cobot_lfd.app.perceive import View
from cobot_lfd.app.studio.mirror import Drag, Sight, Signal, show_window, sight_of
from cobot_lfd.app.studio.orders import Order, Orders
from cobot_lfd.app.studio.pointer import Grab
from cobot_lfd.app.studio.session import Session
from cobot_lfd.app.studio.stage import Stage
from cobot_lfd.errors import CobotError
from scenes import World

_PATIENCE = 90.0  # [s] for a window to open, on a busy machine without a graphics card
_HELP = "drag the arm with the left mouse button; look from elsewhere with Ctrl and a drag, or the wheel"


def open_window(
    scene_name: str,
    robot_name: str,
    folder: Path,
    *,
    first_seed: int,
    started: Callable[[Session], None] | None = None,
) -> Session:
    """Open the window and work in it until it is closed, or until Ctrl-C.

    Args:
        scene_name: Name of the scene.
        robot_name: Name of the robot.
        folder: Where demonstrations are kept.
        first_seed: Of the first scene.
        started: Called when the window is there.

    Raises:
        CobotError: If there is no display, or the scene, the robot or the folder cannot be used.
    """
    if not os.environ.get("DISPLAY"):
        raise CobotError("--hand mouse needs a display (DISPLAY is not set); use --hand browser instead.")
    window = Window()
    session = Session(scene_name, robot_name, folder, first_seed, window)
    window.open(session, scene_name, robot_name)
    try:
        if started is not None:
            started(session)
        with suppress(KeyboardInterrupt):
            session.run()
    finally:
        window.close()
    return session


class Window:
    """The audience in front of the window, and how its mouse gets to the hand.

    Nothing here waits for the window: it is sent the newest sight when it has shown the one before.
    """

    def __init__(self) -> None:
        """A window that is not open yet: whoever prepares a session may speak to it already."""
        context = multiprocessing.get_context("spawn")
        self._connection, self._far_end = context.Pipe()
        self._context = context
        self._process: Any = None
        self._session: Session | None = None
        self._orders: dict[str, Order] = {}
        self._grab: Grab | None = None
        self._has_time = threading.Event()

    def open(self, session: Session, scene_name: str, robot_name: str) -> None:
        """Open the window for a session.

        Raises:
            CobotError: If the display has no place for it.
        """
        self._session = session
        orders = Orders.of(session)
        offered = (
            orders.start, orders.stop, orders.next_scene, orders.undo, orders.gripper, orders.lower,
            orders.lift, orders.left, orders.right, orders.align, orders.guide,
        )  # fmt: skip
        self._orders = {order.key: order for order in offered}
        self._process = self._context.Process(
            target=show_window, args=(self._far_end, scene_name, robot_name), daemon=True
        )
        self._process.start()
        self._far_end.close()
        self._await_opening()
        print("\n".join([_HELP, "  ".join(f"{order.key} {order.label}" for order in offered)]), flush=True)
        threading.Thread(target=self._listen, daemon=True).start()

    def close(self) -> None:
        """Close the window."""
        self._connection.close()
        self._process.join(timeout=10.0)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()

    def scene_changed(self, world: World, robot_body: int, view: View) -> None:
        """Other objects stand on the table; the next sight shows them."""

    def moved(self, client: Any, stage: Stage) -> None:
        """Time has passed: show it, if the window has time to."""
        if self._session is None or not self._has_time.is_set():
            return
        pointer, tool = stage.hand.pointer, stage.shown_tool
        force = None
        if pointer is not None:
            height = tool[2] if stage.hand.guide else pointer[2]
            force = np.array([tool, [pointer[0], pointer[1], height]])
        self._send(sight_of(client, stage.robot_body, force, self._session.mode.value))

    def changed(self, session: Session) -> None:
        """The mode is part of every sight; the list of what is kept is left to ``cobot-lfd demos``."""

    def said(self, sentence: str, *, bad: bool = False) -> None:
        """Tell it on the terminal."""
        print(f"! {sentence}" if bad else sentence, flush=True)

    def _send(self, sight: Sight) -> None:
        self._has_time.clear()
        with suppress(OSError):  # the window was closed; whoever listens to it notices
            self._connection.send(sight)

    def _await_opening(self) -> None:
        with suppress(EOFError, OSError):
            if self._connection.poll(_PATIENCE) and self._connection.recv() is Signal.OPENED:
                self._has_time.set()
                return
        self.close()
        display = os.environ.get("DISPLAY")
        raise CobotError(f"no window opens on the display '{display}'; use --hand browser instead.")

    def _listen(self) -> None:
        """Hear what the window tells until it is closed, which ends the session."""
        session = self._session
        if session is None:
            return
        with suppress(EOFError, OSError):
            while True:
                match self._connection.recv():
                    case Signal():
                        self._has_time.set()
                    case Drag() as drag:
                        self._drag(session, drag)
                    case str() as key if key in self._orders:
                        session.order(self._orders[key].do)
        session.stage.hand.let_go()
        session.close()

    def _drag(self, session: Session, drag: Drag) -> None:
        hand = session.stage.hand
        if drag.phase == "end":
            self._grab = None
            hand.let_go()
            return
        if drag.phase == "start":
            self._grab = Grab(0, drag.pointer, session.stage.shown_tool)
        if self._grab is not None:
            hand.reach(self._grab.goal(drag.camera, drag.pointer, guide=hand.guide))
