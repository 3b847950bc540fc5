"""Canvases of character cells: a chart over time, and one variable against another."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import lru_cache
from types import ModuleType
from typing import Any

import numpy as np
from rich.color import Color
from rich.style import Style
from rich.text import Text

from tuisim import palette
from tuisim.charts import axes
from tuisim.charts.axes import Limits
from tuisim.charts.traces import min_max
from tuisim.core.css_colors import Rgb
from tuisim.data_class import dataclass
from tuisim.runs.arrays import FloatArray
from tuisim.terminal.text_runs import Run, rgb_of

TextRun = tuple[str, Rgb | None]
"""A piece of a row in one colour, None where nothing is drawn."""

BRAILLE = "braille"
_NEXT = 1.001
"""Distance of the second line that makes a trace thicker, in dots."""


@dataclass(frozen=True, slots=True)
class Curve:
    """One trace to be drawn."""

    times_s: FloatArray
    values: FloatArray
    rgb: Rgb
    marker: str = BRAILLE
    """`braille`, or one character, for terminals without colours."""
    rising: bool = True
    """Whether the times rise, so that points may be left out; a path may go anywhere."""
    joined: bool = True
    """Whether braille dots are joined by lines."""


@lru_cache(maxsize=1)
def _plotext() -> Any:
    # Most of its import is spent on its manual, which nobody opens here.
    manual = ModuleType("plotext._doc.doc")
    vars(manual)["docs"] = None
    sys.modules.setdefault(manual.__name__, manual)
    # Costs more than the rest of the app's start: imported when the first curve is drawn.
    import plotext

    # Otherwise plotext crops a chart to what it detects as the size of the terminal.
    plotext.terminal.limit(False, False)
    return plotext


def canvas(curves: Sequence[Curve], columns: int, rows: int, x_limits: Limits, y_limits: Limits) -> list[list[TextRun]]:
    """Return curves as rows of text, without axes.

    plotext has one figure a process: call this from one thread only.

    Args:
        curves: What to draw, the topmost last.
        columns: Width in characters, at least 1.
        rows: Height in characters, at least 1.
        x_limits: Times at the left and right edge.
        y_limits: Values at the lower and upper edge.
    """
    plotext = _plotext()
    figure = plotext.figure
    figure.clear()
    figure.axes(False)
    figure.canvas("default")
    for axis, limits in (("x", x_limits), ("y", y_limits)):
        for side in (0, 1):
            figure.ruler(axis, side).frequency(0)
        figure.ruler(axis, 0).lim(*limits)
    figure.plot_size(columns, rows)
    for curve in curves:
        times_s, values = curve.times_s, curve.values
        if curve.rising:
            times_s, values = min_max(times_s, values, x_limits, columns)
        if curve.marker != BRAILLE:
            values = _on_rows(values, y_limits, rows)
        if len(times_s):
            marker = plotext.marker(curve.marker, curve.rgb)
            signal = figure.signal(times_s.tolist(), values.tolist(), marker=marker)
            is_line = curve.joined and curve.marker == BRAILLE
            figure.draw(signal.lines(is_line))
            if is_line and curve.rising:
                thicker = _next_dots(times_s, values, columns, rows, x_limits, y_limits)
                figure.draw(figure.signal(*(along.tolist() for along in thicker), marker=marker).lines(True))
    return [[*_runs(line, columns)] for line in figure.build().string().split("\n")[:rows]]


def _next_dots(
    times_s: FloatArray, values: FloatArray, columns: int, rows: int, x_limits: Limits, y_limits: Limits
) -> tuple[FloatArray, FloatArray]:
    """Return points one dot beside and below others, or above where there is none below: both make a thicker line."""
    # The limits are in the middle of the outermost characters. plotext rounds a half to the even dot: a distance of a
    # little more than one dot is never lost.
    across = _NEXT * (x_limits[1] - x_limits[0]) / (DOTS_X * max(columns - 1, 1))
    down = _NEXT * (y_limits[1] - y_limits[0]) / (DOTS_Y * max(rows - 1, 1))
    return times_s + across, np.where(values - down >= y_limits[0], values - down, values + down)


def _on_rows(values: FloatArray, limits: Limits, rows: int) -> FloatArray:
    """Return values at the rows whose labels they are nearest to, as `axes.row_labels` places them.

    plotext rounds to the middle of a row, so that the first and the last row get half as many values as others.
    """
    low, high = limits
    above = np.floor((high - values) / (high - low) * (rows - 0.25))
    on_rows: FloatArray = high - above * (high - low) / max(rows - 1, 1)
    return on_rows


@lru_cache(maxsize=512)
def _runs(codes: str, columns: int) -> tuple[TextRun, ...]:
    """Return a row as pieces of one colour; crop or pad it to `columns`.

    While a chart grows, most of its rows stay as they are.
    """
    line = Text.from_ansi(codes)
    line.set_length(columns)
    runs: list[TextRun] = []
    at = 0
    for start, end, style in line.spans:
        rgb = rgb_of(style.color) if isinstance(style, Style) else None
        runs += [(line.plain[at:start], None), (line.plain[start:end], rgb)]
        at = end
    runs.append((line.plain[at:], None))
    return tuple(run for run in runs if run[0])


AXIS, PLAIN = Style(color=palette.LABEL), Style(color=palette.INK)
_HERE = Style(color=palette.BLACK, bgcolor=palette.WHITE, bold=True)
DOTS_X, DOTS_Y = 2, 4
"""Dots of a braille character."""


def styled(rgb: Rgb | None) -> Style:
    """Return the style of a text in a colour, `PLAIN` without one."""
    return Style(color=Color.from_rgb(*rgb)) if rgb else PLAIN


def seen_points(
    xs: FloatArray, ys: FloatArray, limits: Sequence[axes.Limits], columns: int, rows: int
) -> tuple[FloatArray, FloatArray]:
    """Return the points of a path that a canvas can distinguish: only the first of neighbours at the same dot.

    Args:
        xs, ys: Finite, shape (n,).
        limits: Of x and of y.
        columns, rows: Size of the canvas in characters.
    """
    (left, right), (low, high) = limits
    across = np.floor((xs - left) / (right - left) * (DOTS_X * columns - 1)).astype(np.int64)
    up = np.floor((ys - low) / (high - low) * (DOTS_Y * rows - 1)).astype(np.int64)
    dots = across * (DOTS_Y * rows) + up
    moved = np.flatnonzero(np.diff(dots, prepend=dots[:1] - 1))
    if len(moved) > len(np.unique(dots)) * 4:
        # The path moves to and fro so often that no line is discernible: draw each dot once.
        moved = np.unique(dots, return_index=True)[1]
    return xs[moved], ys[moved]


def xy_lines(
    xs: FloatArray,
    ys: FloatArray,
    here: int | None,
    names: tuple[str, str],
    rgb: Rgb,
    marker: str,
    width: int,
    height: int,
) -> list[list[Run]]:
    """Return the chart as lines of text.

    Args:
        xs, ys: Shape (n,); pairs that are not finite are left out.
        here: Index of the point to mark, None for none.
        names: Of x and of y.
        marker: `braille`, or one character.
        width, height: Size in characters.
    """
    good = np.isfinite(xs) & np.isfinite(ys)
    title: list[Run] = [(f"{names[1]} against {names[0]}", PLAIN)]
    if not good.any():
        return [title, [("no sample has both", AXIS)]]
    x_limits, y_limits = (axes.value_limits(float(a[good].min()), float(a[good].max())) for a in (xs, ys))
    rows = max(height - 3, 1)
    labels = axes.row_labels(y_limits, rows)
    left = max(map(len, labels.values())) + 1
    columns = max(width - left, 2)
    points = seen_points(xs[good], ys[good], (x_limits, y_limits), columns, rows)
    curve = Curve(*points, rgb, marker, rising=False)
    drawn = canvas([curve], columns, rows, x_limits, y_limits)
    lines = [title]
    for row in range(rows):
        text = labels.get(row, "")
        inside = [(part, styled(color)) for part, color in drawn[row]]
        lines.append([(text.rjust(left - 1) + ("┤" if text else "│"), AXIS), *inside])
    if here is not None and good[here]:
        title.append((f"   {names[0]} {xs[here]:.5g}  {names[1]} {ys[here]:.5g}", Style(bold=True)))
        column = axes.column_of(float(xs[here]), x_limits, columns)
        row = int((y_limits[1] - ys[here]) / (y_limits[1] - y_limits[0]) * (rows - 0.25))
        _put(lines[1 + min(max(row, 0), rows - 1)], left + column)
    line, below = axes.time_axis(x_limits, columns, "")
    return [*lines, [(" " * (left - 1) + "└" + line, AXIS)], [(" " * left + below, AXIS)]]


def _put(line: list[Run], column: int) -> None:
    at = 0
    for number, (text, style) in enumerate(line):
        if at <= column < at + len(text):
            inside = column - at
            line[number : number + 1] = [(text[:inside], style), ("●", _HERE), (text[inside + 1 :], style)]
            return
        at += len(text)
