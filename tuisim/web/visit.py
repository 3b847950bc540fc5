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
"""The longest time for which a timer is set."""
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
    """Return whether input has more than answers of the terminal: a key, the mouse or pasted text."""
    return _ANSWER.sub("", text) != ""


def is_use(text: str) -> bool:
    """Return whether input has a key, a click or pasted text, and not only movements of the mouse."""
    return is_done_by_a_person(_MOVE.sub("", text))


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


@dataclass(frozen=True, slots=True)
class VisitLimits:
    """How long a visit lasts."""

    idle_s: float = float("inf")
    """The visit ends when the visitor does nothing for this time."""
    keep_s: float = 3600.0
    """The visit ends when no browser shows the app for this time."""
    keep_unused_s: float = 60.0
    """The same, if nobody has used the app and it has run no program."""


class Visit:
    """The app of a visitor and the browser, if any, that shows it now.

    Args:
        command: The command of the app, as words.
        downloads: The files that apps offer.
        limits: How long the visit lasts.
        report: Called with what an app that has failed wrote to stderr.
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
        """The name of the program in the app, and whether the program runs, as the app has told last."""
        self._is_used = False
        """Whether somebody has used the app, or it has run a program."""
        self._panels: list[str] = []
        """The panels that the app shows, as it has told last."""
        self._telling: asyncio.Task[None] | None = None
        self._size = 0, 0
        self._begun_s = time.monotonic()
        self._left: asyncio.TimerHandle | None = None
        self._end: asyncio.Future[str] = asyncio.get_running_loop().create_future()
        """Gets the reason to end the visit."""

    @property
    def id(self) -> str:
        """The name by which the page and the server know the visit."""
        return self._session.app_service_id

    def to_plain(self) -> dict[str, Any]:
        """Return the visit for a list in JSON: id, age, idle time, whether it is shown, its program and if that
        runs.
        """
        age_s = time.monotonic() - self._begun_s
        times = {"age_s": round(age_s), "idle_s": round(self._activity.idle_s)}
        shows = {"shown": self.is_shown, "program": self._program}
        return {"id": self.id, **times, **shows, "runs": self._runs}

    async def run(self, width: int, height: int, began: Callable[[], None]) -> None:
        """Run the app until it ends, or until nobody has used it for too long; then end it.

        Args:
            width: Columns of the visitor's terminal.
            height: Its rows.
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
            # A browser that comes from now on is told the reason at once.
            self.end(reason)
            if self._link.socket is not None:
                await close(self._link.socket, reason)
        finally:
            for wait in waits:
                wait.cancel()
            self._cancel_timeout()
            await self._session.stop()

    async def take(self, socket: web.WebSocketResponse) -> None:
        """Let a browser show the app, which has not drawn yet or is asked afterwards to draw everything."""
        self._cancel_timeout()
        await self._link.take(
            socket, json.dumps(["session", self.id]), "Another tab has taken this session over."
        )
        if self._panels:
            await self._tell_panels()

    async def replace_socket(self, socket: web.WebSocketResponse, width: int, height: int) -> None:
        """Let another browser show the app from now on, and tell the one before that it no longer does.

        Args:
            socket: The connection to the browser.
            width: Columns of its terminal.
            height: Its rows.
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
        # Not kept for a later browser, which gets the panels when it comes.
        if (socket := self._link.socket) is not None and not socket.closed:
            await self._link.send_str(json.dumps(["panels", self._panels]))

    async def follow(self, socket: web.WebSocketResponse) -> None:
        """Handle the messages of the browser that shows the app until it has gone; then, end the visit after a time."""
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
        """Let the app open a file that the visitor has dropped on the page."""
        self._note_use()
        await self.ask({"what": "open", "path": str(path)})

    async def ask(self, request: Mapping[str, Any]) -> None:
        """Send the app a request; see `ServerAsks`."""
        await self._session.send_meta({"type": "ask", **request})

    @property
    def is_shown(self) -> bool:
        """Whether a browser shows the app now."""
        return self._link.socket is not None

    @property
    def has_ended(self) -> bool:
        """Whether the app has ended, or will because the visit has."""
        return self._end.done() or self._session.has_ended

    def listen(self, on_message: Callable[[Mapping[str, Any]], None]) -> None:
        """Call a function with each message of the app from now on: a run begins or ends, a problem."""
        self._session.told = on_message

    @property
    def is_ending(self) -> bool:
        """Whether the visit has ended; its app may still be ending."""
        return self._end.done()

    def end(self, reason: str) -> None:
        """End the visit and tell the visitor why."""
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
        """Handle one message of the page; ignore one that no page sends."""
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
