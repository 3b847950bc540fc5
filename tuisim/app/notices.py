"""Notices: one message at a time, in a row on the lower edge of the panels; a long one in parts, one after another."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from math import inf
from textwrap import wrap
from typing import Any

from textual.app import App
from textual.notifications import SeverityLevel
from textual.widgets import Static

from tuisim.base.data_class import dataclass
from tuisim.terminal.textual_internals import NOTICE_LAYER, can_show_notices, is_leaving

CHARACTERS_A_SECOND = 25
"""How fast a notice is read."""
_MIN_PART_S = 2.5
_MORE = " …"
"""At the end of a part that another one follows."""
_NUMBER = "1/2 "
"""Before each of several parts."""
_EDGES = 3
"""Columns of the row beside its text."""


@dataclass(frozen=True, slots=True)
class Notice:
    """A message to the user."""

    message: str
    severity: SeverityLevel
    timeout_s: float
    """How long it is shown; longer if it takes longer to read. Infinite: until the next key does something."""

    @property
    def stays(self) -> bool:
        """Whether it is shown until the next key does something."""
        return self.timeout_s == inf


def split_message(message: str, columns: int) -> list[str]:
    """Return the parts of a message that are shown one after the other, each in a row of that many columns.

    Several parts are numbered, so that the reader knows that others follow, or came before.
    """
    text = " ".join(message.split())
    if len(text) <= columns:
        return [text]
    parts = wrap(text, max(columns - len(_NUMBER) - len(_MORE), 1))
    return [
        f"{number}/{len(parts)} {part}{_MORE if number < len(parts) else ''}"
        for number, part in enumerate(parts, start=1)
    ]


class NoticeRow(Static):
    """The row of a notice, on the border of the lowest panels: it covers nothing, and moves nothing.

    A notice that stays begins anew after its last part.

    Args:
        notice: What it shows.
        ended: Called once all of it has been shown, or a click has closed it.
    """

    DEFAULT_CSS = f"""
    NoticeRow {{
        layer: {NOTICE_LAYER};
        dock: bottom;
        width: 100%;
        height: 1;
        margin-bottom: 1;
        padding: 0 1;
        background: $panel-lighten-1;
        text-wrap: nowrap;
        text-overflow: ellipsis;
        border-left: outer $success;
    }}
    NoticeRow.-warning {{ border-left: outer $warning; }}
    NoticeRow.-error {{ border-left: outer $error; }}
    """
    ALLOW_SELECT = False

    def __init__(self, notice: Notice, ended: Callable[[], None]) -> None:
        super().__init__(markup=False, classes=f"-{notice.severity}")
        self.notice = notice
        self._ended = ended
        self._parts: list[str] = []
        self._count = 0
        """How many parts have been shown."""
        self._part_until_s = inf

    @property
    def is_read(self) -> bool:
        """Whether the user has had the time to read all of it."""
        more = self._count - len(self._parts)
        return more > 0 or (more == 0 and time.monotonic() >= self._part_until_s)

    def on_mount(self) -> None:
        self._parts = split_message(self.notice.message, self.app.size.width - _EDGES)
        self._show_next()

    def on_resize(self) -> None:
        self.call_after_refresh(self._leave_dialog)

    def _leave_dialog(self) -> None:
        """Move to the lower border of a dialog whose text the row would cover."""
        if not self.is_attached:
            return
        for frame in self.screen.query(".dialog"):
            if self.region.overlaps(frame.region.shrink((1, 1, 1, 1))):
                self.styles.offset = (0, frame.region.bottom - 1 - self.region.y)

    def on_click(self) -> None:
        """Close it."""
        self._ended()

    def _show_next(self) -> None:
        count = len(self._parts)
        if self._count >= count and not self.notice.stays:
            self._ended()
            return
        part = self._parts[self._count % count]
        self._count += 1
        self.update(part)
        reading_s = max(_MIN_PART_S, len(part) / CHARACTERS_A_SECOND)
        self._part_until_s = time.monotonic() + reading_s
        goes_on = self._count < count or (self.notice.stays and count > 1)
        shown_s = reading_s if goes_on else max(reading_s, self.notice.timeout_s)
        if shown_s < inf:
            self.set_timer(shown_s, self._show_next)


class Notices:
    """The notices of an app: the newest replaces the one that is shown, unless that is an error nobody can have read.

    Args:
        app: On whose topmost screen they are shown.
    """

    def __init__(self, app: App[Any]) -> None:
        self._app = app
        self._row: NoticeRow | None = None
        self._waiting: deque[Notice] = deque()
        self._told: list[tuple[float, Notice]] = []

    def add(self, notice: Notice) -> None:
        """Show a notice as soon as its turn comes."""
        now_s = time.monotonic()
        self._told = [
            (until_s, waiting_notice) for until_s, waiting_notice in self._told if until_s > now_s
        ]
        reading_s = len(notice.message) / CHARACTERS_A_SECOND
        self._told.append((now_s + max(notice.timeout_s, reading_s), notice))
        if notice.severity != "error":
            self._waiting = deque(
                waiting_notice
                for waiting_notice in self._waiting
                if waiting_notice.severity == "error"
            )
        self._waiting.append(notice)
        self._app.call_later(self._take_turn)

    def list_messages(self) -> list[str]:
        """Return the messages whose time has not passed."""
        now_s = time.monotonic()
        return [notice.message for until_s, notice in self._told if until_s > now_s]

    def release(self) -> None:
        """Remove the notices that stay until a key does something."""
        now_s = time.monotonic()
        self._told = [
            (
                now_s + len(waiting_notice.message) / CHARACTERS_A_SECOND
                if waiting_notice.stays
                else until_s,
                waiting_notice,
            )
            for until_s, waiting_notice in self._told
        ]
        self._waiting = deque(
            waiting_notice for waiting_notice in self._waiting if not waiting_notice.stays
        )
        if self._row is not None and self._row.notice.stays:
            self._end_turn()

    def clear(self) -> None:
        """Forget all notices."""
        self._waiting.clear()
        self._told.clear()
        self._remove_row()

    def follow_screen(self) -> None:
        """If the screen with the notice was closed, show the notice on the topmost screen."""
        row = self._row
        if row is not None and not row.is_attached:
            self._row = None
            self._waiting.appendleft(row.notice)
            self._take_turn()

    def _take_turn(self) -> None:
        if is_leaving(self._app) or not can_show_notices(self._app) or not self._app.screen_stack:
            return
        row = self._row
        if row is not None and row.notice.severity == "error" and not row.is_read:
            return
        if self._waiting:
            self._remove_row()
            self._row = NoticeRow(self._waiting.popleft(), self._end_turn)
            self._app.screen.mount(self._row)

    def _end_turn(self) -> None:
        self._remove_row()
        self._take_turn()

    def _remove_row(self) -> None:
        if self._row is not None and self._row.is_attached:
            self._row.remove()
        self._row = None
