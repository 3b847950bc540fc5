"""The goals panel: the goals of a task with their states and points; of one, when, where and why it was decided."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import events
from textual.binding import BindingType

from tuisim.app.panels import PANELS
from tuisim.app.panels.titles import build_title, count_columns
from tuisim.app.render.goals import (
    TITLED_ROWS,
    GoalsPicture,
    GoalsView,
    draw_goals,
    find_current_goal,
)
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.text_runs import cut

if TYPE_CHECKING:
    from tuisim.app.snapshot import Snapshot

_INFO = PANELS["goals"]


class Goals(LinesPanel, can_focus=True):
    """The goals panel: the list of goals with their states, and the details of the selected goal."""

    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        ("up", "select(-1)", "The goal above"),
        ("down", "select(1)", "The goal below"),
        ("pageup", "scroll_detail(-3)", "Page up"),
        ("pagedown", "scroll_detail(3)", "Page down"),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._content = GoalsView()
        self._past: tuple[int, float] | None = None
        """Tick and simulated time of the past instant in view; None for now."""
        self._chosen: int | None = None
        """The goal that the user has chosen to see in detail."""
        self._first = 0
        """First row of the detail that is shown."""
        self._picture = GoalsPicture([])
        self._drawn: object = None

    def watch_has_focus(self, _has_focus: bool) -> None:
        """Show in the frame what the keys of the panel do while the panel has the focus."""
        super().watch_has_focus(_has_focus)
        self._show_subtitle()

    def show(self, snapshot: Snapshot) -> None:
        """Show the states of the goals at an instant of the run; goals and judgements come from `show_goals`."""
        past = (snapshot.instant.tick, snapshot.time_s) if snapshot.past else None
        if past != self._past:
            self._past = past
            self._draw_changes()

    def show_goals(self, view: GoalsView) -> None:
        """Show a view with other goals, or with other judgements of the run by the same goals."""
        if view.goals != self._content.goals:
            self._chosen = None
            self._first = 0
        self._content = view
        self._draw_changes()

    def _draw_changes(self) -> None:
        self._show_subtitle()
        # Most instants of a run change nothing in the panel.
        if (self._content, self._content.states(self._tick)) != self._drawn:
            self._redraw()

    @property
    def _tick(self) -> int | None:
        return self._past[0] if self._past else None

    @property
    def _index(self) -> int:
        """Index of the goal whose details the panel shows."""
        return (
            find_current_goal(self._content.states(self._tick))
            if self._chosen is None
            else self._chosen
        )

    def _redraw(self) -> None:
        size = self._text.size
        if not size:
            return
        states = self._content.states(self._tick)
        self._drawn = self._content, states
        self._picture = draw_goals(
            self._content, states, self._index, self._first, size.width, size.height
        )
        below = f" ↓{self._picture.below}" if self._picture.below else ""
        room = count_columns(_INFO.id, self.size.width) - len(below)
        task = "" if size.height >= TITLED_ROWS else cut(self._content.title, room)
        self.border_title = build_title(self.app, _INFO.id, task) + below
        self._text.set_lines(self._picture.lines)

    def _show_subtitle(self) -> None:
        if self._past:
            words = f"as of {self._past[1]:.2f} s"
        elif self._content.hint:
            words = self._content.hint
        else:
            words = "↑↓ goal · page ↑↓ text" if self.has_focus and self._content.goals else ""
        if words != self.border_subtitle:
            self.border_subtitle = words

    def _choose(self, goal: int) -> None:
        self._chosen = goal
        self._first = 0
        self._redraw()

    def action_select(self, by: int) -> None:
        if self._content.goals:
            self._choose(max(0, min(self._index + by, len(self._content.goals) - 1)))

    def on_click(self, event: events.Click) -> None:
        """Show the details of the goal that was clicked."""
        # The click must not reach the app, which may move the focus to the world.
        event.stop()
        _, row = self.find_cell(event)
        if 0 <= row < len(self._picture.rows) and (goal := self._picture.rows[row]) is not None:
            self._choose(goal)

    def action_scroll_detail(self, by: int) -> None:
        self._first = max(0, self._picture.first + by)
        self._redraw()

    def on_mouse_scroll_down(self) -> None:
        self.action_scroll_detail(1)

    def on_mouse_scroll_up(self) -> None:
        self.action_scroll_detail(-1)
