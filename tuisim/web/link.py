"""The way from an app to the browser that shows it now, if one does."""

from __future__ import annotations

from aiohttp import web

from tuisim.web.sockets import close, sent

TAKEN_OVER = 4001
"""The code with which a socket is closed because another browser shows the app."""
_MOST_WAITING = 20
"""The most messages that wait for a browser."""


class Link:
    """Passes on what an app sends; a picture that nobody sees is dropped, an offered file waits for a browser."""

    def __init__(self) -> None:
        self.socket: web.WebSocketResponse | None = None
        """The connection to the browser; None while the app has none."""
        self._waiting: list[str] = []

    async def send_bytes(self, data: bytes) -> None:
        """Send what the app draws."""
        if self.socket is not None:
            await sent(self.socket, self.socket.send_bytes, data)

    async def send_str(self, text: str) -> None:
        """Send a message, at once or to the next browser."""
        if self.socket is None or not await sent(self.socket, self.socket.send_str, text):
            self._waiting = [*self._waiting, text][-_MOST_WAITING:]

    async def take(self, socket: web.WebSocketResponse, first: str, reason: str) -> None:
        """Show the app in another browser from now on.

        Args:
            socket: The connection to it.
            first: The first message that it gets.
            reason: What the browser that has shown the app until now is told.
        """
        await sent(socket, socket.send_str, first)
        before, self.socket = self.socket, socket
        waiting, self._waiting = self._waiting, []
        for text in waiting:
            await self.send_str(text)
        if before is not None:
            await close(before, reason, TAKEN_OVER)

    def leave(self, socket: web.WebSocketResponse) -> bool:
        """Note that a browser has gone. Return whether the app has none now."""
        if self.socket is socket:
            self.socket = None
        return self.socket is None
