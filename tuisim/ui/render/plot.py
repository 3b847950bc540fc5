"""The chart's canvas, drawn by plotext as rows of coloured text."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from tuisim.datalog.arrays import FloatArray
from tuisim.ui.render.axes import Limits
from tuisim.ui.render.kinds import Rgb
from tuisim.ui.render.reduce import min_max

TextRun = tuple[str, Rgb | None]
"""A piece of a row in one colour, None where nothing is drawn."""

BRAILLE = "braille"
_CODES = re.compile(r"\x1b\[([0-9;]*)m")


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


@lru_cache(maxsize=1)
def _plotext() -> Any:
    # Costs more than the rest of the app's start: imported when the first curve is drawn.
    import plotext

    # Otherwise a chart is cut to what plotext takes for the size of the terminal.
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
        if len(times_s):
            marker = plotext.marker(curve.marker, curve.rgb)
            signal = figure.signal(times_s.tolist(), values.tolist(), marker=marker)
            figure.draw(signal.lines(curve.marker == BRAILLE))
    text = figure.build().string()
    return [_runs(line, columns) for line in text.split("\n")[:rows]]


def _runs(line: str, columns: int) -> list[TextRun]:
    """Read a row with colour codes; it is cut or filled to `columns`."""
    runs: list[TextRun] = []
    rgb: Rgb | None = None
    left = columns
    # re.split with one group gives text, codes, text, codes, …
    for at, part in enumerate(_CODES.split(line)):
        if at % 2:
            numbers = part.split(";")
            rgb = (int(numbers[2]), int(numbers[3]), int(numbers[4])) if numbers[:2] == ["38", "2"] else None
        elif part and left:
            runs.append((part[:left], rgb))
            left -= len(part[:left])
    if left:
        runs.append((" " * left, None))
    return runs
