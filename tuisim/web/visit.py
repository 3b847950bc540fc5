"""A visitor: an app and the browser that shows it, until the app has ended or nobody has used it for too long."""

from __future__ import annotations

import asyncio
import json
import re
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from aiohttp import WSMsgType, web
from textual_serve.download_manager import DownloadManager

from tuisim.base.data_class import dataclass
from tuisim.base.errors import printable
from tuisim.web.link import Link, close
from tuisim.web.session import WebSession

_LONGEST_S = 86400.0
"""The longest time for which a timer is set; a longer limit is waited for in several steps, or cut to this."""
_LARGEST_SIZE = 1000
_MAX_PANELS, _MAX_NAME, _MAX_PROGRAM = 50, 50, 80
"""The most panels, and the most characters of a panel's and of the program's name, that are taken from an app, which is
not trusted.
"""
_ANSWER = re.compile(
    r"\x1b(\[[\d;]*[cnRt]|\[[?>=][\d;:]*\$?[A-Za-z]|[P_\]^][^\x07\x1b]*(\x07|\x1b\\))"
)
"""Matches what a terminal sends by itself: reports of cursor, size, modes, colours and name."""
_MOVE = re.compile(r"\x1b\[<(3[59]|4[37]|5[159]|63);\d+;\d+M")
"""Matches a move of the mouse with no button pressed."""


def is_done_by_a_person(text: str) -> bool:
    """Return whether terminal input has a key, the mouse or pasted text, not only answers of the terminal."""
    return _ANSWER.sub("", text) != ""


def is_use(text: str) -> bool:
    """Return whether terminal input contains a key, a click or pasted text, not only movements of the mouse."""
    return is_done_by_a_person(_MOVE.sub("", text))


class Activity:
    """Measures how long a visitor has been idle.

    Args:
        clock: A monotonic clock in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._last_s = clock()

    def note(self) -> None:
        """Record that the visitor is active now."""
        self._last_s = self._clock()

    @property
    def idle_s(self) -> float:
        """Seconds since the visitor was last active."""
        return self._clock() - self._last_s


@dataclass(frozen=True, slots=True)
class VisitLimits:
    """How long a visit can last without use or without a browser."""

    idle_s: float = float("inf")
    """The visit ends when the visitor does nothing for this time; infinity is no limit."""
    keep_s: float = 3600.0
    """The visit ends when no browser shows the app for this time."""
    keep_unused_s: float = 60.0
    """The limit in place of a longer `keep_s` if nobody has used the app and it has run no program."""


class Visit:
    """A visitor's app, and the browser, if any, that shows it now.

    Args:
        command: The command of the app, as words.
        downloads: The files that apps offer.
        limits: How long the visit lasts.
        report: Called with the error output of an app that has failed.
    """

    def __init__(
        self,
        command: Sequence[str],
        downloads: DownloadManager,
        limits: VisitLimits,
        report: Callable[[str], None],
    ) -> None:
        self._limits = limits
        self._report = report
        self._link, self._activity = Link(), Activity()
        self._session = WebSession(command, self._link, downloads)
        self._session.told = self._handle_news
        self._program = ""
        self._runs = False
        """`_program` is the name of the program in the app, `_runs` whether it runs, as the app last told."""
        self._is_used = False
        """Whether somebody has used the app, or it has run a program."""
        self._panels: list[str] = []
        """The panels that the app shows, from its last message."""
        self._telling: asyncio.Task[None] | None = None
        self._size = 0, 0
        self._begun_s = time.monotonic()
        self._left: asyncio.TimerHandle | None = None
        self._end: asyncio.Future[str] = asyncio.get_running_loop().create_future()
        """Gets the reason for which the visit ends, as text for the visitor."""

    @property
    def id(self) -> str:
        """The id of the visit, which the page and the server use."""
        return self._session.app_service_id

    def to_plain(self) -> dict[str, Any]:
        """Return the visit as a JSON-compatible dict.

        The dict has the id, age and idle time in s, whether a browser shows the app, the open program, and whether this
        program is running.
        """
        age_s = time.monotonic() - self._begun_s
        times = {"age_s": round(age_s), "idle_s": round(self._activity.idle_s)}
        shows = {"shown": self.is_shown, "program": self._program}
        return {"id": self.id, **times, **shows, "runs": self._runs}

    async def run(self, width: int, height: int, began: Callable[[], None]) -> None:
        """Run the app until it ends, or until it has been idle for too long; then end it.

        Args:
            width: Columns of the visitor's terminal.
            height: Rows of the visitor's terminal.
            began: Called once a browser can show the app.
        """
        self._size = _clamp_size(width, height)
        try:
            await self._session.start(*self._size)
        except OSError as error:
            self._end.set_result(f"The app cannot be started: {error.strerror}")
        began()
        waits = [asyncio.create_task(wait()) for wait in (self._wait_for_app, self._is_idle)]
        try:
            await asyncio.wait({self._end, *waits}, return_when=asyncio.FIRST_COMPLETED)
            reason = next(wait.result() for wait in (self._end, *waits) if wait.done())
            # A browser that connects from now on gets the reason immediately.
            self.end(reason)
            if self._link.socket is not None:
                await close(self._link.socket, reason)
        finally:
            for wait in waits:
                wait.cancel()
            self._cancel_timeout()
            await self._session.stop()

    async def take(self, socket: web.WebSocketResponse) -> None:
        """Connect the app to a browser.

        The app must not have drawn yet, or the caller must request it to draw everything afterwards.
        """
        self._cancel_timeout()
        await self._link.take(
            socket, json.dumps(["session", self.id]), "Another tab has taken this session over."
        )
        if self._panels:
            await self._tell_panels()

    async def replace_socket(self, socket: web.WebSocketResponse, width: int, height: int) -> None:
        """Connect the app to another browser, and close the connection to the previous browser with a reason.

        Args:
            socket: The connection to the browser.
            width: Columns of its terminal.
            height: Rows of its terminal.
        """
        await self.take(socket)
        self._size = _clamp_size(width, height)
        await self._session.show(*self._size)

    def _handle_news(self, news: Mapping[str, Any]) -> None:
        match news:
            case {"what": "ready" | "run" as what, **more}:
                self._program = printable(str(more.get("program", "")))[:_MAX_PROGRAM]
                self._runs = what == "run"
                self._is_used |= self._runs
            case {"what": "ended"}:
                self._runs = False
            case {"what": "panels", "shown": list(shown)}:
                self._panels = [str(panel)[:_MAX_NAME] for panel in shown[:_MAX_PANELS]]
                self._telling = asyncio.create_task(self._tell_panels())

    async def _tell_panels(self) -> None:
        # The message is not kept for a later browser, which gets the panels when it connects.
        if (socket := self._link.socket) is not None and not socket.closed:
            await self._link.send_str(json.dumps(["panels", self._panels]))

    async def follow(self, socket: web.WebSocketResponse) -> None:
        """Handle the messages of the browser that shows the app until it disconnects.

        Without another browser, the visit then ends after a time.
        """
        if self._end.done():
            await close(socket, self._end.result())
        try:
            async for message in socket:
                if message.type is WSMsgType.TEXT:
                    await self._handle_page_message(message.data)
        finally:
            if self._link.leave(socket):
                keep_s, unused_s = self._limits.keep_s, self._limits.keep_unused_s
                self._left = asyncio.get_running_loop().call_later(
                    min(keep_s if self._is_used else unused_s, keep_s, _LONGEST_S),
                    self.end,
                    "No tab has shown this session for a long time.",
                )

    async def open_file(self, path: Path) -> None:
        """Open a file in the app; the visitor has dropped the file on the page."""
        self._note_use()
        await self.ask({"what": "open", "path": str(path)})

    async def ask(self, request: Mapping[str, Any]) -> None:
        """Send a request to the app; see `ServerAsks`."""
        await self._session.send_meta({"type": "ask", **request})

    @property
    def is_shown(self) -> bool:
        """Whether a browser shows the app now."""
        return self._link.socket is not None

    @property
    def has_ended(self) -> bool:
        """Whether the app has ended, or is ending because the visit has ended."""
        return self._end.done() or self._session.has_ended

    def listen(self, on_message: Callable[[Mapping[str, Any]], None]) -> None:
        """Call a function with each message of the app from now on: on the begin or end of a run, or a problem."""
        self._session.told = on_message

    @property
    def is_ending(self) -> bool:
        """Whether the visit has ended; its app may still be ending."""
        return self._end.done()

    def end(self, reason: str) -> None:
        """End the visit.

        Args:
            reason: The reason, which the visitor sees.
        """
        if not self._end.done():
            self._end.set_result(reason)

    def _note_use(self) -> None:
        self._activity.note()
        self._is_used = True

    def _cancel_timeout(self) -> None:
        if self._left is not None:
            self._left.cancel()

    async def _wait_for_app(self) -> str:
        await self._session.wait_until_ended()
        if self._session.has_failed and self._session.errors:
            self._report(self._session.errors)
        return self._session.reason

    async def _is_idle(self) -> str:
        while (left_s := self._limits.idle_s - self._activity.idle_s) > 0:
            await asyncio.sleep(min(left_s, _LONGEST_S))
        minutes = f"{self._limits.idle_s / 60:g}"
        return (
            f"The session has ended after {minutes} minute{'s' * (minutes != '1')} without input."
        )

    async def _handle_page_message(self, data: str) -> None:
        """Handle a message of the page; ignore a message in another form than the page sends."""
        with suppress(ValueError, RecursionError):
            match json.loads(data):
                case ["stdin", str(text)]:
                    if is_use(text):
                        self._note_use()
                    elif is_done_by_a_person(text):
                        self._activity.note()
                    await self._session.send_bytes(text.encode("utf-8", "ignore"))
                case ["resize", {"width": int(width), "height": int(height)}]:
                    self._activity.note()
                    self._size = _clamp_size(width, height)
                    await self._session.set_terminal_size(*self._size)
                case ["ping", str(sent)]:
                    await self._link.send_str(json.dumps(["pong", sent]))
                case ["act", str(name)]:
                    self._note_use()
                    await self._session.send_meta({"type": "act", "name": name})
                case ["focus"]:
                    await self._session.focus()
                case ["blur"]:
                    await self._session.blur()


def _clamp_size(width: int, height: int) -> tuple[int, int]:
    """Return a size, in columns and rows, within the limits for an app."""
    return min(max(width, 1), _LARGEST_SIZE), min(max(height, 1), _LARGEST_SIZE)
