"""A visitor: a browser with its app, until one of them has gone or the visitor has done nothing for too long."""

from __future__ import annotations

import asyncio
import json
import re
import time
from collections.abc import Callable
from contextlib import suppress

from aiohttp import WSMsgType, web

from tuisim.web.session import WebSession

_MOST_REASON_BYTES = 123
"""The most that fits into the last message of a socket."""
_LARGEST_SIZE = 1000
_ANSWER = re.compile(r"\x1b(\[[\d;]*[cnRt]|\[[?>=][\d;:]*\$?[A-Za-z]|[P_\]^][^\x07\x1b]*(\x07|\x1b\\))")
"""What a terminal sends by itself: reports of its cursor, size, modes, colours and name."""


def is_done_by_a_person(text: str) -> bool:
    """Return whether input contains more than answers of the terminal: a key, the mouse, a paste."""
    return _ANSWER.sub("", text) != ""


class Activity:
    """Measures how long a visitor has done nothing.

    Args:
        clock: A monotonic clock in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._last_s = clock()

    def note(self) -> None:
        """Note that the visitor has done something."""
        self._last_s = self._clock()

    @property
    def idle_s(self) -> float:
        """Seconds since the visitor has done something."""
        return self._clock() - self._last_s


class Visit:
    """Connects a browser with an app.

    Args:
        session: The app.
        socket: The connection to the browser.
        idle_s: The visit ends when the visitor does nothing for this time.
        report: Called with what an app that has failed wrote to stderr.
    """

    def __init__(
        self, session: WebSession, socket: web.WebSocketResponse, idle_s: float, report: Callable[[str], None]
    ) -> None:
        self._session, self._socket, self._idle_s, self._report = session, socket, idle_s, report
        self._activity = Activity()

    async def proceed(self, width: int, height: int) -> None:
        """Run the app until the visit ends; then end it.

        Args:
            width: Columns of the visitor's terminal.
            height: Its rows.
        """
        try:
            await self._session.start(*_within(width, height))
        except OSError as error:
            await self.end(f"The app cannot be started: {error.strerror}")
            return
        watchers = [asyncio.create_task(watch()) for watch in (self._until_app_ends, self._until_idle)]
        try:
            async for message in self._socket:
                if message.type is WSMsgType.TEXT:
                    await self._take(message.data)
        finally:
            for watcher in watchers:
                watcher.cancel()
            await self._session.stop()

    async def end(self, reason: str) -> None:
        """End the visit and tell the visitor why; the page has words of its own for no reason."""
        text = reason.encode()[:_MOST_REASON_BYTES].decode("utf-8", "ignore")
        await self._socket.close(message=text.encode())

    async def _until_app_ends(self) -> None:
        await self._session.ended()
        if self._session.has_failed and self._session.errors:
            self._report(self._session.errors)
        await self.end(self._session.reason)

    async def _until_idle(self) -> None:
        while (left_s := self._idle_s - self._activity.idle_s) > 0:
            await asyncio.sleep(left_s)
        minutes = f"{self._idle_s / 60:g}"
        await self.end(f"The session has ended after {minutes} minute{'s' * (minutes != '1')} without input.")

    async def _take(self, data: str) -> None:
        """Handle one message of the page; what no page sends is ignored."""
        with suppress(ValueError, RecursionError):
            match json.loads(data):
                case ["stdin", str(text)]:
                    if is_done_by_a_person(text):
                        self._activity.note()
                    await self._session.send_bytes(text.encode("utf-8", "ignore"))
                case ["resize", {"width": int(width), "height": int(height)}]:
                    self._activity.note()
                    await self._session.set_terminal_size(*_within(width, height))
                case ["ping", str(sent)]:
                    await self._socket.send_json(["pong", sent])
                case ["act", str(name)]:
                    self._activity.note()
                    await self._session.send_meta({"type": "act", "name": name})
                case ["focus"]:
                    await self._session.focus()
                case ["blur"]:
                    await self._session.blur()


def _within(width: int, height: int) -> tuple[int, int]:
    """Return a size that an app can have."""
    return min(max(width, 1), _LARGEST_SIZE), min(max(height, 1), _LARGEST_SIZE)
