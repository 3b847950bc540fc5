"""The time bar below the world: the run as a line with markers, the instant in view on it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, lru_cache

from rich.style import Style
from textual import events
from textual.message import Message

from tuisim.app import design
from tuisim.app.snapshot import RunPhase, Snapshot
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.engine.runs.records import Mark
from tuisim.pictures.charts.axes import Limits
from tuisim.terminal.cell_view import LinesView
from tuisim.terminal.text_runs import Run

MIN_BAR_COLS = 40
"""Minimum length of the bar beside the time in view and that of the run; a shorter one has the time in view alone."""

_PAST, _LATER, _BEYOND = (
    Style(color=palette.BLUE),
    Style(color=palette.LINE),
    Style(color=design.TRACK),
)
_CURSOR = Style(color=design.GROUND, bgcolor=palette.YELLOW, bold=True)
_WORDS, _STRONG = Style(color=palette.SOFT), Style(color=palette.YELLOW, bold=True)

# The order is the priority: of several markers in one cell, the first one is shown.
_MARKS: Mapping[Mark, tuple[str, Style]] = {
    Mark.ERROR: ("✗", Style(color=design.RED, bold=True)),
    Mark.BREAK: ("●", Style(color=design.BREAKPOINT)),
    Mark.ACTION: ("◆", Style(color=design.KEYWORD)),
    Mark.SAMPLE: ("╵", Style(color=palette.GREEN)),
    Mark.COMMAND: ("╷", Style(color=design.EVENT)),
}


_ON_LINE = {("╵", "━"): "┷", ("╵", "─"): "┴", ("╷", "━"): "┯", ("╷", "─"): "┬"}
"""The marker of a sample, or of a command, with the line of the bar through it, which so has no gaps."""


@dataclass(frozen=True)
class BarTimes:
    """The tick in view and the newest tick of a run, from which the time bar computes its columns."""

    tick: int
    """Number of the tick in view."""
    newest: int
    tick_hz: int
    past: bool
    over: bool
    """Whether the run has ended, so that the bar ends at the run's end."""

    @cached_property
    def end_s(self) -> float:
        """The time in s at the right end of the bar: the end of a finished run, else a round time."""
        now_s = self.newest / self.tick_hz
        return max(now_s, 1 / self.tick_hz) if self.over else _round_end_s(math.ceil(now_s))

    def column(self, tick: int, columns: int) -> int:
        """Return the column of a tick in a bar of `columns` columns."""
        return min(columns - 1, round(tick / self.tick_hz / self.end_s * (columns - 1)))

    def find_tick(self, column: int, columns: int) -> int:
        """Return the tick at a column of a bar of `columns` columns; at most the newest one."""
        share = min(max(column, 0), columns - 1) / max(columns - 1, 1)
        return min(self.newest, round(share * self.end_s * self.tick_hz))


@lru_cache(maxsize=1)
def _round_end_s(now_s: int) -> float:
    """Return the time in s at the right end of the bar, a round time, for a run that has reached second `now_s`."""
    return time_limits(now_s)[1]


def format_times(times: BarTimes, width: int) -> str:
    """Return the times beside the bar: the time in view and, if there is room, the newest time.

    The text has the same width in the past and at the newest instant; otherwise, the columns of the bar would move.

    Args:
        times: The ticks.
        width: Columns of bar and text.
    """
    time_s, now = (f"{tick / times.tick_hz:.2f}" for tick in (times.tick, times.newest))
    both = f"{time_s:>{len(now)}} of {now} s"
    if width - len(both) - 1 >= MIN_BAR_COLS:
        return both if times.past else f"{now} s".rjust(len(both))
    return f"{time_s if times.past else now:>{len(now)}} s"


def mark_cells(times: BarTimes, marks: Iterable[tuple[int, Mark]], columns: int) -> dict[int, Run]:
    """Return the cells of the bar with markers, by column.

    Args:
        times: The ticks of the bar.
        marks: Ticks with the kinds of their markers.
        columns: Length of the bar.
    """
    order = list(_MARKS)
    kinds: dict[int, int] = {}
    for tick, kind in marks:
        column = times.column(tick, columns)
        kinds[column] = min(kinds.get(column, len(order)), order.index(kind))
    return {column: _MARKS[order[kind_at]] for column, kind_at in kinds.items()}


def build_bar(times: BarTimes, marks: Mapping[int, Run], columns: int) -> list[Run]:
    """Return the cells of the bar, with the marked cells in their columns."""
    here = times.column(times.tick, columns)
    now = times.column(times.newest, columns)
    cells: list[Run] = []
    for column in range(columns):
        if column <= here:
            cells.append(("━", _PAST))
        elif column <= now:
            cells.append(("─", _LATER))
        else:
            cells.append(("·", _BEYOND))
    for column, (sign, style) in marks.items():
        cells[column] = _ON_LINE.get((sign, cells[column][0]), sign), style
    if times.past:
        cells[here] = "▮", _CURSOR
    return cells


class TimeBar(LinesView):
    """The time bar: one row with the run's time, its markers, and the instant in view."""

    DEFAULT_CSS = "TimeBar { height: 1; width: 1fr; }"

    @dataclass
    class Scrubbed(Message):
        """Posted when the user goes to another tick of the run with the bar; a tick of None is the newest instant."""

        tick: int | None

    def __init__(self) -> None:
        super().__init__()
        self.marks: Callable[[], Sequence[tuple[int, Mark]]] = tuple
        """Returns the marked ticks, with the kind of each marker."""
        self._times: BarTimes | None = None
        self._columns = 0
        self._marked: tuple[object, dict[int, Run]] = None, {}
        """The markers as drawn, and the data they were made from."""
        self._dragging = False

    def show(self, snapshot: Snapshot) -> None:
        """Show the time of an instant; before the first run, the row is empty, so that the world keeps its size."""
        if snapshot.state == RunPhase.IDLE or not (snapshot.now_tick > 0 or snapshot.past):
            self._times = None
            self.set_lines([])
            return
        tick = snapshot.instant.tick if snapshot.past else snapshot.now_tick
        self._times = BarTimes(
            tick,
            snapshot.now_tick,
            snapshot.tick_hz,
            snapshot.past,
            snapshot.state == RunPhase.ENDED,
        )
        self._draw()

    def on_resize(self) -> None:
        self._draw()

    def _draw(self) -> None:
        if self._times is None or not self.size:
            return
        times = self._times
        text = format_times(times, self.size.width)
        self._columns = columns = max(1, self.size.width - len(text) - 1)
        marks = self.marks()
        key = (len(marks), marks[0] if marks else None, columns, times.end_s)
        if key != self._marked[0]:
            self._marked = key, mark_cells(times, marks, columns)
        style = _STRONG if times.past else _WORDS
        self.set_lines(
            [[*build_bar(times, self._marked[1], columns), (" ", _WORDS), (text, style)]]
        )

    def _choose(self, event: events.MouseEvent) -> None:
        event.stop()
        if self._times is not None:
            tick = self._times.find_tick(int(event.screen_x) - self.region.x, self._columns)
            self.post_message(self.Scrubbed(None if tick >= self._times.newest else tick))

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Go to the instant under the mouse, and follow the mouse; a click on the times goes to the newest instant."""
        if event.button != 1 or self._times is None:
            return
        if event.x >= self._columns:
            event.stop()
            self.post_message(self.Scrubbed(None))
        else:
            self._dragging = True
            self.capture_mouse()
            self._choose(event)

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if self._dragging:
            self._choose(event)

    def on_mouse_up(self, event: events.MouseUp) -> None:
        if self._dragging:
            event.stop()
            self._dragging = False
            self.release_mouse()

    def on_mouse_release(self) -> None:
        """Stop following the mouse, because a dialog has captured it."""
        self._dragging = False


_SPANS_S = (5.0, 10.0, 20.0, 30.0, 60.0)


def time_limits(end_s: float) -> Limits:
    """Return 0 and a round time in s that is not before `end_s`, as limits of an axis.

    There are few of these round times, so that the axes seldom change.
    """
    for span_s in _SPANS_S:
        if end_s <= span_s:
            return 0.0, span_s
    step = 60.0
    while end_s > 5 * step:
        step *= 2
    return 0.0, math.ceil(end_s / step) * step
