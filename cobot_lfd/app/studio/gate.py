"""The way in from other machines: a door that asks for a token, before a page that only this machine sees."""

import asyncio
import secrets
import threading
from contextlib import suppress
from hmac import compare_digest
from http.cookies import CookieError, SimpleCookie

from cobot_lfd.app.studio.server import LOOPBACK
from cobot_lfd.errors import CobotError

_COOKIE = "cobot_lfd_token"
_MOST_HEADER = 65536  # [bytes]
_END = "Connection: close\r\n\r\n"
_CLOSED = (
    f"HTTP/1.1 403 Forbidden\r\nContent-Type: text/plain\r\n{_END}The address lacks its token.\n".encode()
)


class Gate:
    """Forwards connections that know the token to the page; all others are refused.

    The token comes once in the address (``/?token=...``), and then in a cookie.

    Attributes:
        address: With the token.
    """

    def __init__(self, host: str, port: int | None, page_port: int) -> None:
        """Open the gate.

        Args:
            host: The address of this machine to listen on.
            port: The port; None for a free one.
            page_port: Port of the page on the loopback address.

        Raises:
            CobotError: If that address cannot be listened on.
        """
        self._token = secrets.token_urlsafe(24)
        self._page_port = page_port
        self._loop = asyncio.new_event_loop()
        try:
            self._server = self._loop.run_until_complete(asyncio.start_server(self._admit, host, port or 0))
        except OSError as error:
            self._loop.close()
            raise CobotError(f"cannot listen on {host}, port {port or 'any'}: {error.strerror}.") from error
        bound = self._server.sockets[0].getsockname()[1]
        self.address = f"http://{host}:{bound}/?token={self._token}"
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Close the gate; who is inside is shown out."""

        async def end() -> None:
            self._server.close()
            for task in asyncio.all_tasks() - {asyncio.current_task()}:
                task.cancel()
            self._loop.call_later(0.05, self._loop.stop)

        asyncio.run_coroutine_threadsafe(end(), self._loop)
        self._thread.join(timeout=2.0)
        if not self._thread.is_alive():
            self._loop.close()

    async def _admit(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Look at the first request of a connection."""
        try:
            head = await asyncio.wait_for(reader.readuntil(b"\r\n\r\n"), timeout=10.0)
            target, cookie = _read(head[:_MOST_HEADER])
            if compare_digest(cookie, self._token):
                await self._forward(head, reader, writer)
            elif compare_digest(target.partition("token=")[2], self._token):
                writer.write(self._welcome())
            else:
                writer.write(_CLOSED)
            await writer.drain()
        except (OSError, asyncio.IncompleteReadError, asyncio.LimitOverrunError, TimeoutError):
            pass
        finally:
            writer.close()

    def _welcome(self) -> bytes:
        """Give the token as a cookie, and lead to the page without it in the address."""
        cookie = f"{_COOKIE}={self._token}; HttpOnly; SameSite=Strict; Path=/"
        return f"HTTP/1.1 303 See Other\r\nLocation: /\r\nSet-Cookie: {cookie}\r\n{_END}".encode()

    async def _forward(self, head: bytes, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Connect the two ends for as long as both are there."""
        page_reader, page_writer = await asyncio.open_connection(LOOPBACK, self._page_port)
        page_writer.write(head)
        ways = [
            asyncio.ensure_future(_copy(reader, page_writer)),
            asyncio.ensure_future(_copy(page_reader, writer)),
        ]
        try:
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for way in ways:
                way.cancel()
            page_writer.close()


async def _copy(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    with suppress(OSError):
        while data := await reader.read(65536):
            writer.write(data)
            await writer.drain()


def _read(head: bytes) -> tuple[str, str]:
    """The target of a request and the token in its cookie; empty where there is none."""
    lines = head.decode("latin-1").split("\r\n")
    target = [*lines[0].split(" "), ""][1]
    for line in lines[1:]:
        name, _, value = line.partition(":")
        if name.strip().lower() == "cookie":
            with suppress(CookieError):
                morsel = SimpleCookie(value.strip()).get(_COOKIE)
                return target, morsel.value if morsel is not None else ""
    return target, ""
