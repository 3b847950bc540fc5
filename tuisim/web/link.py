"""Sends what an app tells and draws to the browser, if any, that shows the app now; the browser may have gone."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TypeVar

from aiohttp import WSCloseCode, web

TAKEN_OVER = 4001
"""The code with which a socket is closed because another browser shows the app."""
_MAX_WAITING = 20
"""The most messages of an app that are kept while no browser shows it; for a further one, the oldest is dropped."""
_MAX_REASON_BYTES = 123
"""The most bytes that the closing message of a socket can have."""
_Data = TypeVar("_Data")


async def close(socket: web.WebSocketResponse, reason: str, code: int = WSCloseCode.OK) -> None:
    """Close a socket.

    Args:
        socket: The socket.
        reason: The reason, which the page shows; if it is empty, the page shows a default text.
        code: The code of the WebSocket protocol.
    """
    text = reason.encode()[:_MAX_REASON_BYTES].decode("utf-8", "ignore")
    await socket.close(code=code, message=text.encode())


async def _send(
    socket: web.WebSocketResponse, send: Callable[[_Data], Awaitable[None]], data: _Data
) -> bool:
    """Send data to a browser; return False if the browser is no longer connected."""
    if socket.closed:
        return False
    try:
        await send(data)
    except ConnectionError:
        return False
    return True


class Link:
    """The connection of an app to the browser that shows it.

    Without a browser, frames are dropped and messages wait.
    """

    def __init__(self) -> None:
        self.socket: web.WebSocketResponse | None = None
        """The connection to the browser; None while the app has none."""
        self._waiting: list[str] = []

    async def send_bytes(self, data: bytes) -> None:
        """Send a frame of the app to the browser; drop it if no browser shows the app."""
        if self.socket is not None:
            await _send(self.socket, self.socket.send_bytes, data)

    async def send_str(self, text: str) -> None:
        """Send a message to the browser; without a browser, keep the message for the next browser."""
        if self.socket is None or not await _send(self.socket, self.socket.send_str, text):
            self._waiting = [*self._waiting, text][-_MAX_WAITING:]

    async def take(self, socket: web.WebSocketResponse, first: str, reason: str) -> None:
        """Connect the app to another browser from now on.

        Args:
            socket: The connection to the new browser.
            first: The first message to the new browser.
            reason: The reason with which the connection to the previous browser is closed.
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
        """Forget the connection to a browser that has disconnected; return whether no browser shows the app now."""
        if self.socket is socket:
            self.socket = None
        return self.socket is None
