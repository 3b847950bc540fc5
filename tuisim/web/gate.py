"""Who may use the server: whoever has the secret part of its address, from a page of its own.

Connections that do not send it are closed after a while, and are few at a time.
"""

from __future__ import annotations

import asyncio
import errno
import re
import secrets
import socket
import time
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import asynccontextmanager
from dataclasses import field, replace
from ipaddress import ip_address
from typing import Any
from urllib.parse import urlsplit

from aiohttp import web

from tuisim.base.data_class import dataclass

STRANGER_S = 5.0
"""A new connection that has not sent a request with the server's token after this time is closed."""
MAX_STRANGERS = 64
"""The most connections that have not yet sent the token; while there are more, the oldest of these is closed."""
_NOT_YET_S = 0.1
"""Time after which closing a connection is tried again if the connection has no transport yet."""
_TOLD_EVERY_S = 60.0
_NO_ROOM = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)


class Door:
    """A listening socket that closes each connection that does not send the server's token within `STRANGER_S` seconds.

    While more than `MAX_STRANGERS` connections have not sent it, the oldest of these is closed.

    Args:
        report: Called with a message for the server's terminal.
        clock: A monotonic clock in seconds.
    """

    def __init__(
        self, report: Callable[[str], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._report = report
        self._clock = clock
        self._strangers: dict[web.RequestHandler, asyncio.TimerHandle] = {}
        self._told_s = -_TOLD_EVERY_S

    @asynccontextmanager
    async def open(self, answers: web.Server, host: str | None, port: int) -> AsyncIterator[int]:
        """In an `async with` block, listen for connections; the block gets the port.

        Args:
            answers: The server that handles the connections.
            host: Host name or address to listen on.
            port: Port to listen on; 0 takes any free one.

        Raises:
            OSError: the address cannot be used.
        """
        loop = asyncio.get_running_loop()

        def answer_stranger() -> web.RequestHandler:
            handler = answers()
            self._strangers[handler] = loop.call_later(STRANGER_S, self._close, handler)
            if len(self._strangers) > MAX_STRANGERS:
                self._close(next(iter(self._strangers)))
            return handler

        before = loop.get_exception_handler()
        loop.set_exception_handler(self._hear)
        listener = await loop.create_server(answer_stranger, host, port)
        try:
            yield int(listener.sockets[0].getsockname()[1])
        finally:
            listener.close()
            loop.set_exception_handler(before)
            for timer in self._strangers.values():
                timer.cancel()

    def admit(self, request: web.BaseRequest) -> None:
        """Mark the connection of a request that has the token, so that it is not closed after a time."""
        if (timer := self._strangers.pop(request.protocol, None)) is not None:
            timer.cancel()

    def _close(self, handler: web.RequestHandler) -> None:
        self._strangers.pop(handler).cancel()
        if handler.transport is not None:
            handler.transport.abort()
        else:
            # A connection without a transport is already closed, or not open yet: try again later.
            asyncio.get_running_loop().call_later(_NOT_YET_S, _abort_connection, handler)

    def _hear(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        """Handle an error of the event loop.

        An error that prevents all connections is reported only from time to time.
        """
        error = context.get("exception")
        if not isinstance(error, OSError) or error.errno not in _NO_ROOM:
            loop.default_exception_handler(context)
        elif self._clock() >= self._told_s + _TOLD_EVERY_S:
            self._told_s = self._clock()
            self._report(f"The server cannot accept visitors: {error.strerror}")


def _abort_connection(handler: web.RequestHandler) -> None:
    if handler.transport is not None:
        handler.transport.abort()


_HOST = re.compile(r"[\w.-]+(:\d+)?|\[[\da-fA-F:.]+\](:\d+)?", re.ASCII)
_LOCAL = frozenset({"127.0.0.1", "localhost", "::1"})
"""Names of this machine that a tunnel also uses at its other end."""


def is_any_address(host: str) -> bool:
    """Return whether a host to listen on means all addresses of the machine."""
    try:
        return ip_address(host).is_unspecified
    except ValueError:
        return not host


def create_token() -> str:
    """Return a new random token for the address of a server."""
    return secrets.token_urlsafe(24)


@dataclass(frozen=True, slots=True)
class Gate:
    """The rules of a server: the token that requests must have, and the sites that may show its page in a frame."""

    listens_on: str
    """Host name or address that the server listens on."""
    token: str = field(default_factory=create_token)
    frames: tuple[str, ...] = ()
    """Origins of pages, such as `http://localhost:8888`, that may show the page in a frame; a proxy may pass the server
    off as a part of theirs."""

    def renew(self, frames: Iterable[str]) -> Gate:
        """Return a gate with a new token and further sites that may show the page in a frame."""
        return replace(
            self, token=create_token(), frames=tuple(dict.fromkeys((*self.frames, *frames)))
        )

    def format_address(self, port: int) -> str:
        """Return the address, with the token, to open in a browser for a server on a port."""
        host = socket.gethostname() if is_any_address(self.listens_on) else self.listens_on
        host = f"[{host}]" if ":" in host else host
        return f"http://{host}:{port}/{self.token}/"

    def is_allowed(self, path: str, host: str, origin: str | None, *, from_a_page: bool) -> bool:
        """Return whether the server may answer a request.

        Args:
            path: The request's path; must begin with the token.
            host: Its header `Host`. It must name the host that the server listens on, or this machine, so that no other
                site can pass this server off as a part of itself.
            origin: Its header `Origin`: the site whose page sends the request; None without this header.
            from_a_page: Whether only a page may send the request, so that it must have an origin.
        """
        # The comparison takes constant time, so that nobody can guess the token letter by letter from the time.
        if not secrets.compare_digest(
            path.partition("/")[2].partition("/")[0].encode(), self.token.encode()
        ):
            return False
        if not self._is_ours(host):
            return False
        return (
            not from_a_page if origin is None else origin in (f"http://{host}", f"https://{host}")
        )

    @property
    def framed_by(self) -> str:
        """The sites that may show the page in a frame, as the source list of a content security policy."""
        # 'self' is allowed, too: behind a proxy, the page has the proxy's origin, which `frames` need not name.
        return " ".join(("'self'", *self.frames)) if self.frames else "'none'"

    def _is_ours(self, host: str) -> bool:
        if not _HOST.fullmatch(host):
            return False
        if host in {urlsplit(origin).netloc for origin in self.frames}:
            return True
        return is_any_address(self.listens_on) or urlsplit(f"//{host}").hostname in _LOCAL | {
            self.listens_on.lower()
        }
