"""Opens the studio: server, page and session, until the person ends it."""

import sys
import threading
import webbrowser
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from cobot_lfd.app.studio.page import Page
from cobot_lfd.app.studio.server import LOOPBACK, LocalServer, serve
from cobot_lfd.app.studio.session import Session


@dataclass(frozen=True, slots=True)
class Studio:
    """An open studio.

    Attributes:
        session: What happens in it.
        server: Of its page.
        address: Of its page.
    """

    session: Session
    server: LocalServer
    address: str


def open_studio(
    scene_name: str,
    robot_name: str,
    folder: Path,
    *,
    first_seed: int,
    port: int | None = None,
    host: str | None = None,
    show: bool = True,
    started: Callable[["Studio"], None] | None = None,
) -> Session:
    """Serve the studio and work in it until Ctrl-C or ``Session.close``.

    Args:
        scene_name: Name of the scene.
        robot_name: Name of the robot.
        folder: Where demonstrations are kept.
        first_seed: Of the first scene.
        port: Of the page; None for a free one.
        host: Another address of this machine on which the page is served too, behind a token.
        show: Whether to open the page in a browser.
        started: Called when the page can be opened.

    Raises:
        CobotError: If the scene, the robot, the folder or the port cannot be used.
    """
    server = serve("Recording studio", port if host is None else None)
    page = Page(server)
    gate = None
    try:
        session = Session(scene_name, robot_name, folder, first_seed, page)
        page.attach(session)
        address = f"http://{LOOPBACK}:{server.get_port()}/"
        if host is not None:
            from cobot_lfd.app.studio.gate import Gate

            gate = Gate(host, port, server.get_port())
            address = gate.address
            print(
                f"warning: the page is served on {host}; whoever has the address below can move the arm.",
                file=sys.stderr,
            )
        print(f"the studio is open at {address}\nend it with Ctrl-C", flush=True)
        if show:
            threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
        if started is not None:
            started(Studio(session, server, address))
        with suppress(KeyboardInterrupt):
            session.run()
        return session
    finally:
        if gate is not None:
            gate.close()
        server.stop()
