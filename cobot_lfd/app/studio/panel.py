"""The buttons and lists beside the picture."""

from collections.abc import Callable
from typing import Any

import numpy as np
import viser

from cobot_lfd.app.perceive import View
from cobot_lfd.app.pictures.draw import draw_detections
from cobot_lfd.app.studio.audience import Mode
from cobot_lfd.app.studio.kept import Kept
from cobot_lfd.app.studio.session import Session
from scenes import World, object_models

_TURN = np.deg2rad(10.0)
WORLD = "where they were"
_NONE = "none"
_BUSY = (Mode.WORKING, Mode.REPLAYING, Mode.TRYING)


class Panel:
    """Buttons, each of which orders one thing, and what there is to read."""

    def __init__(self, server: viser.ViserServer, session: Session) -> None:
        self._server, self._session = server, session
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
        self._camera.image = draw_detections(view.picture, camera, view.detections, models=models, scale=1)
        names = [seen.name for seen in view.detections]
        if list(self._overlay.options) != [WORLD, *names, _NONE]:
            self._overlay.options = [WORLD, *names, _NONE]

    def show_session(self, session: Session) -> None:
        """Show mode, list and model."""
        mode = session.mode
        self._status.content = f"### {'● ' if mode is Mode.RECORDING else ''}{mode.value}"
        recording, busy = mode is Mode.RECORDING, mode in _BUSY
        self._start.disabled, self._stop.disabled = recording or busy, not recording
        self._discard.disabled = session.last is None or busy
        self._redo.disabled = self._next.disabled = busy
        self._undo.visible = session.can_undo
        self._discard.visible = not session.can_undo
        self._table.content = _table(session.kept)
        numbers = [str(number) for number in session.kept.episodes] or [_NONE]
        if list(self._chosen.options) != numbers:
            self._chosen.options = numbers
            self._chosen.value = numbers[-1]
        learnt = session.model is not None
        self._learnt.content = session.model.explain() if session.model is not None else _UNLEARNT
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
        session = self._session
        self._start = self._button("Start", session.start, "player-record", "R")
        self._stop = self._button("Stop", session.stop, "player-stop", "T")
        self._next = self._button("Keep, next scene", session.next_scene, "check", "N")
        self._redo = self._button("Redo", session.redo, "repeat", None)
        self._discard = self._button("Discard", session.discard_last, "trash", None)
        self._undo = self._button("Undo", session.undo, "arrow-back-up", "Z")

    def _add_hand(self) -> None:
        session = self._session
        guide = self._server.gui.add_checkbox(
            "Planar guide", initial_value=True, hint="Keeps the tool's height and lets it point down."
        )

        @guide.on_update
        async def _(_: Any) -> None:
            session.stage.hand.guide = bool(guide.value)

        def hand(name: str, *arguments: float) -> Callable[[], None]:
            return lambda: getattr(session.stage.hand, name)(*arguments)

        self._button("Close or open the gripper", hand("close_or_open"), "hand-grab", "G")
        self._group("Tool", {"Lower [S]": hand("lower"), "Lift [W]": hand("lift")})
        turns = {"left [Q]": hand("turn", _TURN), "right [E]": hand("turn", -_TURN)}
        self._group("Turn", turns | {"to the part [A]": session.stage.align})

    def _add_kept(self) -> None:
        session, gui = self._session, self._server.gui
        self._table = gui.add_markdown("")
        self._chosen: Any = gui.add_dropdown("Demonstration", [_NONE])

        def with_chosen(what: Callable[[int], None]) -> Callable[[], None]:
            return lambda: what(int(self._chosen.value)) if self._chosen.value != _NONE else None

        self._button("Replay", with_chosen(session.replay), "player-play", None)
        self._button("Discard this one", with_chosen(session.discard), "trash", None)
        self._overlay = gui.add_dropdown("Paths", [WORLD, _NONE], hint="Seen from which frame.")

    def _add_learning(self) -> None:
        session = self._session
        self._learn = self._button("Learn", session.learn, "school", "L")
        self._try = self._button("Let the arm try", session.try_it, "robot", "Y")
        self._button("Stop the arm", lambda: None, "hand-stop", "X")
        self._learnt = self._server.gui.add_markdown(_UNLEARNT)

    def _group(self, label: str, choices: dict[str, Callable[[], None]]) -> None:
        """Small buttons in a row; each name ends with its key."""
        group = self._server.gui.add_button_group(label, tuple(choices))

        @group.on_click
        async def _(_: Any) -> None:
            self._session.order(choices[group.value])

        for name, what in choices.items():
            self._key(f"{label}: {name[:-4]}", name[-2], what)

    def _key(self, label: str, key: Any, what: Callable[[], None]) -> None:
        """A key that orders something."""
        command = self._server.gui.add_command(label, hotkey=key)

        @command.on_trigger
        async def _(_: Any) -> None:
            self._session.order(what)

    def _button(self, label: str, what: Callable[[], None], icon: Any, key: Any) -> Any:
        """A button, with a key that does the same."""
        shown = label if key is None else f"{label} [{key}]"
        button = self._server.gui.add_button(shown, icon=icon)

        @button.on_click
        async def _(_: Any) -> None:
            self._session.order(what)

        if key is not None:
            self._key(label, key, lambda: None if button.disabled else what())
        return button


_UNLEARNT = "Nothing is learnt yet. Show the task two times or more, then press Learn."


def _table(kept: Kept) -> str:
    """The demonstrations as a table in Markdown."""
    if not kept.episodes:
        return "Nothing is kept yet."
    lines = ["| | seed | s | smooth | |", "|---|---|---|---|---|"]
    for number, episode in kept.episodes.items():
        quality = kept.qualities[number]
        smooth = "-" if quality.smoothness is None else f"{quality.smoothness:.2f}"
        mark = "done" if episode.verdict.succeeded else "failed"
        failure = [] if episode.verdict.succeeded else [episode.verdict.sentence]
        notes = "; ".join([mark, *failure, *quality.warnings])
        lines.append(f"| {number} | {episode.seed} | {quality.duration:.1f} | {smooth} | {notes} |")
    return "\n".join([*lines, *(f"\n**{sentence}**" for sentence in kept.damaged)])
