"""Charts as lines of text: tick boxes, and the canvas with its axes; and whole charts for files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace

from rich.style import Style
from rich.text import Text

from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.base.errors import printable
from tuisim.pictures.charts import axes
from tuisim.pictures.charts.axes import Limits
from tuisim.pictures.charts.bands import FREE, NAME, shade_rows
from tuisim.pictures.charts.canvas import (
    AXIS,
    BRAILLE,
    PLAIN,
    Curve,
    TextRun,
    build_style,
    draw_canvas,
    draw_xy_chart,
)
from tuisim.pictures.charts.cell_scales import CellScales
from tuisim.pictures.charts.layout import COLORS, ChartData, Line, Span, find_color
from tuisim.pictures.charts.plot_image import Plot
from tuisim.pictures.charts.scales import find_unit
from tuisim.pictures.charts.traces import Trace, Traces
from tuisim.terminal.text_runs import Run, cut

_CURSOR = Style(color=palette.WHITE, bgcolor=palette.LINE)
_STRONG = Style(color=palette.WHITE, bold=True)
_FAINT = Style(color=palette.LINE)
_GRID = "┈"

_LINE_ROWS = 13
"""Lower charts have no line above the labels of time, so that the curves have its row."""
_BETWEEN_BOXES = "  "
"""Characters between two tick boxes."""

EMPTY_TEXT = (
    "Nothing logged yet. To log a value, print it with a name:",
    "print('Colour: ' + str(value))",
)
EMPTY_SHORT = ("Nothing logged yet.", "print('Colour: '", "      + str(value))")


@dataclass(frozen=True, slots=True)
class ChartState:
    """The user's settings of a chart: its cursors, its time range, its selected trace, and how it is drawn."""

    selected: str | None = None
    """Name of the trace whose tick box has the focus."""
    cursor_s: float | None = None
    x_limits: Limits | None = None
    """Fixed limits while the chart is frozen, None to follow."""
    grey: bool = False
    """Whether there are no colours, so that marks tell several traces apart."""
    is_ascii: bool = False
    """Whether there is no braille: without colours even a single trace is then drawn as marks."""
    other_s: float | None = None
    """The second cursor; distances are measured from it."""
    unit: str = "s"
    """Unit of the horizontal axis."""
    marks: bool = False
    """Whether to draw the points as marks, not joined by lines."""
    grows: bool = False
    """Whether more data may follow, so that the horizontal axis extends a little beyond them."""
    grid: bool = False
    """Whether to draw a faint line at each label of the left scale."""
    spans: tuple[Span, ...] = ()
    """Ranges that are shaded and named, in order of time."""
    margins: tuple[int, int] = (0, 0)
    """Columns on the left and the right of the canvas at least."""
    zoomed: bool = False
    """Whether the time range is zoomed: the vertical axis then fits the visible data."""
    tick_keys: str = "v and space"
    """The keys that choose and tick a trace, by default those of the analyser."""


@dataclass(frozen=True, slots=True)
class Box:
    """The position of a tick box in a chart: its row, its first column, and the column after its last."""

    row: int
    first: int
    end: int
    name: str


@dataclass(frozen=True, slots=True)
class ChartPicture:
    """A drawn chart as lines of text, with the positions of its parts in characters."""

    lines: list[list[Run]]
    boxes: tuple[Box, ...]
    left: int = 0
    top: int = 0
    columns: int = 0
    """Size of the canvas, 0 if there is none."""
    rows: int = 0
    x_limits: Limits = (0.0, 1.0)
    plot: Plot | None = None
    """The content of the canvas, for an image in place of it; None if there is none, or no room for it."""

    def find_column(self, x: float) -> int:
        """Return the column of the canvas, counted from its left edge, of a value on the horizontal axis."""
        return axes.find_column(x, self.x_limits, self.columns)

    def find_value(self, column: int) -> float:
        """Return the value on the horizontal axis in the middle of a column of the canvas."""
        return axes.find_column_value(column, self.x_limits, self.columns)

    def find_time_s(self, column: int, row: int) -> float | None:
        """Return the time in s at a column and row of the chart; None outside the canvas."""
        if 0 <= column - self.left < self.columns and 0 <= row - self.top < self.rows:
            return self.find_value(column - self.left)
        return None


@dataclass(slots=True)
class ChartPainter:
    """Draws a chart as text; stores the drawn canvas while its points and limits stay the same."""

    _key: object = field(default=None, init=False)
    _canvas: list[list[TextRun]] = field(default_factory=list, init=False)

    def paint(
        self, traces: Traces, state: ChartState, width: int, height: int, *, is_blank: bool = False
    ) -> ChartPicture:
        """Return the chart of traces for a panel.

        Args:
            traces: The traces.
            state: The user's settings.
            width, height: Inner size of the panel, at least 1.
            is_blank: Whether to leave the canvas empty, for an image in its place.
        """
        drawn = traces.list_drawn()
        by_mark = state.grey and (len(drawn) > 1 or state.is_ascii)
        lines, boxes = _draw_tick_boxes(traces, state.selected, by_mark, width)
        if not drawn:
            return ChartPicture(
                (lines + _empty(traces, width, height - len(lines), state))[:height], boxes
            )
        with_line = height >= _LINE_ROWS
        rows = max(height - len(lines) - 1 - with_line, 1)
        x_limits = state.x_limits or _time_limits(traces.end_s(), state.grows)
        scales = CellScales.build(drawn, width, rows, x_limits, state.zoomed, state.margins)
        columns = max(width - scales.left_width - scales.right_width, 2)
        left = scales.left_width
        top = len(lines)
        cursors = [time_s for time_s in (state.cursor_s, state.other_s) if time_s is not None]
        curves = tuple(scales.curve(trace, by_mark or state.marks) for trace in drawn)
        has_room = (
            len(lines) + rows + with_line <= height and left + columns + scales.right_width <= width
        )
        plot = None
        if has_room:
            ticks = (
                tuple(axes.time_ticks(x_limits, columns)),
                tuple(axes.find_row_ticks(scales.y_limits, rows)),
            )
            plot = Plot(
                curves,
                columns,
                rows,
                x_limits,
                scales.y_limits,
                *ticks,
                with_line,
                tuple(cursors),
                state.spans,
            )
        line, below = axes.draw_time_axis(x_limits, columns, state.unit)
        if is_blank and plot:
            lines += [scales.frame_row(row, [(" " * columns, AXIS)]) for row in range(rows)] + [
                []
            ] * with_line
        else:
            self._draw(drawn, scales, columns, rows, x_limits, curves)
            xs = sorted({axes.find_column(time_s, x_limits, columns) for time_s in cursors})
            on_grid = scales.labels[0] if state.grid and not state.is_ascii else {}
            inside = [
                _style_runs(self._canvas[row], is_on_grid=row in on_grid) for row in range(rows)
            ]
            if state.spans:
                inside = shade_rows(
                    inside, state.spans, x_limits, columns, xs, _style_of_names(drawn, state.spans)
                )
            lines += [scales.frame_row(row, _draw_cursors(inside[row], xs)) for row in range(rows)]
            if with_line:
                lines.append([(" " * (left - 1) + "└" + line, AXIS)])
        lines.append([(" " * left + below, AXIS)])
        return ChartPicture(lines[:height], boxes, left, top, columns, rows, x_limits, plot)

    def _draw(
        self,
        drawn: list[Trace],
        scales: CellScales,
        columns: int,
        rows: int,
        x_limits: Limits,
        curves: Sequence[Curve],
    ) -> None:
        points = [(trace.name, len(trace.times_s)) for trace in drawn]
        key = (points, scales.scales, columns, rows, x_limits, [curve.marker for curve in curves])
        if key == self._key:
            return
        self._key = key
        self._canvas = draw_canvas(curves, columns, rows, x_limits, scales.y_limits)


_MIN_SPAN_S = 1e-9
"""Shorter than the clock's step: such times were printed."""


def _time_limits(end_s: float, grows: bool) -> Limits:
    if grows:
        return axes.grow_limits(end_s)
    return 0.0, end_s if end_s > _MIN_SPAN_S else 1.0


def _style_runs(runs: list[TextRun], is_on_grid: bool) -> list[Run]:
    """Return the pieces of a row of the canvas with their styles; with `is_on_grid`, the grid fills the gaps."""
    if not is_on_grid:
        return [(text, build_style(rgb)) for text, rgb in runs]
    return [
        (text.replace(" ", _GRID), _FAINT) if rgb is None else (text, build_style(rgb))
        for text, rgb in runs
    ]


def _style_of_names(drawn: Sequence[Trace], spans: Sequence[Span]) -> Style:
    """Return the style for the names of bands: the colour of the curve with the bands.

    If only one curve is drawn, the style is `NAME`.
    """
    names = {span.name for span in spans}
    of_bands = [trace for trace in drawn if {trace.name} == names]
    return build_style(of_bands[0].rgb) if of_bands and len(drawn) > 1 else NAME


def _draw_cursors(runs: list[Run], columns: Sequence[int]) -> list[Run]:
    """Return a row of the canvas with cursors at columns, given in rising order; columns outside it are ignored."""
    line: list[Run] = []
    column_at = 0
    for text, style in runs:
        done = 0
        for inside in (column - column_at for column in columns):
            if 0 <= inside < len(text):
                mark = text[inside]
                line.append((text[done:inside], style))
                line.append(("│", _CURSOR) if mark in FREE else (mark, style + _CURSOR))
                done = inside + 1
        line.append((text[done:], style))
        column_at += len(text)
    return [run for run in line if run[0]]


def _draw_tick_boxes(
    traces: Traces, selected: str | None, by_mark: bool, width: int
) -> tuple[list[list[Run]], tuple[Box, ...]]:
    """Return the row of tick boxes as a list of one row, and the position of each box; both are empty without traces.

    If some boxes have no room, the row ends with their number.
    """
    every = [*traces]
    if not every:
        return [], ()
    widest = width - len(f" +{len(every)}") * (len(every) > 1)
    texts = [
        (cut(f"[{'x' if trace.on else ' '}] {trace.name}", max(widest, 1)), trace)
        for trace in every
    ]
    numbers = _choose_boxes(texts, selected, width)
    runs: list[Run] = []
    boxes = []
    column = 0
    for text, trace in (texts[number] for number in numbers):
        if column:
            runs.append((_BETWEEN_BOXES, PLAIN))
            column += len(_BETWEEN_BOXES)
        boxes.append(Box(0, column, column + len(text), trace.name))
        runs += _draw_box(text, trace, trace.name == selected, by_mark)
        column += len(text)
    if more := len(texts) - len(numbers):
        runs.append((f"+{more}".rjust(width - column), AXIS))
    return [runs], tuple(boxes)


def _choose_boxes(
    texts: Sequence[tuple[str, Trace]], selected: str | None, width: int
) -> list[int]:
    """Return the indices of the tick boxes that fit into a row, in order; selected and drawn traces come first."""
    gap = len(_BETWEEN_BOXES)
    if sum(len(text) + gap for text, _ in texts) - gap <= width:
        return [*range(len(texts))]
    chosen: list[int] = []
    room = width - len(f"+{len(texts)}") - 1
    for number in sorted(
        range(len(texts)),
        key=lambda number: (texts[number][1].name != selected, not texts[number][1].on),
    ):
        room -= len(texts[number][0]) + gap * bool(chosen)
        if room < 0 and chosen:
            break
        chosen.append(number)
    return sorted(chosen)


def _draw_box(text: str, trace: Trace, selected: bool, by_mark: bool) -> list[Run]:
    color = build_style(trace.rgb) if trace.on else AXIS
    if by_mark and trace.on:
        text = text.replace("[x]", f"[{trace.mark}]", 1)
    return [(text, color + Style(reverse=True) if selected else color)]


def measure_margins(
    parts: Sequence[Traces], state: ChartState, width: int, rows: int
) -> tuple[int, int]:
    """Return how many columns several charts need left and right of their canvases, so that the canvases are in line.

    Args:
        parts: The traces of each chart.
        state: The user's settings.
        width, rows: Size of each chart in characters.
    """
    drawn = [part.list_drawn() for part in parts if part.list_drawn()]
    limits = state.x_limits or (0.0, 1.0)
    rows = max(rows - 2 - (rows >= _LINE_ROWS), 1)
    scales = [CellScales.build(traces, width, rows, limits, state.zoomed) for traces in drawn]
    return max((cell_scales.left_width for cell_scales in scales), default=0), max(
        (cell_scales.right_width for cell_scales in scales), default=0
    )


def format_values(
    drawn: Sequence[Trace], cursor_s: float, unit: str, width: int, *, end_s: float | None = None
) -> str:
    """Return the values of traces at a time as a text of at most `width` letters, as many as fit.

    Args:
        drawn: The traces.
        cursor_s: The time that the text shows, in `unit`.
        unit: The unit of the times, such as `s`.
        width: The largest length of the text.
        end_s: The time at which the values are read, such as the end of the tick at `cursor_s`; None for `cursor_s`
            itself.
    """
    line = f"{cursor_s:.2f} {unit}"
    for number, trace in enumerate(drawn):
        value = trace.find_value(cursor_s if end_s is None else end_s)
        read = (
            f"  {trace.name} {value:.5g}{find_unit(trace.name)}"
            if value is not None
            else f"  {trace.name} –"
        )
        more = len(drawn) - number - 1
        if len(line) + len(read) + (4 if more else 0) > width:
            return f"{line} +{more + 1}"[:width]
        line += read
    return line


def _empty(traces: Traces, width: int, height: int, state: ChartState) -> list[list[Run]]:
    """Return the text of a chart without curves: how to log a value, or that no trace is ticked.

    Args:
        traces: The traces, of which none is drawn.
        width, height: Size in characters.
        state: Says which keys show a trace.
    """
    has_keys = state.selected is not None and width >= 26
    how = (f"{state.tick_keys} show a trace",) if has_keys else ()
    if any(trace.logged for trace in traces):
        words: tuple[str, ...] = ("No trace is ticked.", *how)
    else:
        words = EMPTY_TEXT if width >= len(EMPTY_TEXT[0]) else EMPTY_SHORT
        words = (*words, "", *how) if how else words
    above = max((height - len(words)) // 2, 0)
    widest = max(map(len, words))
    margin = " " * max((width - widest) // 2, 0)
    lines: list[list[Run]] = [[] for _ in range(above)]
    return lines + [
        [(margin + text, _STRONG if "print" in text or "str(" in text else PLAIN)] for text in words
    ]


MIN_ROWS = 8
"""Minimum height of a chart of one variable."""


def draw_text(chart: ChartData, width: int, height: int, *, colors: bool = False) -> Text:
    """Return a chart as text.

    Args:
        chart: The chart.
        width, height: Size in characters; facets use more lines if necessary.
        colors: Whether colours distinguish the lines; otherwise marks do.
    """
    drawn_lines: list[list[Run]] = []
    if chart.path:
        (line,) = chart.lines
        trace = _trace(line)
        marker = trace.mark if chart.marks else BRAILLE
        names = chart.x_label.partition(" (")[0], printable(line.name)
        drawn_lines = draw_xy_chart(line.xs, line.ys, None, names, trace.rgb, marker, width, height)
    else:
        groups = [(line,) for line in chart.lines] if chart.facets else [chart.lines]
        rows = max(height // len(groups), MIN_ROWS)
        parts = [Traces({line.name: _trace(line) for line in group}) for group in groups]
        grey = not colors and not chart.facets and len(chart.lines) > 1
        state = ChartState(
            x_limits=chart.x_limits,
            grey=grey,
            marks=chart.marks,
            unit=_find_common_unit(chart),
            zoomed=chart.zoomed,
        )
        state = replace(state, margins=measure_margins(parts, state, width, rows))
        for part in parts:
            drawn_lines += ChartPainter().paint(part, state, width, rows).lines
    lines = [
        Text(chart.title, "bold"),
        *(Text.assemble(*map(_on_any_ground, line)) for line in drawn_lines),
    ]
    for row in lines:
        row.rstrip()
        row.truncate(width)
    return Text("\n").join(lines)


def _trace(line: Line) -> Trace:
    trace = Trace(printable(line.name), line.number)
    trace.rgb = find_color(line)
    trace.scale = line.scale
    trace.add(line.xs.tolist(), line.ys.tolist())
    return trace


def _on_any_ground(run: Run) -> Run:
    """Return a piece of text in the default colour of the terminal, unless it has a colour of data.

    It is then legible in light and dark terminals.
    """
    text, style = run
    return run if style.color and style.color.triplet in COLORS else (text, Style())


def _find_common_unit(chart: ChartData) -> str:
    return chart.x_label.rpartition("(")[2].rstrip(")") if "(" in chart.x_label else ""
