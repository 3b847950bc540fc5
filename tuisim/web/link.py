"""The way from an app to the browser that shows it now, if one does; it may have gone."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TypeVar

from aiohttp import WSCloseCode, web

TAKEN_OVER = 4001
"""The code with which a socket is closed because another browser shows the app."""
_MAX_WAITING = 20
"""The most messages that wait for a browser."""
_MAX_REASON_BYTES = 123
"""The most that fits into the last message of a socket."""
_Data = TypeVar("_Data")


async def close(socket: web.WebSocketResponse, reason: str, code: int = WSCloseCode.OK) -> None:
    """Close a socket and say why; the page has words of its own for no reason."""
    text = reason.encode()[:_MAX_REASON_BYTES].decode("utf-8", "ignore")
    await socket.close(code=code, message=text.encode())


async def _send(
    socket: web.WebSocketResponse, send: Callable[[_Data], Awaitable[None]], data: _Data
) -> bool:
    """Send to a browser that may have gone. Return whether it was there."""
    if socket.closed:
        return False
    try:
        await send(data)
    except ConnectionError:
        return False
    return True


class Link:
    """Passes on what an app sends; a picture that nobody sees is dropped, an offered file waits for a browser."""

    def __init__(self) -> None:
        self.socket: web.WebSocketResponse | None = None
        """The connection to the browser; None while the app has none."""
        self._waiting: list[str] = []

    async def send_bytes(self, data: bytes) -> None:
        """Send what the app draws."""
        if self.socket is not None:
            await _send(self.socket, self.socket.send_bytes, data)

    async def send_str(self, text: str) -> None:
        """Send a message, at once or to the next browser."""
        if self.socket is None or not await _send(self.socket, self.socket.send_str, text):
            self._waiting = [*self._waiting, text][-_MAX_WAITING:]

    async def take(self, socket: web.WebSocketResponse, first: str, reason: str) -> None:
        """Show the app in another browser from now on.

        Args:
            socket: The connection to it.
            first: The first message that it gets.
            reason: What the browser that has shown the app until now is told.
        """
        await _send(socket, socket.send_str, first)
        before = self.socket
        self.socket = socket
        waiting = self._waiting
        self._waiting = []
        for text in waiting:
            await self.send_str(text)
        if before is not None:
            await close(before, reason, TAKEN_OVER)

    def leave(self, socket: web.WebSocketResponse) -> bool:
        """Note that a browser has gone. Return whether the app has none now."""
        if self.socket is socket:
            self.socket = None
        return self.socket is None
