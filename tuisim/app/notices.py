"""Notices: one message at a time, on borders of the panels."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from math import inf
from typing import Any

from textual import events
from textual.app import App
from textual.notifications import SeverityLevel
from textual.widgets import Static

from tuisim.base.data_class import dataclass
from tuisim.terminal.textual_internals import NOTICE_LAYER, can_show_notices, is_leaving

CHARACTERS_A_SECOND = 25
"""Number of characters of a notice that a user is assumed to read in a second."""


@dataclass(frozen=True, slots=True)
class Notice:
    """A message to the user, with its severity and how long it is shown."""

    message: str
    severity: SeverityLevel
    timeout_s: float
    """Seconds for which the notice is shown, more if reading it takes longer. Infinite: until a key does something."""

    @property
    def stays(self) -> bool:
        """Whether the notice is shown until the next key does something."""
        return self.timeout_s == inf


class NoticeRow(Static):
    """A notice that covers the lower borders of the panels.

    If the text needs several rows, the panels leave room for all of them but one.

    Args:
        notice: The notice to show.
        ended: Called once the whole notice has been shown, or a click has closed it.
        leave_rows: Called with the number of rows for which the panels must leave room.
    """

    DEFAULT_CSS = f"""
    NoticeRow {{
        layer: {NOTICE_LAYER};
        dock: bottom;
        width: 100%;
        height: auto;
        margin-bottom: 1;
        padding: 0 1;
        background: $panel-lighten-1;
        border-left: outer $success;
    }}
    NoticeRow.-warning {{ border-left: outer $warning; }}
    NoticeRow.-error {{ border-left: outer $error; }}
    """
    ALLOW_SELECT = False

    def __init__(
        self, notice: Notice, ended: Callable[[], None], leave_rows: Callable[[int], None]
    ) -> None:
        text = " ".join(notice.message.split())
        super().__init__(text, markup=False, classes=f"-{notice.severity}")
        self.notice = notice
        self._ended = ended
        self._leave_rows = leave_rows
        reading_s = len(text) / CHARACTERS_A_SECOND
        self._read_s = time.monotonic() + reading_s
        self._shown_s = max(reading_s, notice.timeout_s)

    @property
    def is_read(self) -> bool:
        """Whether the notice has been visible long enough to be read."""
        return time.monotonic() >= self._read_s

    def on_mount(self) -> None:
        if not self.notice.stays:
            self.set_timer(self._shown_s, self._ended)

    def on_resize(self, event: events.Resize) -> None:
        self._leave_rows(event.size.height - 1)
        self.call_after_refresh(self._leave_dialog)

    def _leave_dialog(self) -> None:
        """If the row would cover the text of a dialog, move it to the lower border of the dialog."""
        for frame in self.screen.query(".dialog") if self.is_attached else ():
            if self.region.overlaps(frame.region.shrink((1, 1, 1, 1))):
                self.styles.offset = (0, frame.region.bottom - 1 - self.region.y)

    def on_click(self) -> None:
        """Close the notice."""
        self._ended()


class Notices:
    """The notices of an app. A new notice replaces the visible one; if that is an unread error, the new one waits.

    Args:
        app: The notices are shown on its topmost screen.
    """

    def __init__(self, app: App[Any]) -> None:
        self._app = app
        self.leave_rows: Callable[[int], None] = lambda _: None
        """Makes the panels leave a number of rows free below them, in which a notice is shown; 0 for none."""
        self._row: NoticeRow | None = None
        self._waiting: deque[Notice] = deque()
        self._told: list[tuple[float, Notice]] = []

    def add(self, notice: Notice) -> None:
        """Show a notice, after the errors that have not been read yet."""
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
        # The action that has caused the notice may still move the panels: wait for the next refresh.
        self._app.call_after_refresh(self._take_turn)

    def list_messages(self) -> list[str]:
        """Return the texts of the notices whose time is not over."""
        now_s = time.monotonic()
        return [notice.message for until_s, notice in self._told if until_s > now_s]

    def release(self) -> None:
        """Remove the notices that are shown until a key does something."""
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
        """Remove all notices, shown or waiting."""
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
            self._row = NoticeRow(self._waiting.popleft(), self._end_turn, self.leave_rows)
            self._app.screen.mount(self._row)

    def _end_turn(self) -> None:
        self._remove_row()
        self._take_turn()

    def _remove_row(self) -> None:
        if self._row is not None and self._row.is_attached:
            self._row.remove()
            # If another notice follows at once, the panels keep their places, unless it needs more or fewer rows.
            self._app.call_after_refresh(self._free_rows)
        self._row = None

    def _free_rows(self) -> None:
        if self._row is None and not self._waiting and not is_leaving(self._app):
            self.leave_rows(0)
