"""The chart panel: logged and measured values over simulated time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import ClassVar

from textual import events
from textual.binding import BindingType
from textual.message import Message

from tuisim.app.action import KeyWord
from tuisim.app.clipboard import Copied
from tuisim.app.plot_view import PlotView
from tuisim.app.snapshot import AT_REST, CHART_PERIOD_S, RunPhase, Snapshot
from tuisim.base.data_class import dataclass
from tuisim.logs.levels import find_light
from tuisim.pictures.charts.bands import find_spans
from tuisim.pictures.charts.layout import Span
from tuisim.pictures.charts.text_chart import ChartPainter, ChartPicture, ChartState, format_values
from tuisim.pictures.charts.traces import Trace, Traces
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.pacer import Throttle
from tuisim.terminal.picture_mode import is_ascii
from tuisim.terminal.text_runs import Run, escape_markup

_VALUE_COLS = 40
"""Columns for a value with its unit in a copied text: more than any value takes, so that none is left out."""


class Chart(LinesPanel, can_focus=True):
    """The chart panel. The panel also stores the data that arrives while it is hidden."""

    FOOTER_KEYS: ClassVar[tuple[KeyWord, ...]] = (("← →", "cursor"), ("1…9", "traces"))
    FROZEN: ClassVar[str] = "frozen: f follows again"

    BINDINGS: ClassVar[list[BindingType]] = [
        ("up", "select(-1)", "Previous trace"),
        ("down", "select(1)", "Next trace"),
        ("enter", "tick", "Show or hide the selected trace"),
        *((str(number), f"tick({number})", "Show or hide this trace") for number in range(1, 10)),
        ("left", "move_cursor(-1)", "Cursor back"),
        ("right", "move_cursor(1)", "Cursor forward"),
        ("shift+left", "move_cursor(-10)", "Cursor far back"),
        ("shift+right", "move_cursor(10)", "Cursor far forward"),
        ("escape", "leave", "Remove the cursor; without one, leave the chart"),
        ("f", "freeze", "Follow or freeze"),
        ("delete", "clear", "Clear chart"),
    ]

    @dataclass
    class CursorMoved(Message):
        """Posted when the user has moved the cursor to another simulated time, or removed it.

        All panels then show that time.
        """

        time_s: float | None
        sample: str = ""
        """Name of the sample that was clicked at this time; empty if no sample was clicked."""

    def __init__(self) -> None:
        super().__init__()
        self._traces = Traces()
        self._text: PlotView = PlotView(self._redraw)
        self._painter = ChartPainter()
        self._state = ChartState(tick_keys="↑ ↓ and enter")
        self._picture: ChartPicture | None = None
        self._dirty = True
        self._dragging = False
        self._pointed_s: float | None = None
        """Time in the chart below the mouse pointer; None if the pointer is elsewhere."""
        self._lag = ""
        self._printed_s = 0.0
        """Simulated time at which the newest output line was printed, while a past instant is in view."""
        self._light = find_light(None)
        self._is_at_rest = False
        self._spanned: object = None
        """Identifies the data in which bands were last searched for; if it is unchanged, the search is not repeated."""
        self._throttle = Throttle(self, CHART_PERIOD_S, self._draw)

    def append(
        self, name: str, times_s: Sequence[float], values: Sequence[float], logged: bool = True
    ) -> None:
        """Add points to a trace, which is made if it does not exist.

        Args:
            name: The name of a printed sample, or of a column of telemetry. The trace of a column is hidden at first.
            times_s: Simulated times in s.
            values: The values at these times.
            logged: Whether the program has printed them.
        """
        self._traces.append(name, times_s, values, logged)
        self._schedule_drawing()

    def clear(self) -> None:
        """Remove all traces; a trace that gets points later is shown or hidden as before."""
        self._traces.clear()
        self._lag = ""
        self._state = replace(self._state, x_limits=None)
        self._read(None)
        self._drop_cursor()
        self._schedule_drawing()

    def show(self, snapshot: Snapshot) -> None:
        """Draw the data up to now, at most a few times a second.

        If a past instant is in view, the cursor is at the time of this instant.
        """
        grows = snapshot.state in (RunPhase.RUNNING, RunPhase.PAUSED, RunPhase.WAITING)
        state = replace(self._state, grows=grows)
        if not self._dragging:
            state = replace(state, cursor_s=snapshot.time_s if snapshot.past else None)
        if state != self._state:
            self._state = state
            self._dirty = True
        self._light = find_light(snapshot.recorded_spec or snapshot.spec)
        was_at_rest = self._is_at_rest
        self._is_at_rest = snapshot.state in AT_REST
        if self._dirty or self._is_at_rest != was_at_rest:
            self._dirty = True
            self._throttle.ask()

    def show_printed(self, time_s: float) -> None:
        """Set the simulated time up to which printed samples count in the values at the cursor.

        This is the time at which the newest visible line of the output was printed, so that the chart and the output
        show the same values. The next `show` uses it.
        """
        if time_s != self._printed_s:
            self._printed_s = time_s
            self._dirty = True

    def show_lag(self, words: str) -> None:
        """Show in the border a text about how far the printed values are drawn; an empty text removes it."""
        if words != self._lag:
            self._lag = words
            self._read(self._pointed_s)

    def _schedule_drawing(self) -> None:
        self._dirty = True
        if self.display:
            self._throttle.ask()

    def _draw(self) -> None:
        if not self.display or not self._text.size or not self._dirty:
            return
        self._dirty = False
        if self._state.selected is None and (first := next(iter(self._traces), None)):
            self._state = replace(self._state, selected=first.name)
        self._find_bands()
        state = replace(
            self._state, grid=True, grey=bool(self.app.no_color), is_ascii=is_ascii(self.app)
        )
        if not self.has_focus:
            state = replace(state, selected=None)
        self._text.draw(partial(self._paint, state))
        self._read(self._pointed_s)

    def _find_chosen(self) -> Trace | None:
        """Return the selected trace if it is drawn, else the first drawn trace; None if no trace is drawn."""
        drawn = self._traces.list_drawn()
        return next(
            (trace for trace in drawn if trace.name == self._state.selected),
            drawn[0] if drawn else None,
        )

    def _find_bands(self) -> None:
        """Find the bands of the chosen trace; if it has fewer than two, take another trace that has at least two.

        While the run goes on, there are no bands.
        """
        chosen = self._find_chosen()
        if chosen is None or not self._is_at_rest:
            self._spanned = None
            spans: tuple[Span, ...] = ()
        else:
            traces = [
                chosen,
                *(trace for trace in self._traces.list_drawn() if trace is not chosen),
            ]
            key = [(trace.name, len(trace.times_s)) for trace in traces], self._light
            if key == self._spanned:
                return
            self._spanned = key
            candidates = (find_spans(trace, self._light) for trace in traces)
            spans = next(
                (spans for spans in candidates if len(spans) > 1), find_spans(chosen, self._light)
            )
        self._state = replace(self._state, spans=spans)

    def _paint(
        self, state: ChartState, is_blank: bool
    ) -> tuple[list[list[Run]], list[tuple[int, ChartPicture]]]:
        self._picture = self._painter.paint(
            self._traces, state, *self._text.size, is_blank=is_blank
        )
        return self._picture.lines, [(0, self._picture)]

    def _redraw(self) -> None:
        self._dirty = True
        self._throttle.call_now()

    def on_focus(self) -> None:
        self._redraw()

    def on_blur(self) -> None:
        self._redraw()

    # Keys

    def action_select(self, step: int) -> None:
        names = [trace.name for trace in self._traces]
        if names:
            index = names.index(self._state.selected) + step if self._state.selected in names else 0
            self._state = replace(self._state, selected=names[index % len(names)])
            self._redraw()

    def action_tick(self, number: int = 0) -> None:
        traces = list(self._traces)
        if number:
            chosen = traces[number - 1] if number <= len(traces) else None
        else:
            chosen = next((trace for trace in traces if trace.name == self._state.selected), None)
        if chosen:
            self._switch(chosen)

    def _switch(self, trace: Trace) -> None:
        trace.on = not trace.on
        self._state = replace(self._state, selected=trace.name)
        self._redraw()

    def action_freeze(self) -> None:
        frozen = (
            self._state.x_limits is None and self._picture is not None and self._picture.columns > 0
        )
        self._state = replace(
            self._state, x_limits=self._picture.x_limits if frozen and self._picture else None
        )
        self._read(None)
        self._redraw()

    def action_clear(self) -> None:
        self.clear()

    def action_move_cursor(self, columns: int) -> None:
        """Move the cursor by a number of columns; without a cursor, put it at the newest point first."""
        picture = self._picture
        if picture is None or not picture.columns:
            return
        now = self._traces.end_s() if self._state.cursor_s is None else self._state.cursor_s
        column = picture.find_column(now) + columns
        self._put_cursor(picture.find_value(column))

    def action_leave(self) -> None:
        if self._state.cursor_s is None:
            self.screen.set_focus(None)
        self._drop_cursor()

    def _drop_cursor(self) -> None:
        if self._state.cursor_s is not None:
            self._state = replace(self._state, cursor_s=None)
            self.post_message(self.CursorMoved(None))
            self._redraw()

    def _put_cursor(self, time_s: float, sample: str = "") -> None:
        time_s = min(max(time_s, 0.0), self._traces.end_s())
        if time_s != self._state.cursor_s:
            self._state = replace(self._state, cursor_s=time_s)
            self.post_message(self.CursorMoved(time_s, sample))
            self._redraw()

    # Mouse

    def on_mouse_down(self, event: events.MouseDown) -> None:
        picture = self._picture
        if picture is None or event.button != 1:
            return
        column, row = self.find_cell(event)
        for box in picture.boxes:
            if box.row == row and box.first <= column < box.end:
                self._switch(next(trace for trace in self._traces if trace.name == box.name))
                return
        if picture.find_time_s(column, row) is not None:
            self._dragging = True
            self.capture_mouse()
            self._put_cursor(*self._find_sample(self._compute_time(column, picture), picture))

    def on_mouse_move(self, event: events.MouseMove) -> None:
        picture = self._picture
        if picture is None:
            return
        column, row = self.find_cell(event)
        if self._dragging:
            self._put_cursor(self._compute_time(column, picture))
        else:
            self._read(picture.find_time_s(column, row))

    def on_leave(self) -> None:
        self._read(None)

    def _read(self, time_s: float | None) -> None:
        """Show the values of the drawn traces in the lower border.

        Args:
            time_s: Time under the pointer; None shows the values at the cursor.
        """
        self._pointed_s = time_s
        words = escape_markup(self._format_values(self.size.width - 4))
        words = words or (self.FROZEN if self._state.x_limits else self._lag)
        # An assignment draws the panel again even if the words are the same.
        if words != self.border_subtitle:
            self.border_subtitle = words

    def _format_values(self, width: int) -> str:
        """Return the values of the drawn traces at the pointer, else at the cursor, as a text; empty if there are none.

        The values at the cursor include the samples in the newest visible line of the output.
        """
        time_s = self._state.cursor_s if self._pointed_s is None else self._pointed_s
        drawn = self._traces.list_drawn()
        if time_s is None or not drawn:
            return ""
        end_s = max(time_s, self._printed_s) if self._pointed_s is None else time_s
        return format_values(drawn, time_s, self._state.unit, width, end_s=end_s)

    def copy_text(self) -> Copied | None:
        """Return the values of all drawn traces at the pointer or, without a pointer, at the cursor.

        The result is None if there is neither a pointer nor a cursor, or if no trace is drawn.
        """
        drawn = self._traces.list_drawn()
        width = sum(len(trace.name) + _VALUE_COLS for trace in drawn) + _VALUE_COLS
        words = self._format_values(width)
        return Copied("Values of the chart", words) if words else None

    def on_mouse_up(self, event: events.MouseUp) -> None:
        if self._dragging:
            self._dragging = False
            self.release_mouse()

    def on_mouse_release(self) -> None:
        """Stop dragging the cursor, because a dialog has captured the mouse."""
        self._dragging = False

    def _find_sample(self, time_s: float, picture: ChartPicture) -> tuple[float, str]:
        """Return the time and the name of the sample at a time.

        On a band, this is the band's sample that is nearest to the time. If there is no sample, return the time itself
        and an empty name.
        """
        span = next((span for span in self._state.spans if span.start <= time_s <= span.stop), None)
        of_span = (
            trace
            for trace in self._traces.list_drawn()
            if span is not None and trace.name == span.name
        )
        trace = next(of_span, self._find_chosen())
        if trace is None or not trace.logged:
            return time_s, ""
        low, high = picture.x_limits
        found_s = trace.find_nearest_s(time_s)
        is_here = abs(found_s - time_s) * picture.columns <= high - low
        return (found_s, trace.name) if is_here or span is not None else (time_s, "")

    @staticmethod
    def _compute_time(column: int, picture: ChartPicture) -> float:
        return picture.find_value(column - picture.left)
