"""The chart of a log: one for all variables, or one for each, with the cursor."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from rich.style import Style
from textual import events
from textual.message import Message

from tuisim.analysis.chart import build_spans
from tuisim.analysis.events import CommandRow
from tuisim.analysis.traces import TIME
from tuisim.app import design
from tuisim.app.plot_view import PlotView
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.pictures.charts.axes import Limits, find_column, limit_drawn
from tuisim.pictures.charts.canvas import BRAILLE, draw_xy_chart
from tuisim.pictures.charts.text_chart import (
    ChartPainter,
    ChartPicture,
    ChartState,
    format_values,
    measure_margins,
)
from tuisim.pictures.charts.traces import Traces
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.picture import MAX_POINTS
from tuisim.terminal.picture_mode import is_ascii
from tuisim.terminal.text_runs import Run, escape_markup

if TYPE_CHECKING:
    from tuisim.analysis.model import AnalysisModel
    from tuisim.analysis.traces import LogTrace

_EVENTS = Style(color=design.EVENT, bold=True)
_MAX_BANDS = 100
"""Maximum number of shaded bands of a variable; if it has more, none is shaded, as they are too narrow to see."""
_MIN_FACET_ROWS = 6
"""Minimum height in rows of each chart, if each variable has a chart of its own."""
FACETS_ROWS = 2 * _MIN_FACET_ROWS
"""Minimum height in rows of the panel for a chart of each variable; a lower panel has one chart for all."""


@dataclass(slots=True)
class ChartOptions:
    """The options of the analyser's chart that the user switches by keys."""

    facets: bool = False
    """Whether each ticked variable has a chart of its own."""
    marks: bool = False
    hold: bool = False
    """Whether each line holds a value until the next sample (steps), instead of going straight to the next value."""
    against: tuple[str, str] | None = None
    """Names of the variables on the x and y axis of a path; None for a chart of all variables over time."""


class LogChart(LinesPanel):
    """The widget with the analyser's chart: all variables in one, or one chart for each."""

    ALLOW_SELECT = False
    DEFAULT_CSS = f"""
    LogChart {{
        height: 1fr; border: round {palette.LINE}; border-title-color: {palette.SOFT};
        border-subtitle-color: {palette.GREEN};
    }}
    """

    @dataclass
    class Pointed(Message):
        """Posted when the user has clicked a time in the chart."""

        time_s: float

    @dataclass
    class Ticked(Message):
        """Posted when the user has clicked the tick box of a variable."""

        name: str

    def __init__(self) -> None:
        super().__init__()
        self._text: PlotView = PlotView(self._redraw)
        self.border_title = "Chart"
        self.options = ChartOptions()
        self._painters: dict[str, ChartPainter] = {}
        self._pictures: list[tuple[int, ChartPicture]] = []
        self._model: AnalysisModel | None = None
        self._pointed_s: float | None = None
        """Time in the chart below the mouse pointer; None if the pointer is elsewhere."""

    def set_model(self, model: AnalysisModel) -> None:
        """Show another log in the chart, or the same log with other options."""
        self._painters.clear()
        self.show(model)

    def show(self, model: AnalysisModel) -> None:
        """Draw the chart for the present state of the model."""
        self._model = model
        width, height = self._text.size
        if not width or not height or not self.display:
            return
        if self.options.against and model.log.rows:
            self._pictures = []
            self._text.set_lines(self._draw_against(model, self.options.against, width, height))
            return
        self._text.draw(partial(self._paint, model))
        self._read(self._pointed_s)

    def _paint(
        self, model: AnalysisModel, is_blank: bool
    ) -> tuple[list[list[Run]], list[tuple[int, ChartPicture]]]:
        width, height = self._text.size
        for trace in model.traces.list_ticked():
            trace.prepare(
                model.find_x_limits(), width * (MAX_POINTS if is_blank else 1), self.options.hold
            )
        unit = model.x_unit
        measured = _build_measure_line(model, unit, width)
        marked = 1 if model.events.thresholds and model.log.rows else 0
        height -= len(measured) + marked
        ticked = model.traces.list_ticked()
        facets = ticked if self.options.facets and len(ticked) > 1 and height >= FACETS_ROWS else []
        facets = _select_facets(facets, model.selected, height // _MIN_FACET_ROWS)
        state = ChartState(
            model.selected,
            model.cursor_s if model.log.rows else None,
            model.find_x_limits(),
            bool(self.app.no_color),
            is_ascii(self.app),
            model.mark_s,
            unit,
            self.options.marks,
            grid=True,
            zoomed=model.limits is not None,
        )
        spans = {
            report.variable: build_spans(report.bands)
            for report in model.list_reports()
            if model.alignment == TIME and len(report.bands) <= _MAX_BANDS
        }
        self._pictures = []
        lines: list[list[Run]] = []
        parts: list[Traces] = [Traces({trace.name: trace}) for trace in facets] or [model.traces]
        if facets:
            state = replace(
                state, margins=measure_margins(parts, state, width, height // len(parts))
            )
        for index, part in enumerate(parts):
            rows = height // len(parts) + (index < height % len(parts))
            painter = self._painters.setdefault(
                facets[index].name if facets else "", ChartPainter()
            )
            part_state = replace(
                state, spans=spans.get(facets[index].name if facets else model.selected, ())
            )
            picture = painter.paint(part, part_state, width, rows, is_blank=is_blank)
            self._pictures.append((len(lines), picture))
            lines += [*picture.lines, *[[] for _ in range(rows - len(picture.lines))]]
        return [*lines, *(self._mark_events(model) if marked else []), *measured], self._pictures

    def _mark_events(self, model: AnalysisModel) -> list[list[Run]]:
        """Return the line below the charts with a mark at each event, as a list of one line."""
        _, picture = self._pictures[-1]
        if not picture.columns:
            return [[]]
        return [
            [
                (
                    " " * picture.left + draw_event_marks(model, picture.x_limits, picture.columns),
                    _EVENTS,
                )
            ]
        ]

    def _draw_against(
        self, model: AnalysisModel, names: tuple[str, str], width: int, height: int
    ) -> list[list[Run]]:
        trace = model.trace
        xs, ys = (limit_drawn(model.sample_variable(name)) for name in names)
        marker = (
            trace.mark
            if (self.app.no_color and is_ascii(self.app)) or self.options.marks
            else BRAILLE
        )
        return draw_xy_chart(xs, ys, model.sample, names, trace.rgb, marker, width, height)

    def columns(self) -> int:
        """Return the width of the chart's canvas in characters; 1 if no chart over time is drawn."""
        return max(self._pictures[0][1].columns, 1) if self._pictures else 1

    def time_beside(self, time_s: float, columns: int) -> float:
        """Return the time that is `columns` columns of the chart to the right of `time_s`.

        Both times are in the unit of the horizontal axis: seconds, or mm if the runs are aligned by distance.
        """
        low, high = self._model.find_x_limits() if self._model else (0.0, 1.0)
        return time_s + columns * (high - low) / self.columns()

    def _redraw(self) -> None:
        if self._model is not None:
            self.show(self._model)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        column, row = self.find_cell(event)
        for first, picture in self._pictures:
            for box in picture.boxes:
                if box.row == row - first and box.first <= column < box.end:
                    self.post_message(self.Ticked(box.name))
                    return
            time_s = picture.find_time_s(column, row - first)
            if time_s is not None:
                self.post_message(self.Pointed(time_s))

    def on_mouse_move(self, event: events.MouseMove) -> None:
        column, row = self.find_cell(event)
        times_s = (picture.find_time_s(column, row - first) for first, picture in self._pictures)
        self._read(next((time_s for time_s in times_s if time_s is not None), None))

    def on_leave(self) -> None:
        self._read(None)

    def _read(self, time_s: float | None) -> None:
        """Show the values of the drawn variables in the lower border.

        Args:
            time_s: Time under the pointer; None shows the values at the cursor.
        """
        self._pointed_s = time_s
        model = self._model
        drawn = (
            model.traces.list_drawn()
            if model is not None and model.log.rows and not self.options.against
            else []
        )
        words = ""
        if model is not None and drawn:
            unit = model.x_unit
            time_s = model.cursor_s if time_s is None else time_s
            words = escape_markup(format_values(drawn, time_s, unit, self.size.width - 4))
        # An assignment draws the panel again even if the words are the same.
        if words != self.border_subtitle:
            self.border_subtitle = words


def _select_facets(facets: list[LogTrace], selected: str, max_count: int) -> list[LogTrace]:
    """Return at most `max_count` facets (charts of one variable), the selected one among them."""
    index = next((index for index, trace in enumerate(facets) if trace.name == selected), 0)
    first = min(max(index - max_count + 1, 0), max(len(facets) - max_count, 0))
    return facets[first : first + max_count]


def _build_measure_line(model: AnalysisModel, unit: str, width: int) -> list[list[Run]]:
    """Return time, change, slope and statistics of a variable between the two cursors, as a list of one line.

    The variable is the selected one. The list is empty without a second cursor, or if the log has no rows.
    """
    if model.mark_s is None or not model.log.rows:
        return []
    plain = Style(color=palette.SOFT)
    strong = Style(color=palette.WHITE, bold=True)
    start_s, stop_s = sorted((model.mark_s, model.cursor_s))
    trace = model.trace
    before, after = trace.find_value(model.mark_s), trace.find_value(model.cursor_s)
    step = "Δt" if unit == "s" else "Δ"
    line: list[Run] = [
        (f"A {model.mark_s:.2f} {unit}  {step} ", plain),
        (f"{model.cursor_s - model.mark_s:.3f} {unit}", strong),
    ]
    if before is not None and after is not None:
        line += [("  Δ ", plain), (f"{after - before:.5g}", strong)]
        if stop_s > start_s:
            slope = (after - before) / (model.cursor_s - model.mark_s)
            line += [("  slope ", plain), (f"{slope:.4g}/{unit}", strong)]
    figures = trace.pyramid.compute_summary(start_s, stop_s)
    for word, value in (
        ("n", figures.count),
        ("mean", figures.mean),
        ("std", figures.std),
        ("min", figures.min),
        ("max", figures.max),
    ):
        text = f"{value:.5g}"
        if sum(len(part) for part, _ in line) + len(word) + len(text) + 3 > width:
            break
        line += [(f"  {word} ", plain), (text, strong)]
    return [line]


def draw_event_marks(model: AnalysisModel, limits: Limits, columns: int) -> str:
    """Return a line of `columns` characters with a mark in each column of the chart that has an event, else a blank.

    Args:
        model: The log with its events.
        limits: The least and the greatest value of the horizontal axis.
        columns: Width of the chart's canvas in characters.
    """
    line = [" "] * columns
    for event in model.events.list_events(model.log):
        if isinstance(event, CommandRow):
            place = model.find_place(event.row, event.time_s)
            mark = "╷"
        else:
            trace = model.traces.find_trace(event.variable)
            crossing = event.crossing
            place = crossing.time_s + float(
                trace.places[crossing.sample] - trace.series.time_s[crossing.sample]
            )
            mark = "▲" if crossing.rising else "▼"
        if limits[0] <= place <= limits[1]:
            column = min(max(find_column(place, limits, columns), 0), columns - 1)
            line[column] = mark if line[column] in (" ", mark) else "◆"
    return "".join(line)
