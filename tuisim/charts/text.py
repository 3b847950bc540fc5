"""Charts as lines of text."""

from __future__ import annotations

from rich.style import Style
from rich.text import Text

from tuisim.charts.canvas import BRAILLE, xy_lines
from tuisim.charts.layout import COLORS, Chart, Line, color_of
from tuisim.charts.text_chart import ChartPainter, ChartState
from tuisim.charts.text_runs import Run
from tuisim.charts.traces import Trace, Traces
from tuisim.errors import printable

LEAST_ROWS = 8
"""Minimum height of a chart of one variable."""


class _Drawn(Traces):
    """The lines of a chart as traces for `ChartPainter`."""

    def __init__(self, lines: tuple[Line, ...]) -> None:
        super().__init__()
        for line in lines:
            trace = self._by_name[line.name] = _trace(line)
            trace.on, trace.other_scale = True, line.other_scale
            trace.add(line.xs.tolist(), line.ys.tolist())


def text_of(chart: Chart, width: int, height: int, *, colors: bool = False) -> Text:
    """Return a chart as text of a given size in characters.

    Args:
        chart: The chart.
        width, height: Size in characters; facets use more lines if necessary.
        colors: Whether colours distinguish the lines; otherwise marks do.
    """
    shown: list[list[Run]] = []
    if chart.path:
        (line,) = chart.lines
        trace = _trace(line)
        marker = trace.mark if chart.marks else BRAILLE
        names = chart.x_label.partition(" (")[0], printable(line.name)
        shown = xy_lines(line.xs, line.ys, None, names, trace.rgb, marker, width, height)
    else:
        parts = [(line,) for line in chart.lines] if chart.facets else [chart.lines]
        rows = max(height // len(parts), LEAST_ROWS)
        for part in parts:
            grey = not colors and len(part) > 1
            state = ChartState(
                x_limits=chart.x_limits, grey=grey, marks=chart.marks, unit=_unit(chart), zoomed=chart.zoomed
            )
            shown += ChartPainter().paint(_Drawn(part), state, width, rows).lines
    lines = [Text(chart.title, "bold"), *(Text.assemble(*map(_on_any_ground, line)) for line in shown)]
    for at in lines:
        at.rstrip()
        at.truncate(width)
    return Text("\n").join(lines)


def _trace(line: Line) -> Trace:
    trace = Trace(printable(line.name), line.number)
    trace.rgb = color_of(line)
    return trace


def _on_any_ground(run: Run) -> Run:
    """Use the terminal's default colour for everything but data, for light and dark themes."""
    text, style = run
    return run if style.color and style.color.triplet in COLORS else (text, Style())


def _unit(chart: Chart) -> str:
    return chart.x_label.rpartition("(")[2].rstrip(")") if "(" in chart.x_label else ""
