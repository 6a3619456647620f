"""The buttons and lists beside the picture."""

from collections.abc import Callable
from typing import Any

import numpy as np
import viser

from cobot_lfd.app.perceive import View
from cobot_lfd.app.pictures.draw import draw_detections
from cobot_lfd.app.studio.audience import Mode
from cobot_lfd.app.studio.kept import Kept
from cobot_lfd.app.studio.orders import Order, Orders
from cobot_lfd.app.studio.session import Session
from cobot_lfd.learning.model import TaskParameterisedGMM
from scenes import World, object_models

WORLD = "where they were"
_NONE = "none"
_LETTERS = 20.0  # [px] in the camera's picture, which the panel shows at about half its size
_BUSY = (Mode.WORKING, Mode.REPLAYING, Mode.TRYING)


class Panel:
    """Buttons, each of which orders one thing, and what there is to read."""

    def __init__(self, server: viser.ViserServer, session: Session) -> None:
        self._server, self._session, self._orders = server, session, Orders.of(session)
        gui = server.gui
        self._status = gui.add_markdown("")
        self._clock = gui.add_markdown("")
        self._said = gui.add_markdown("")
        tabs = gui.add_tab_group()
        with tabs.add_tab("Show"):
            self._add_recording()
            self._add_hand()
            self._camera = gui.add_image(np.zeros((48, 64, 3), dtype=np.uint8), label="Camera", format="jpeg")
        with tabs.add_tab("Kept"):
            self._add_kept()
        with tabs.add_tab("Learn"):
            self._add_learning()

    @property
    def overlay(self) -> str | None:
        """Whose paths are drawn: None for none, WORLD, or the name of a frame."""
        return None if self._overlay.value == _NONE else str(self._overlay.value)

    def on_overlay(self, redraw: Callable[[], None]) -> None:
        """Have something called, in the session's thread, when other paths are chosen."""

        @self._overlay.on_update
        async def _(_: Any) -> None:
            self._session.order(redraw)

    def show_view(self, world: World, view: View) -> None:
        """Show what the camera saw, with the frames that were found."""
        camera = world.description.camera.camera
        models = object_models(world.description)
        self._camera.image = draw_detections(
            view.picture, camera, view.detections, models=models, scale=1, text_height=_LETTERS
        )
        names = [seen.name for seen in view.detections]
        if list(self._overlay.options) != [WORLD, *names, _NONE]:
            self._overlay.options = [WORLD, *names, _NONE]

    def show_session(self, session: Session) -> None:
        """Show mode, list and model."""
        mode = session.mode
        self._status.content = f"**{'● ' if mode is Mode.RECORDING else ''}{mode.value}**"
        recording, busy = mode is Mode.RECORDING, mode in _BUSY
        self._start.disabled, self._stop.disabled = recording or busy, not recording
        self._discard.disabled = session.keeper.last is None or busy
        self._redo.disabled = self._next.disabled = busy
        self._undo.visible = session.keeper.can_undo
        self._discard.visible = not session.keeper.can_undo
        self._table.content = _table(session.kept)
        numbers = [str(number) for number in session.kept.episodes] or [_NONE]
        if list(self._chosen.options) != numbers:
            self._chosen.options = numbers
            self._chosen.value = numbers[-1]
        learnt = session.model is not None
        self._learnt.content = _UNLEARNT if session.model is None else _explained(session.model)
        self._halt.disabled = mode not in (Mode.REPLAYING, Mode.TRYING)
        self._learn.disabled = busy or len(session.kept.good) < 2
        self._try.disabled = busy or recording or not learnt

    def show_said(self, sentence: str, *, bad: bool) -> None:
        """Show what the session says."""
        self._said.content = f"**{sentence}**" if bad else sentence

    def show_clock(self, factor: float, seconds: float, near: list[int]) -> None:
        """Show whether the physics keeps up, and joints near their limits."""
        pace = "in real time" if factor > 0.97 else f"**slower than real time: {factor:.2f}×**"
        joints = f" · **joint {', '.join(map(str, near))} near its limit**" if near else ""
        self._clock.content = f"physics {pace} · t = {seconds:.2f} s{joints}"

    def _add_recording(self) -> None:
        session, orders = self._session, self._orders
        self._start = self._order(orders.start, "player-record")
        self._stop = self._order(orders.stop, "player-stop")
        self._next = self._order(orders.next_scene, "check")
        self._redo = self._button("Redo", session.redo, "repeat")
        self._discard = self._button("Discard", session.discard_last, "trash")
        self._undo = self._order(orders.undo, "arrow-back-up")

    def _add_hand(self) -> None:
        session = self._session
        guide = self._server.gui.add_checkbox(
            "Planar guide", initial_value=True, hint="Keeps the tool's height and lets it point down."
        )

        @guide.on_update
        async def _(_: Any) -> None:
            session.stage.hand.guide = bool(guide.value)

        orders = self._orders
        self._order(orders.gripper, "hand-grab")
        self._group("Tool", (orders.lower, orders.lift))
        self._group("Turn", (orders.left, orders.right, orders.align))

    def _add_kept(self) -> None:
        session, gui = self._session, self._server.gui
        self._table = gui.add_markdown("")
        self._chosen: Any = gui.add_dropdown("Demonstration", [_NONE])

        def with_chosen(what: Callable[[int], None]) -> Callable[[], None]:
            return lambda: what(int(self._chosen.value)) if self._chosen.value != _NONE else None

        self._button("Replay", with_chosen(session.replay), "player-play")
        self._button("Discard this one", with_chosen(session.discard), "trash")
        self._overlay = gui.add_dropdown("Paths", [WORLD, _NONE], hint="Seen from which frame.")

    def _add_learning(self) -> None:
        self._learn = self._order(self._orders.learn, "school")
        self._try = self._order(self._orders.attempt, "robot")
        self._halt = self._order(self._orders.halt, "hand-stop")
        self._learnt = self._server.gui.add_markdown(_UNLEARNT)

    def _group(self, label: str, orders: tuple[Order, ...]) -> None:
        """Small buttons in a row."""
        group = self._server.gui.add_button_group(label, tuple(order.shown for order in orders))

        @group.on_click
        async def _(_: Any) -> None:
            self._session.order(next(order.do for order in orders if order.shown == group.value))

        for order in orders:
            self._key(f"{label}: {order.label}", order.key, order.do)

    def _key(self, label: str, key: Any, what: Callable[[], None]) -> None:
        """A key that orders something."""
        command = self._server.gui.add_command(label, hotkey=key)

        @command.on_trigger
        async def _(_: Any) -> None:
            self._session.order(what)

    def _order(self, order: Order, icon: Any) -> Any:
        """A button, with a key that does the same."""
        button = self._button(order.shown, order.do, icon)
        self._key(order.label, order.key, lambda: None if button.disabled else order.do())
        return button

    def _button(self, label: str, what: Callable[[], None], icon: Any) -> Any:
        """A button without a key."""
        button = self._server.gui.add_button(label, icon=icon)

        @button.on_click
        async def _(_: Any) -> None:
            self._session.order(what)

        return button


_UNLEARNT = "Nothing is learnt yet. Show the task two times or more, then press Learn."


def _explained(model: TaskParameterisedGMM) -> str:
    """What was learnt, as a list of sentences."""
    return "\n".join(f"- {sentence}" for sentence in model.explain().splitlines())


def _table(kept: Kept) -> str:
    """The demonstrations as a table in Markdown."""
    if not kept.episodes:
        return "Nothing is kept yet."
    lines = ["| no. | seed | seconds | smooth | |", "|---|---|---|---|---|"]
    for number, episode in kept.episodes.items():
        quality = kept.qualities[number]
        smooth = "-" if quality.smoothness is None else f"{quality.smoothness:.2f}"
        mark = "done" if episode.verdict.succeeded else "failed"
        failure = [] if episode.verdict.succeeded else [episode.verdict.sentence]
        notes = "; ".join([mark, *failure, *quality.warnings])
        lines.append(f"| {number} | {episode.seed} | {quality.duration:.1f} | {smooth} | {notes} |")
    return "\n".join([*lines, *(f"\n**{sentence}**" for sentence in kept.damaged)])
