"""A chart of one variable against another, such as the path of the robot."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rich.color import Color
from rich.style import Style

from tuisim.datalog.arrays import FloatArray
from tuisim.ui.render import axes
from tuisim.ui.render.kinds import Rgb, Run
from tuisim.ui.render.plot import Curve, canvas

_AXIS, _WORDS = Style(color="#a8a8a8"), Style(color="#d8dee6")
_HERE = Style(color="#000000", bgcolor="#ffffff", bold=True)
_DOTS_X, _DOTS_Y = 2, 4
"""Dots of a braille character."""


def seen_points(
    xs: FloatArray, ys: FloatArray, limits: Sequence[axes.Limits], columns: int, rows: int
) -> tuple[FloatArray, FloatArray]:
    """Return the points of a path that a canvas can tell apart: of neighbours at the same dot only the first.

    Args:
        xs, ys: Finite, shape (n,).
        limits: Of x and of y.
        columns, rows: Size of the canvas in characters.
    """
    (left, right), (low, high) = limits
    across = np.floor((xs - left) / (right - left) * (_DOTS_X * columns - 1)).astype(np.int64)
    up = np.floor((ys - low) / (high - low) * (_DOTS_Y * rows - 1)).astype(np.int64)
    dots = across * (_DOTS_Y * rows) + up
    moved = np.flatnonzero(np.diff(dots, prepend=dots[:1] - 1))
    if len(moved) > len(np.unique(dots)) * 4:
        # It goes to and fro so often that no line could be followed: each dot once.
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
        here: Which of the points is looked at, None for none.
        names: Of x and of y.
        rgb: Colour of the curve.
        marker: `braille`, or one character.
        width, height: Size in characters.
    """
    good = np.isfinite(xs) & np.isfinite(ys)
    title: list[Run] = [(f"{names[1]} against {names[0]}", _WORDS)]
    if not good.any():
        return [title, [("no point has both", _AXIS)]]
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
        inside = [(part, Style(color=Color.from_rgb(*color)) if color else _WORDS) for part, color in drawn[row]]
        lines.append([(text.rjust(left - 1) + ("┤" if text else "│"), _AXIS), *inside])
    if here is not None and good[here]:
        title.append((f"   {names[0]} {xs[here]:.5g}  {names[1]} {ys[here]:.5g}", Style(bold=True)))
        column = axes.column_of(float(xs[here]), x_limits, columns)
        row = int((y_limits[1] - ys[here]) / (y_limits[1] - y_limits[0]) * (rows - 0.25))
        _put(lines[1 + min(max(row, 0), rows - 1)], left + column)
    line, below = axes.time_axis(x_limits, columns, "")
    return [*lines, [(" " * (left - 1) + "└" + line, _AXIS)], [(" " * left + below, _AXIS)]]


def _put(line: list[Run], column: int) -> None:
    """Mark a character of a line."""
    at = 0
    for number, (text, style) in enumerate(line):
        if at <= column < at + len(text):
            inside = column - at
            line[number : number + 1] = [(text[:inside], style), ("●", _HERE), (text[inside + 1 :], style)]
            return
        at += len(text)
