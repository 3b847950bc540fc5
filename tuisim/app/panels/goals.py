"""The goals panel: each goal of a task with its state, its points, and when, where and why it was met or missed."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType

from tuisim.app.panels import PANELS
from tuisim.app.render.goals import GoalsView, goal_lines
from tuisim.app.snapshot import Snapshot
from tuisim.app.terminal.cell_view import LinesPanel

_TITLE = PANELS["goals"].title


class Goals(LinesPanel, can_focus=True):
    """The goals panel."""

    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "scroll_lines(-1)", "Up", show=False),
        Binding("down", "scroll_lines(1)", "Down", show=False),
        Binding("pageup", "scroll_lines(-10)", "Page up", show=False),
        Binding("pagedown", "scroll_lines(10)", "Page down", show=False),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._content = GoalsView()
        self._past: tuple[int, float] | None = None
        """Tick and simulated time of the past instant in view; None for now."""
        self._shown: object = None
        self._top = 0

    def on_focus(self) -> None:
        self._subtitle()

    def on_blur(self) -> None:
        self._subtitle()

    def show(self, snapshot: Snapshot) -> None:
        """Show the goals as of an instant; the judgements come with `show_goals`."""
        past = (snapshot.instant.tick, snapshot.time_s) if snapshot.past else None
        if past != self._past:
            self._past = past
            self._draw_changes()

    def show_goals(self, view: GoalsView) -> None:
        """Show goals with their judgements; they are from the top on if they are others."""
        if view.goals != self._content.goals:
            self._top = 0
        self._content = view
        self._draw_changes()

    def _draw_changes(self) -> None:
        self._subtitle()
        # Most instants of a run are like the one before.
        if (self._content, self._content.states(self._tick)) != self._shown:
            self._redraw()

    @property
    def _tick(self) -> int | None:
        return self._past[0] if self._past else None

    def _redraw(self) -> None:
        size = self._text.size
        if not size:
            return
        states = self._content.states(self._tick)
        self._shown = self._content, states
        lines = goal_lines(self._content, states, size.width)
        self._top = max(0, min(self._top, len(lines) - size.height))
        below = len(lines) - self._top - size.height
        self.border_title = f"{_TITLE} ↓{below}" if below > 0 else _TITLE
        self._text.set_lines(lines[self._top : self._top + size.height])

    def _subtitle(self) -> None:
        if self._past:
            words = f"as of {self._past[1]:.2f} s"
        elif self._content.hint:
            words = self._content.hint
        else:
            words = "↑↓ scroll" if self.has_focus and self._content.goals else ""
        if words != self.border_subtitle:
            self.border_subtitle = words

    def action_scroll_lines(self, by: int) -> None:
        self._top = max(0, self._top + by)
        self._redraw()

    def on_mouse_scroll_down(self) -> None:
        self.action_scroll_lines(2)

    def on_mouse_scroll_up(self) -> None:
        self.action_scroll_lines(-2)
