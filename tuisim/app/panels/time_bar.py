"""The time bar: the row below the world with the run's time, its markers, and the instant in view."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from rich.style import Style
from textual import events
from textual.message import Message

from tuisim.app.snapshot import ENDED, IDLE, Snapshot
from tuisim.app.terminal.cell_view import LinesView
from tuisim.app.timeline import ACTION, BREAK
from tuisim.charts.axes import time_limits
from tuisim.charts.text_runs import Run
from tuisim.runs.recording import ERROR, SAMPLE

MIN_BAR_COLS = 12
"""Minimum length of the bar, whatever the text beside it."""

_PAST, _LATER, _BEYOND = Style(color="#5fafff"), Style(color="#44505e"), Style(color="#2a333d")
_CURSOR = Style(color="#10151c", bgcolor="#ffd75f", bold=True)
_WORDS, _STRONG = Style(color="#9fb0c3"), Style(color="#ffd75f", bold=True)

# By priority: of several markers in one cell, the first in this order is shown.
_MARKS: Mapping[str, tuple[str, Style]] = {
    ERROR: ("✗", Style(color="#ff6e6e", bold=True)),
    BREAK: ("●", Style(color="#ff8787")),
    ACTION: ("◆", Style(color="#d7a0ff")),
    SAMPLE: ("╵", Style(color="#87d7af")),
}


@dataclass(frozen=True, slots=True)
class Moment:
    """The times that the bar shows."""

    tick: int
    """The tick in view."""
    newest: int
    tick_hz: int
    past: bool
    over: bool
    """Whether the run has ended, so that the bar ends at the run's end."""

    @property
    def end_s(self) -> float:
        """Time at the right end: the end of a finished run, else a round time."""
        now_s = self.newest / self.tick_hz
        return max(now_s, 1 / self.tick_hz) if self.over else time_limits(now_s)[1]

    def column(self, tick: int, columns: int) -> int:
        """Return the column of a tick in a bar of that length."""
        return min(columns - 1, round(tick / self.tick_hz / self.end_s * (columns - 1)))

    def tick_at(self, column: int, columns: int) -> int:
        """Return the tick at a column, at most the newest one."""
        share = min(max(column, 0), columns - 1) / max(columns - 1, 1)
        return min(self.newest, round(share * self.end_s * self.tick_hz))


def words(moment: Moment, width: int) -> str:
    """Return the text beside the bar, as much as fits."""
    at_s, now_s = moment.tick / moment.tick_hz, moment.newest / moment.tick_hz
    if not moment.past:
        return f"{now_s:.2f} s"
    short = f"past {at_s:.2f} of {now_s:.2f} s"
    long = f"past {at_s:.2f} s of {now_s:.2f} s  −{now_s - at_s:.2f} s"
    longest = f"{long}  end: back to now"
    fits = (text for text in (longest, long, short) if len(text) + 1 + MIN_BAR_COLS <= width)
    return next(fits, f"{at_s:.2f} s")


def mark_cells(moment: Moment, marks: Iterable[tuple[int, str]], columns: int) -> dict[int, Run]:
    """Return the markers by column."""
    order = list(_MARKS)
    found: dict[int, int] = {}
    for tick, kind in marks:
        at = moment.column(tick, columns)
        found[at] = min(found.get(at, len(order)), order.index(kind))
    return {at: _MARKS[order[kind_at]] for at, kind_at in found.items()}


def bar_cells(moment: Moment, marks: Mapping[int, Run], columns: int) -> list[Run]:
    """Return the cells of the bar."""
    here, now = moment.column(moment.tick, columns), moment.column(moment.newest, columns)
    cells: list[Run] = [
        ("━", _PAST) if at <= here else ("─", _LATER) if at <= now else ("·", _BEYOND) for at in range(columns)
    ]
    for at, mark in marks.items():
        cells[at] = mark
    if moment.past:
        cells[here] = "▮", _CURSOR
    return cells


class TimeBar(LinesView):
    """The time bar."""

    DEFAULT_CSS = "TimeBar { height: 1; width: 1fr; display: none; }"

    @dataclass
    class Scrubbed(Message):
        """Posted when the user chooses an instant; None is now."""

        tick: int | None

    def __init__(self) -> None:
        super().__init__()
        self.marks: Callable[[], Sequence[tuple[int, str]]] = tuple
        """Returns the marked ticks, with the kind of each marker."""
        self._moment: Moment | None = None
        self._columns = 0
        self._marked: tuple[object, dict[int, Run]] = None, {}
        """The markers as drawn, and the data they were made from."""
        self._dragging = False

    def show(self, snapshot: Snapshot) -> None:
        """Show a moment of a run; before the first run there is no bar."""
        there = snapshot.state != IDLE and (snapshot.now_tick > 0 or snapshot.past)
        if self.display != there:
            self.display = there
        if not there:
            return
        tick = snapshot.instant.tick if snapshot.past else snapshot.now_tick
        hz = snapshot.spec.profile.tick_hz
        self._moment = Moment(tick, snapshot.now_tick, hz, snapshot.past, snapshot.state == ENDED)
        self._draw()

    def on_resize(self) -> None:
        """Draw for the new size."""
        self._draw()

    def _draw(self) -> None:
        if self._moment is None or not self.size:
            return
        moment = self._moment
        text = words(moment, self.size.width)
        self._columns = columns = max(1, self.size.width - len(text) - 1)
        marks = self.marks()
        key = (len(marks), marks[0] if marks else None, columns, moment.end_s)
        if key != self._marked[0]:
            self._marked = key, mark_cells(moment, marks, columns)
        style = _STRONG if moment.past else _WORDS
        self.set_lines([[*bar_cells(moment, self._marked[1], columns), (" ", _WORDS), (text, style)]])

    def _choose(self, event: events.MouseEvent) -> None:
        event.stop()
        if self._moment is not None:
            tick = self._moment.tick_at(int(event.screen_x) - self.region.x, self._columns)
            self.post_message(self.Scrubbed(None if tick >= self._moment.newest else tick))

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Go to the instant at the mouse, and follow it; the text beside the bar returns to now."""
        if event.button != 1 or self._moment is None:
            return
        if event.x >= self._columns:
            event.stop()
            self.post_message(self.Scrubbed(None))
        else:
            self._dragging = True
            self.capture_mouse()
            self._choose(event)

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Follow the mouse."""
        if self._dragging:
            self._choose(event)

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """Stop following the mouse."""
        if self._dragging:
            event.stop()
            self._dragging = False
            self.release_mouse()

    def on_mouse_release(self) -> None:
        """Stop following the mouse: a dialog has captured it."""
        self._dragging = False
