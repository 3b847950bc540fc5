"""Accepts connections: those that do not send the token are closed after a while, and are few at a time."""

from __future__ import annotations

import asyncio
import errno
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

from aiohttp import web

STRANGER_S = 5.0
"""Time for a new connection to send a request that has the token."""
MAX_STRANGERS = 64
"""The most connections without such a request; if there are more, the oldest one is closed."""
_NOT_YET_S = 0.1
"""After this time, an accepted connection has its transport."""
_TOLD_EVERY_S = 60.0
_NO_ROOM = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)


class Door:
    """Accepts connections; closes those that do not send the token in time, or that are too many.

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
        """Listen while in the context; yield the port.

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
        """Keep the connection of a request that the gate allows: it is no longer closed after a time."""
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
        """Handle an error of the event loop; one that prevents any connection is reported only from time to time."""
        error = context.get("exception")
        if not isinstance(error, OSError) or error.errno not in _NO_ROOM:
            loop.default_exception_handler(context)
        elif self._clock() >= self._told_s + _TOLD_EVERY_S:
            self._told_s = self._clock()
            self._report(f"The server cannot accept visitors: {error.strerror}")


def _abort_connection(handler: web.RequestHandler) -> None:
    if handler.transport is not None:
        handler.transport.abort()
