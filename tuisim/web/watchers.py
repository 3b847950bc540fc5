"""Browsers that look on: they get what the app draws, and never hold it up."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from contextlib import contextmanager

from aiohttp import web

from tuisim.web.sockets import close, sent

_MOST_BEHIND_BYTES = 4 << 20
"""A browser that is further behind is sent away."""
_TOO_SLOW = "This browser is too slow to follow; open the page again."


class _Watcher:
    """One browser, with what it has not got yet."""

    def __init__(self, socket: web.WebSocketResponse) -> None:
        self._socket = socket
        self._queue: asyncio.Queue[bytes | str | None] = asyncio.Queue()
        self._behind_bytes = 0
        self._reason = ""
        self._is_over = False
        self.task = asyncio.create_task(self._pass_on())

    def send(self, data: bytes | str) -> None:
        """Queue something, or send the browser away if it is too far behind."""
        self._behind_bytes += len(data)
        if self._behind_bytes > _MOST_BEHIND_BYTES:
            self.end(_TOO_SLOW)
        elif not self._is_over:
            self._queue.put_nowait(data)

    def end(self, reason: str) -> None:
        """Close the socket once it has got everything."""
        if not self._is_over:
            self._is_over, self._reason = True, reason
            self._queue.put_nowait(None)

    async def _pass_on(self) -> None:
        while (data := await self._queue.get()) is not None:
            if isinstance(data, bytes):
                is_there = await sent(self._socket, self._socket.send_bytes, data)
            else:
                is_there = await sent(self._socket, self._socket.send_str, data)
            if not is_there:
                break
            self._behind_bytes -= len(data)
        await close(self._socket, self._reason)


class Watchers:
    """All browsers that look on at one app."""

    def __init__(self) -> None:
        self._all: set[_Watcher] = set()

    def __len__(self) -> int:
        return len(self._all)

    @contextmanager
    def one(self, socket: web.WebSocketResponse, size: tuple[int, int]) -> Iterator[None]:
        """Show the app in one more browser, within the context.

        Args:
            socket: The connection to it.
            size: Columns and rows of the app's terminal.
        """
        watcher = _Watcher(socket)
        watcher.send(_size(size))
        self._all.add(watcher)
        try:
            yield
        finally:
            self._all.discard(watcher)
            watcher.task.cancel()

    def show(self, data: bytes) -> None:
        """Send what the app draws."""
        for watcher in self._all:
            watcher.send(data)

    def resize(self, size: tuple[int, int]) -> None:
        """Tell the size of the app's terminal, in columns and rows."""
        for watcher in self._all:
            watcher.send(_size(size))

    def end(self, reason: str) -> None:
        """Send all away and tell them why."""
        for watcher in self._all:
            watcher.end(reason)


def _size(size: tuple[int, int]) -> str:
    return json.dumps(["size", size])
