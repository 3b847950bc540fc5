"""Canvases of character cells: a chart over time, and one variable against another."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import lru_cache
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.color import Color
from rich.style import Style
from rich.text import Text

from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.pictures.charts import axes
from tuisim.pictures.charts.axes import Limits
from tuisim.pictures.charts.traces import clip_line, reduce_points
from tuisim.terminal.text_runs import Run

if TYPE_CHECKING:
    import numpy.typing as npt

TextRun = tuple[str, Rgb | None]
"""A piece of a row in one colour, None where nothing is drawn."""

BRAILLE = "braille"
DOTS_X, DOTS_Y = 2, 4
"""Dots of a braille character."""
_BLANK = ord(" ")
_NO_DOTS = 0x2800
_BITS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]], np.uint32)
"""The bit of each dot in the number of a braille character."""
_TURN = 4
"""Columns that a curve has at a time where it shares its cells with others."""


@dataclass(frozen=True, slots=True)
class Curve:
    """The points of one trace, and how they are drawn."""

    times_s: FloatArray
    values: FloatArray
    rgb: Rgb
    marker: str = BRAILLE
    """How points are drawn: `braille`, or one character, for terminals without colours."""
    rising: bool = True
    """Whether the times rise, so that points may be left out; a path may go anywhere."""
    joined: bool = True
    """Whether braille dots are joined by lines."""


@lru_cache(maxsize=1)
def _load_plotext() -> Any:
    # plotext spends most of its import on its manual, which nobody opens here.
    manual = ModuleType("plotext._doc.doc")
    vars(manual)["docs"] = None
    sys.modules.setdefault(manual.__name__, manual)
    # This import costs more than the rest of the app's start, so it waits for the first curve.
    import plotext

    # Without this, plotext crops a chart to what it detects as the size of the terminal.
    plotext.terminal.limit(False, False)
    return plotext


def draw_canvas(
    curves: Sequence[Curve], columns: int, rows: int, x_limits: Limits, y_limits: Limits
) -> list[list[TextRun]]:
    """Return curves as rows of braille characters, without axes.

    If several lines share cells, the cells have the colours of these lines in turn, so that none is hidden. Of points
    that are not joined, the topmost is visible.

    Args:
        curves: The curves, the topmost last.
        columns: Width in characters, at least 1.
        rows: Height in characters, at least 1.
        x_limits: Times at the left and right edge.
        y_limits: Values in the middle of the lowest and the highest row.
    """
    signs = np.full((len(curves), rows, columns), _BLANK, np.uint32)
    dots = np.zeros((rows, columns), np.uint32)
    inked = np.zeros(signs.shape, np.bool_)
    for number, curve in enumerate(curves):
        if not len(curve.times_s):
            continue
        if curve.marker == BRAILLE:
            cells = _draw_braille(curve, columns, rows, x_limits, y_limits)
            inked[number] = cells > 0
            dots |= cells
        else:
            across, down = _clip_places(
                *_place_points(curve, columns, rows, x_limits, y_limits), columns, rows
            )
            inked[number, down, across] = True
            signs[number] = ord(curve.marker)
    visible = choose_owners(inked, _TURN if all(curve.joined for curve in curves) else columns)
    for number, curve in enumerate(curves):
        if curve.marker == BRAILLE:
            signs[number] = _NO_DOTS + dots
    owners = (
        np.where(visible.any(axis=0), visible.argmax(axis=0), -1)
        if len(curves)
        else np.full((rows, columns), -1)
    )
    drawn = np.where(visible, signs, 0).max(axis=0, initial=0)
    drawn[owners < 0] = _BLANK
    colors = [*(curve.rgb for curve in curves), None]
    return [_split_runs(text, owner, colors) for text, owner in zip(drawn, owners, strict=True)]


def choose_owners(covered: npt.NDArray[np.bool_], width: int) -> npt.NDArray[np.bool_]:
    """Return which curve is visible at each place of a canvas; curves at the same place take turns along the row.

    Args:
        covered: Shape (curves, rows, columns): where each curve is, the topmost last.
        width: How many columns of a row one curve is visible before the next curve follows.

    Returns:
        The same shape; at most one curve is True at a place.
    """
    count = covered.sum(axis=0)
    turn = np.arange(covered.shape[2]) // width % np.maximum(count, 1)
    above = count - covered.cumsum(axis=0)
    seen: npt.NDArray[np.bool_] = covered & (above == turn)
    return seen


def _place_points(
    curve: Curve,
    columns: int,
    rows: int,
    x_limits: Limits,
    y_limits: Limits,
    parts: tuple[int, int] = (1, 1),
) -> tuple[FloatArray, FloatArray]:
    """Return how far a curve's points are from the left and from the top of a canvas, in cells or parts of cells.

    Args:
        curve: The curve.
        columns, rows: Size of the canvas in cells.
        x_limits, y_limits: Limits of the axes.
        parts: How many parts a cell has across and down; with (1, 1), the distances are in cells.
    """
    times_s = curve.times_s
    values = curve.values
    if curve.rising:
        times_s, values = reduce_points(times_s, values, x_limits, columns)
        if curve.joined and curve.marker == BRAILLE:
            times_s, values = clip_line(times_s, values, x_limits)
    across = (times_s - x_limits[0]) / (x_limits[1] - x_limits[0]) * (columns - 0.5) * parts[0]
    down = axes.measure_row(values, y_limits, rows) * parts[1]
    # Positions far off the canvas are limited, so that a line to one is not drawn dot by dot all the way.
    return across.clip(-columns, 4 * columns), down.clip(-4 * rows, 8 * rows)


def _clip_places(
    across: FloatArray, down: FloatArray, columns: int, rows: int
) -> tuple[IntArray, IntArray]:
    """Return positions on a canvas as columns and rows of cells, without those outside the canvas."""
    indices = np.floor(across).astype(np.int64), np.floor(down).astype(np.int64)
    good = (indices[0] >= 0) & (indices[0] < columns) & (indices[1] >= 0) & (indices[1] < rows)
    return indices[0][good], indices[1][good]


def _draw_braille(
    curve: Curve, columns: int, rows: int, x_limits: Limits, y_limits: Limits
) -> npt.NDArray[np.uint32]:
    """Return the dots of a curve as bits of a braille character for each cell, shape (rows, columns)."""
    across, down = _place_points(curve, columns, rows, x_limits, y_limits, (DOTS_X, DOTS_Y))
    is_thick = curve.joined and curve.rising
    # A line over time is two dots thick: the dot above and the one below its place. All dots are moved by a margin of
    # one character: the limits are in the middle of the outermost characters of the canvas, dots can lie beyond them.
    across = np.floor(across) + DOTS_X
    down = (np.rint(down) - 1 if is_thick else np.floor(down)) + DOTS_Y
    width, height = (columns + 2) * DOTS_X, (rows + 2) * DOTS_Y
    if curve.joined:
        # Points outside move to the edge of the margin, so that lines lead there.
        across = across.clip(0, width - 1)
        down = down.clip(0, height - 1)
    else:
        across, down = (
            indices.astype(np.float64) for indices in _clip_places(across, down, width, height)
        )
    if not len(across):
        return np.zeros((rows, columns), np.uint32)
    bits = _plot_braille(across, down, columns + 2, rows + 2, curve.joined)
    dots = (bits[:, None, :, None] & _BITS[None, :, None, :] > 0).reshape(height, width)
    if is_thick:
        dots[:, 1:] |= dots[:, :-1].copy()
        dots[1:] |= dots[:-1].copy()
    inner = dots[DOTS_Y:-DOTS_Y, DOTS_X:-DOTS_X].astype(np.uint32)
    cells: npt.NDArray[np.uint32] = np.einsum(
        "ryck,yk->rc", inner.reshape(rows, DOTS_Y, columns, DOTS_X), _BITS
    )
    return cells


def _plot_braille(
    across: FloatArray, down: FloatArray, columns: int, rows: int, joined: bool
) -> npt.NDArray[np.uint32]:
    """Return the dots that plotext draws as bits of a braille character for each cell, shape (rows, columns).

    plotext has one figure in a process: call this from one thread only.

    Args:
        across, down: Positions of dots, from the left and the top.
        columns, rows: Size in characters.
        joined: Whether the dots are joined by lines.
    """
    plotext = _load_plotext()
    figure = plotext.figure
    figure.clear()
    figure.axes(False)
    figure.canvas("default")
    for axis, last in (("x", columns - 1), ("y", rows - 1)):
        for side in (0, 1):
            figure.ruler(axis, side).frequency(0)
        figure.ruler(axis, 0).lim(0, last)
    figure.plot_size(columns, rows)
    # plotext measures in characters, upwards; whole numbers are the middles of characters.
    xs = (across + 0.5) / DOTS_X - 0.5
    ys = rows - 0.5 - (down + 0.5) / DOTS_Y
    figure.draw(
        figure.signal(xs.tolist(), ys.tolist(), marker=plotext.marker(BRAILLE)).lines(joined)
    )
    bits = np.zeros((rows, columns), np.uint32)
    for row, line in enumerate(figure.build().string().split("\n")[:rows]):
        signs = np.array([*map(ord, Text.from_ansi(line).plain[:columns])], np.uint32)
        bits[row, : len(signs)] = np.where(signs > _NO_DOTS, signs - _NO_DOTS, 0)
    return bits


def _split_runs(
    text: npt.NDArray[np.uint32], owners: npt.NDArray[np.int64], colors: Sequence[Rgb | None]
) -> list[TextRun]:
    """Return a row of characters as pieces of one colour.

    Args:
        text: The code of each character.
        owners: Index of the colour of each cell; -1, for no curve, stands for the last colour.
        colors: The colours.
    """
    starts = np.flatnonzero(np.diff(owners, prepend=-2)).tolist()
    ends = [*starts[1:], len(text)]
    return [
        ("".join(map(chr, text[start:end].tolist())), colors[owners[start]])
        for start, end in zip(starts, ends, strict=True)
    ]


AXIS, PLAIN = Style(color=palette.LABEL), Style(color=palette.INK)
_HERE = Style(color=palette.BLACK, bgcolor=palette.WHITE, bold=True)


def build_style(rgb: Rgb | None) -> Style:
    """Return the style of text in a colour; `PLAIN` for None."""
    return Style(color=Color.from_rgb(*rgb)) if rgb else PLAIN


def drop_hidden_points(
    xs: FloatArray, ys: FloatArray, limits: Sequence[axes.Limits], columns: int, rows: int
) -> tuple[FloatArray, FloatArray]:
    """Return the points of a path that are visible on a canvas: of successive points at the same dot, only the first.

    Args:
        xs, ys: Finite, shape (n,).
        limits: The limits of x and of y.
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


def _measure_ends(values: FloatArray) -> Limits:
    return float(values.min()), float(values.max())


def draw_xy_chart(
    xs: FloatArray,
    ys: FloatArray,
    here: int | None,
    names: tuple[str, str],
    rgb: Rgb,
    marker: str,
    width: int,
    height: int,
) -> list[list[Run]]:
    """Return a chart of one variable against another as lines of text.

    Args:
        xs, ys: The values of the two variables, shape (n,); pairs that are not finite are left out.
        here: Index of the point to mark, None for none.
        names: Names of x and of y.
        rgb: Colour of the points.
        marker: `braille`, or one character.
        width, height: Size in characters.
    """
    good = np.isfinite(xs) & np.isfinite(ys)
    title: list[Run] = [(f"{names[1]} against {names[0]}", PLAIN)]
    if not good.any():
        return [title, [("no sample has both", AXIS)]]
    rows = max(height - 3, 1)
    x_limits = axes.choose_limits(*_measure_ends(xs[good]))
    y_limits = axes.extend_limits(_measure_ends(ys[good]), rows)
    labels = axes.label_rows(y_limits, rows)
    left = max(map(len, labels.values())) + 1
    columns = max(width - left, 2)
    points = drop_hidden_points(xs[good], ys[good], (x_limits, y_limits), columns, rows)
    curve = Curve(*points, rgb, marker, rising=False)
    drawn = draw_canvas([curve], columns, rows, x_limits, y_limits)
    lines = [title]
    for row in range(rows):
        text = labels.get(row, "")
        inside = [(part, build_style(color)) for part, color in drawn[row]]
        lines.append([(text.rjust(left - 1) + ("┤" if text else "│"), AXIS), *inside])
    if here is not None and good[here]:
        title.append((f"   {names[0]} {xs[here]:.5g}  {names[1]} {ys[here]:.5g}", Style(bold=True)))
        column = axes.find_column(float(xs[here]), x_limits, columns)
        row = int(axes.measure_row(float(ys[here]), y_limits, rows))
        _put(lines[1 + row], left + column)
    line, below = axes.draw_time_axis(x_limits, columns, "")
    return [*lines, [(" " * (left - 1) + "└" + line, AXIS)], [(" " * left + below, AXIS)]]


def _put(line: list[Run], column: int) -> None:
    start = 0
    for number, (text, style) in enumerate(line):
        if start <= column < start + len(text):
            inside = column - start
            line[number : number + 1] = [
                (text[:inside], style),
                ("●", _HERE),
                (text[inside + 1 :], style),
            ]
            return
        start += len(text)
