"""The bands of a variable as spans of a chart: computed from its samples, and drawn in cells."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rich.style import Style

from tuisim.base import palette
from tuisim.logs.levels import Light, measure_levels
from tuisim.pictures.charts import axes
from tuisim.pictures.charts.axes import Limits
from tuisim.pictures.charts.layout import Span, fit_names
from tuisim.pictures.charts.traces import Trace
from tuisim.terminal.text_runs import Run

MAX_SAMPLES = 4000
"""Bands of more samples take too long to find for a chart that is on the screen: the analyser finds them."""
SHADES = Style(bgcolor=palette.HERE), Style(bgcolor=palette.FIELD)
"""Shades that alternate, so that bands without an edge between them stay apart."""
NAME = Style(color=palette.SOFT)
_MIN_COLUMNS = 3
"""Narrower bands have no name."""
_OVERHANG = 2
"""Columns that a level may be wider than its band: names beside each other are in different rows."""
_MAX_NAME_ROWS = 3
"""Rows from the lowest one in which names stand: higher up, a name seems to belong to the curve beside it."""
_SHIFTS = (0, 1, -1, 2, -2, 3, -3)
"""Columns from the middle of a band by which its name is moved if the middle is not free, in this order."""
FREE = " ┈"
"""Characters over which a name may be written."""


def find_spans(trace: Trace, light: Light) -> tuple[Span, ...]:
    """Return the bands of a trace as ranges of the time axis; none if the trace has more than `MAX_SAMPLES` points.

    Args:
        trace: A variable over time.
        light: How the colour sensor reads the mat.
    """
    if len(trace.times_s) > MAX_SAMPLES:
        return ()
    levels = measure_levels(trace.name, trace.values, light)
    ends = trace.times_s[levels.start].tolist(), trace.times_s[levels.stop - 1].tolist()
    names = ["" if trace.scale else grey for grey in levels.greys]
    rows = zip(*ends, levels.level.tolist(), names, strict=True)
    return tuple(
        Span.of_band(trace.name, start_s, stop_s, level, name)
        for start_s, stop_s, level, name in rows
    )


def find_columns(span: Span, x_limits: Limits, columns: int) -> range:
    """Return the columns of a canvas that a span of the time axis covers."""
    first, last = (axes.find_column(x, x_limits, columns) for x in (span.start, span.stop))
    return range(max(first, 0), min(last + 1, columns))


def place_names(
    spans: Sequence[Span],
    places: Sequence[range],
    rows: int,
    columns: int,
    is_free: Callable[[int, int, int], bool],
    avoided: Sequence[int] = (),
) -> list[tuple[int, int, str]]:
    """Return where the names of spans are written on a canvas: row, first column and text.

    Each name is in the lowest free row of its span; names without a free row are left out.

    Args:
        spans: The spans.
        places: The columns of each span.
        rows, columns: Size of the canvas.
        is_free: Returns whether nothing is drawn in a row between two columns.
        avoided: Columns, such as a cursor's, which names do not cover if they have room beside them.
    """
    names: list[tuple[int, int, str]] = []
    letters = [len(place) if len(place) >= _MIN_COLUMNS else 0 for place in places]
    for place, name in zip(places, fit_names(spans, letters, _OVERHANG), strict=True):
        middle = min(max(place.start + (len(place) - len(name) + 1) // 2, 0), columns - len(name))
        near = (middle + by for by in _SHIFTS if 0 <= middle + by <= columns - len(name))
        first = next(
            (
                column_at
                for column_at in near
                if not any(column_at <= column < column_at + len(name) for column in avoided)
            ),
            middle,
        )
        stop = first + len(name)
        for row in reversed(range(max(rows - _MAX_NAME_ROWS, 0), rows)) if name else ():
            beside = (column_at for column_at in names if column_at[0] == row)
            if is_free(row, first, stop) and not any(
                column_at <= stop and first <= column_at + len(text)
                for _, column_at, text in beside
            ):
                names.append((row, first, name))
                break
    return names


def shade_rows(
    rows: Sequence[list[Run]],
    spans: Sequence[Span],
    x_limits: Limits,
    columns: int,
    cursors: Sequence[int] = (),
    style: Style = NAME,
) -> list[list[Run]]:
    """Return the rows of a canvas with shaded columns for spans of the x axis, and with their names.

    Each name is in the lowest row of its span in which nothing is drawn.

    Args:
        rows: The canvas.
        spans: The spans to shade.
        x_limits: Limits of the x axis.
        columns: Width of the canvas.
        cursors: Columns of cursors; names are written beside these, not over them.
        style: Style of the names.
    """
    texts = ["".join(text for text, _ in row) for row in rows]
    places = [find_columns(span, x_limits, columns) for span in spans]
    shaded = list(rows)
    for row_number, first, name in place_names(
        spans,
        places,
        len(rows),
        columns,
        lambda row_number, first, stop: not texts[row_number][first:stop].strip(FREE),
        cursors,
    ):
        shaded[row_number] = [
            *_cut(shaded[row_number], 0, first),
            (name, style),
            *_cut(shaded[row_number], first + len(name), columns),
        ]
    return [_shade_row(row, places, columns) for row in shaded]


def _cut(row: list[Run], start: int, stop: int) -> list[Run]:
    """Return the pieces of a row between two columns, as a row."""
    piece = []
    column = 0
    for text, style in row:
        part = text[max(start - column, 0) : max(stop - column, 0)]
        if part:
            piece.append((part, style))
        column += len(text)
    return piece


def _shade_row(row: list[Run], places: Sequence[range], columns: int) -> list[Run]:
    shaded: list[Run] = []
    done = 0
    for number, place in enumerate(places):
        start = max(place.start, done)
        shaded += _cut(row, done, start)
        shaded += [
            (text, style + SHADES[number % len(SHADES)])
            for text, style in _cut(row, start, max(place.stop, start))
        ]
        done = max(place.stop, start)
    return shaded + _cut(row, done, columns)
