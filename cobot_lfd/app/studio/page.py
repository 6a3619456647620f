"""The page: the picture in which the tool is dragged, and the panel beside it."""

from typing import Any

import numpy as np
import viser

from cobot_lfd.app.perceive import View
from cobot_lfd.app.studio.overlays import ForceLine, Glow, Paths, Plumb
from cobot_lfd.app.studio.panel import WORLD, Panel
from cobot_lfd.app.studio.pointer import Grab
from cobot_lfd.app.studio.session import Session
from cobot_lfd.app.studio.stage import Stage
from cobot_lfd.app.studio.table_view import TableView
from cobot_lfd.arrays import Array
from scenes import World

_HANDLE_COLOUR, _HANDLE_RADIUS = (240, 120, 20), 0.05
_CLOCK_EVERY = 0.25  # [s] between two looks of the panel's clock


class Page:
    """What a session looks like in the browser, and how the mouse gets to the hand."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Prepare the picture; the panel follows with ``attach``, since its buttons need the session."""
        self._server = server
        self._table = TableView(server)
        self._force, self._paths = ForceLine(server), Paths(server)
        self._plumb = Plumb(server)
        self._handle = server.scene.add_icosphere(
            "/handle", radius=_HANDLE_RADIUS, color=_HANDLE_COLOUR, opacity=0.35
        )
        self._tool = np.zeros(3)
        self._glow: Glow | None = None
        self._panel: Panel | None = None
        self._session: Session | None = None
        self._grab: Grab | None = None
        self._clock_at = -1.0
        # Where the page is drawn in software, shadows and mirrored surroundings cost more than all else.
        server.scene.configure_default_lights(cast_shadow=False)
        server.scene.configure_environment_map(hdri=None)
        server.scene.add_light_ambient("/light", intensity=1.5)
        server.initial_camera.position = (1.3, -0.5, 0.8)
        server.initial_camera.look_at = (0.4, 0.05, 0.17)

    def attach(self, session: Session) -> None:
        """Add the panel and listen to the mouse."""
        self._session = session
        self._glow = Glow(self._server, session.stage.robot)
        self._panel = Panel(self._server, session)
        self._panel.on_overlay(self._draw_paths)
        self._listen(self._handle)

        @self._server.on_client_disconnect
        async def _(client: viser.ClientHandle) -> None:
            self._let_go(client.client_id)
            if not [other for other in self._server.get_clients() if other != client.client_id]:
                session.order(session.abandoned)

    def scene_changed(self, world: World, robot_body: int, view: View) -> None:
        """Other objects stand on the table."""
        first = self._table.robot is None
        with self._server.atomic():
            self._table.show(world, robot_body)
        if first and self._table.robot is not None:
            for link in sorted(self._table.robot.shapes)[-3:]:
                for shape in self._table.robot.shapes[link]:
                    self._listen(shape)
        if self._panel is not None:
            self._panel.show_view(world, view)
            self._draw_paths()

    def moved(self, client: Any, stage: Stage) -> None:
        """Time has passed: show the arm, the force and the joints near their limits."""
        self._tool = stage.shown_tool
        with self._server.atomic():
            self._table.move(client)
            self._handle.position = self._tool
            self._plumb.show(self._tool)
            self._force.show(self._tool, self._pulled_to(stage))
        near = []
        if self._glow is not None:
            near = self._glow.show(client, stage.robot_body, stage.arm.body.joints)
        if self._panel is not None and abs(stage.world.time - self._clock_at) >= _CLOCK_EVERY:
            self._clock_at = stage.world.time
            self._panel.show_clock(stage.clock.factor, stage.world.time, near)

    def changed(self, session: Session) -> None:
        """Show mode, list and model."""
        if self._panel is not None:
            self._panel.show_session(session)
            self._draw_paths()

    def said(self, sentence: str, *, bad: bool = False) -> None:
        """Tell all tabs, in the panel, where it hides nothing."""
        if self._panel is not None:
            self._panel.show_said(sentence, bad=bad)

    def _pulled_to(self, stage: Stage) -> Array | None:
        pointer = stage.hand.pointer
        if pointer is None or not stage.hand.guide:
            return pointer
        return np.array([pointer[0], pointer[1], self._tool[2]])

    def _draw_paths(self) -> None:
        if self._panel is None or self._session is None:
            return
        overlay, session = self._panel.overlay, self._session
        episodes = session.kept.good if overlay is not None else []
        seen_from = None if overlay in (None, WORLD) else overlay
        self._paths.show_demonstrations(episodes, seen_from, session.stage.view.frames)
        self._paths.show_generated(session.path)

    def _listen(self, node: Any) -> None:
        """Let a node be dragged; asynchronous callbacks keep the order of the events."""

        async def drag(event: Any) -> None:
            self._drag(event)

        node.on_drag("left")(drag)

    def _drag(self, event: Any) -> None:
        """One event of a drag; the first tab that drags keeps the hand until it lets go."""
        session = self._session
        if session is None:
            return
        if event.phase == "end":
            self._let_go(event.client_id)
            return
        if self._grab is None and event.phase == "start":
            self._grab = Grab(event.client_id, event.start_position, self._tool)
        if self._grab is None or self._grab.tab != event.client_id:
            if event.phase == "start":
                event.client.add_notification(
                    "Recording studio", "Another tab leads the arm.", color="orange"
                )
            return
        hand = session.stage.hand
        hand.reach(self._grab.goal(event.client.camera.position, event.end_position, guide=hand.guide))

    def _let_go(self, tab: int) -> None:
        """Let go, if it was this tab that dragged."""
        if self._grab is not None and self._grab.tab == tab and self._session is not None:
            self._grab = None
            self._session.stage.hand.let_go()
