"""The page is served on this machine only; the gate for other machines asks for a token."""

import http.client
import socket
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest

from cobot_lfd.app.studio.gate import Gate
from cobot_lfd.app.studio.launch import Studio, open_studio
from cobot_lfd.app.studio.server import LOOPBACK, serve
from cobot_lfd.errors import CobotError


class _Page(BaseHTTPRequestHandler):
    """A page that says which path was asked for."""

    def do_GET(self) -> None:
        """Answer."""
        body = f"page {self.path}".encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: object) -> None:
        """Say nothing."""


@pytest.fixture
def gate() -> Iterator[Gate]:
    """A gate before a page of one line."""
    page = HTTPServer((LOOPBACK, 0), _Page)
    thread = threading.Thread(target=page.serve_forever)
    thread.start()
    opened = Gate(LOOPBACK, None, page.server_port)
    yield opened
    opened.close()
    page.shutdown()
    thread.join()
    page.server_close()


def ask(gate: Gate, path: str, cookie: str | None = None) -> tuple[int, str, str]:
    """Status, text and cookie of an answer."""
    host, port = gate.address.split("/")[2].split(":")
    connection = http.client.HTTPConnection(host, int(port), timeout=10)
    try:
        connection.request("GET", path, headers={} if cookie is None else {"Cookie": cookie})
        answer = connection.getresponse()
        return answer.status, answer.read().decode(), answer.getheader("Set-Cookie") or ""
    finally:
        connection.close()


def test_without_the_token_nobody_comes_in(gate: Gate) -> None:
    for path, cookie in (("/", None), ("/?token=guessed", None), ("/", "cobot_lfd_token=guessed")):
        status, text, given = ask(gate, path, cookie)
        assert (status, given) == (403, "")
        assert "page" not in text


def test_the_token_in_the_address_becomes_a_cookie_that_opens_the_page(gate: Gate) -> None:
    status, _, given = ask(gate, "/?token=" + gate.address.partition("token=")[2])
    assert status == 303
    assert "HttpOnly" in given
    assert "SameSite=Strict" in given
    assert ask(gate, "/a/b", given.partition(";")[0])[:2] == (200, "page /a/b")


def test_every_gate_has_a_token_of_its_own(gate: Gate) -> None:
    other = Gate(LOOPBACK, None, 1)
    other.close()
    assert gate.address.partition("token=")[2] != other.address.partition("token=")[2]


def test_an_address_that_is_not_ours_is_told() -> None:
    with pytest.raises(CobotError, match=r"cannot listen on 192\.0\.2\.1, port any"):
        Gate("192.0.2.1", None, 1)


def test_a_studio_for_other_machines_warns_and_gives_an_address_with_a_token(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    answers: list[int] = []

    def look(studio: Studio) -> None:
        _, _, place, path = studio.address.split("/", 3)
        for asked in ("/", f"/{path}"):
            connection = http.client.HTTPConnection(place, timeout=10)
            connection.request("GET", asked)
            answers.append(connection.getresponse().status)
            connection.close()
        studio.session.close()

    open_studio("pick_and_place", "panda", tmp_path, first_seed=0, host="127.0.0.2", show=False, started=look)
    told = capsys.readouterr()
    assert answers == [403, 303]  # refused without the token; let in with it
    assert "warning: the page is served on 127.0.0.2" in told.err
    assert "http://127.0.0.2:" in told.out
    assert "/?token=" in told.out


def test_the_page_listens_on_the_loopback_address_only() -> None:
    server = serve("test", None)
    try:
        port = server.get_port()
        connection = http.client.HTTPConnection(LOOPBACK, port, timeout=10)
        connection.request("GET", "/")
        answer = connection.getresponse()
        assert answer.status == 200
        assert b"<html" in answer.read()[:500].lower()
        connection.close()
        with pytest.raises(OSError, match="refused"):
            socket.create_connection(("127.0.0.2", port), timeout=5)
        assert server.request_share_url() is None
        with pytest.raises(CobotError, match=f"--port {port} is in use"):
            serve("test", port)
    finally:
        server.stop()
