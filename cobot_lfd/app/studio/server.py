"""The web server of the page: viser, on this machine only and without a way out."""

from __future__ import annotations

import io
import socket
from contextlib import redirect_stdout

import viser

from cobot_lfd.errors import CobotError

LOOPBACK = "127.0.0.1"


class LocalServer(viser.ViserServer):
    """Viser that never opens a tunnel: its share button would lead the page through a foreign server."""

    def request_share_url(self, verbose: bool = True) -> str | None:
        """Refuse, whatever a page asks for."""
        del verbose
        return None

    def stop(self) -> None:
        """Stop serving, and close what viser leaves open."""
        with redirect_stdout(io.StringIO()):  # nobody asked
            super().stop()
        loop = self.get_event_loop()
        if not loop.is_running():
            loop.close()


def serve(label: str, port: int | None) -> LocalServer:
    """Serve a page on the loopback address.

    Args:
        label: Its title.
        port: The port; None for a free one.

    Raises:
        CobotError: If the port is taken.
    """
    chosen = free_port() if port is None else port
    if port is not None and not _is_free(port):
        raise CobotError(f"--port {port} is in use; choose another one, or leave it out for a free one.")
    with redirect_stdout(io.StringIO()):  # our own address is printed instead
        server = LocalServer(host=LOOPBACK, port=chosen, label=label, verbose=False)
    server.gui.configure_theme(show_share_button=False, show_logo=False, control_width="medium")
    server.gui.main_panel.dock_right()  # beside the picture, not over it
    return server


def free_port() -> int:
    """A port of the loopback address that nobody uses now."""
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        return int(probe.getsockname()[1])


def _is_free(port: int) -> bool:
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((LOOPBACK, port))
        except OSError:
            return False
    return True
