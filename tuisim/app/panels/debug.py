"""The debug panel: where the program is paused, what it waits for, variables, watches, frames and threads."""

from __future__ import annotations

import linecache
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

from textual.binding import BindingType
from textual.message import Message

from tuisim.app.panels import PANELS
from tuisim.app.panels.output import replace_controls
from tuisim.app.panels.titles import build_title
from tuisim.app.render.debug import DebugView, debug_lines
from tuisim.app.snapshot import PauseView, RunPhase, Snapshot
from tuisim.base.data_class import dataclass
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.text_runs import Line, cut, escape_markup

if TYPE_CHECKING:
    from tuisim.engine.protocol import Paused

_INFO = PANELS["debug"]
_FRAME = 4
"""Columns of a border, at its two ends together, that the words in it cannot take."""


class Debug(LinesPanel, can_focus=True):
    """The debug panel: where the program is paused, its call stack, variables and watches."""

    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        ("up", "scroll_lines(-1)", "Scroll up"),
        ("down", "scroll_lines(1)", "Scroll down"),
        ("pageup", "scroll_lines(-10)", "Page up"),
        ("pagedown", "scroll_lines(10)", "Page down"),
        ("left", "frame(-1)", "The called frame"),
        ("right", "frame(1)", "The caller"),
        ("enter", "thread", "The next thread"),
    ]

    @dataclass
    class FrameWanted(Message):
        """Posted when the user wants to see the variables of the calling frame, or of the called one."""

        by: int

    class ThreadWanted(Message):
        """Posted when the user wants to see the variables of the next thread."""

    def __init__(self) -> None:
        super().__init__()
        self._content = DebugView()
        self._state = RunPhase.IDLE
        self._now: tuple[int, float] | None = None
        self._top = 0
        self._lines: list[Line] = []
        self._printed = ""

    def on_focus(self) -> None:
        self._label_border()

    def on_blur(self) -> None:
        self._label_border()

    def show_printed(self, line: str) -> None:
        """Show in the border the line that the program has printed last.

        Args:
            line: The line; empty for none.
        """
        self._printed = replace_controls(line)
        self._label_border()

    def _label_border(self) -> None:
        words = f"printed {self._printed}" if self._printed else ""
        self.border_subtitle = (
            "←→ call · enter thread"
            if self.has_focus
            else escape_markup(cut(words, max(self.size.width - _FRAME, 1)))
        )

    def show(self, snapshot: Snapshot) -> None:
        """Show whether the program runs, and the time in view; `show_pause` shows where it is paused."""
        now = snapshot.instant.tick, snapshot.time_s
        # While the program runs, the panel shows no line and no variables, so a new instant changes nothing.
        if snapshot.state != self._state or (now != self._now and self._content.paused):
            self._state = snapshot.state
            self._now = now
            self._redraw()
        self._now = now

    def show_pause(self, view: PauseView | None, is_busy: bool) -> None:
        """Show where the program is paused, with its variables there.

        Args:
            view: The pause; None while the program runs, or before it is first paused.
            is_busy: Whether a past instant is still being computed.
        """
        if view is None:
            self._content = DebugView(busy=is_busy)
        else:
            source = _read_module_line(view.paused)
            self._content = DebugView(
                self._state, view.paused, view.inspected, view.past, is_busy, source
            )
        self._redraw()

    def _redraw(self) -> None:
        size = self._text.size
        if not size:
            return
        self._lines = debug_lines(
            replace(self._content, state=self._state, now=self._now), size.width
        )
        self._top = max(0, min(self._top, len(self._lines) - size.height))
        below = len(self._lines) - self._top - size.height
        self.border_title = build_title(self.app, _INFO.id) + (f" ↓{below}" if below > 0 else "")
        self._text.set_lines(self._lines[self._top : self._top + size.height])

    def action_scroll_lines(self, by: int) -> None:
        self._top = max(0, self._top + by)
        self._redraw()

    def action_frame(self, by: int) -> None:
        self.post_message(self.FrameWanted(by))

    def action_thread(self) -> None:
        self.post_message(self.ThreadWanted())

    def on_mouse_scroll_down(self) -> None:
        self.action_scroll_lines(2)

    def on_mouse_scroll_up(self) -> None:
        self.action_scroll_lines(-2)


def _read_module_line(paused: Paused) -> str:
    """Return the source line at which a program is paused in another module.

    The result is empty if the program is paused in its own file, or the line cannot be read.
    """
    if not paused.file:
        return ""
    linecache.checkcache(paused.file)
    return linecache.getline(paused.file, paused.line)
