"""Distributions as pictures: a histogram, results against a parameter, and a heat map of two parameters."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from rich.color import Color
from rich.style import Style
from rich.text import Text

from tuisim.charts.axes import Limits, nice_step, value_limits
from tuisim.charts.canvas import BRAILLE, xy_lines
from tuisim.charts.layout import (
    COLORS,
    LETTER_PX,
    LINE_PX,
    PAD,
    Drawing,
    Fill,
    Frame,
    Rule,
    Shape,
    Stroke,
    Words,
    borders_of,
    grid_of,
    shortened,
    with_unit,
)
from tuisim.core.css_colors import Rgb
from tuisim.runs.arrays import FloatArray

Coordinate = str | bool | int | float
"""A value of a parameter."""

MOST_BINS = 40
_BAR = "▏▎▍▌▋▊▉█"
_SHADES: tuple[Rgb, ...] = ((68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37))
"""From the least value to the greatest: viridis, which is readable without colours, too."""
_LEGEND_PX = 90.0


def _words(value: Coordinate) -> str:
    if isinstance(value, float):
        return f"{value:.5g}"
    return str(value)


@dataclass(frozen=True, slots=True)
class Histogram:
    """How often a result lies in each of a number of equal intervals."""

    title: str
    name: str
    """The result."""
    edges: FloatArray
    """Shape (n + 1,), increasing."""
    counts: tuple[int, ...]
    """One count fewer than edges."""

    @classmethod
    def of(cls, title: str, name: str, values: FloatArray) -> Histogram:
        """Return the histogram of values, shape (n,); those that are not finite are left out."""
        finite = values[np.isfinite(values)]
        if not len(finite):
            return cls(title, name, np.array([0.0, 1.0]), (0,))
        low, high = float(finite.min()), float(finite.max())
        if high - low < 1e-9 * max(abs(low), abs(high), 1e-300):
            # One value, up to rounding.
            size = abs(low) * 0.01 or 1.0
            return cls(title, name, np.array([low - size / 2, low + size / 2]), (len(finite),))
        step = nice_step(high - low, min(max(math.ceil(2 * len(finite) ** (1 / 3)), 5), MOST_BINS))
        first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
        edges = np.asarray(np.arange(first, max(last, first + 1) + 1) * step, np.float64)
        counts, _ = np.histogram(np.clip(finite, edges[0], edges[-1]), edges)
        return cls(title, name, edges, tuple(counts.tolist()))


@dataclass(frozen=True, slots=True)
class Against:
    """A result against a parameter, one point for each run."""

    title: str
    name: str
    """The result."""
    parameter: str
    xs: tuple[Coordinate, ...]
    """Value of the parameter in each run."""
    ys: FloatArray
    """Value of the result in each run, shape (n,)."""

    def positions(self) -> tuple[FloatArray, tuple[str, ...]]:
        """Return where each run is on the x axis, and the names of the whole positions unless they are numbers."""
        if all(isinstance(x, int | float) and not isinstance(x, bool) for x in self.xs):
            return np.array(self.xs, np.float64), ()
        names = tuple(dict.fromkeys(map(_words, self.xs)))
        return np.array([names.index(_words(x)) for x in self.xs], np.float64), names

    def means(self) -> tuple[FloatArray, FloatArray]:
        """Return each position once, in rising order, and the mean result there."""
        at, _ = self.positions()
        good = np.isfinite(self.ys)
        xs = np.unique(at[good])
        return xs, np.array([self.ys[good & (at == x)].mean() for x in xs])


@dataclass(frozen=True, slots=True)
class HeatMap:
    """The mean of a result for each pair of values of two parameters."""

    title: str
    name: str
    """The result."""
    x_name: str
    y_name: str
    xs: tuple[Coordinate, ...]
    ys: tuple[Coordinate, ...]
    means: FloatArray
    """Shape (len(ys), len(xs)); NaN where there is no run."""

    @classmethod
    def of(
        cls, title: str, name: str, x: tuple[str, Sequence[Coordinate]], y: tuple[str, Sequence[Coordinate]],
        values: FloatArray,
    ) -> HeatMap:  # fmt: skip
        """Return the heat map of values, shape (n,), with two parameters: their names and values in each run."""
        xs, ys = (tuple(dict.fromkeys(each)) for _, each in (x, y))
        sums, counts = np.zeros((len(ys), len(xs))), np.zeros((len(ys), len(xs)))
        column, row = {value: at for at, value in enumerate(xs)}, {value: at for at, value in enumerate(ys)}
        for one, other, value in zip(x[1], y[1], values.tolist(), strict=True):
            if math.isfinite(value):
                sums[row[other], column[one]] += value
                counts[row[other], column[one]] += 1
        with np.errstate(invalid="ignore"):
            return cls(title, name, x[0], y[0], xs, ys, sums / counts)

    def limits(self) -> Limits:
        """Return the least and the greatest mean."""
        finite = self.means[np.isfinite(self.means)]
        return (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)


def shade(share: float) -> Rgb:
    """Return the colour of a value, from 0 to 1 of the range."""
    at = min(max(share, 0.0), 1.0) * (len(_SHADES) - 1)
    low = min(int(at), len(_SHADES) - 2)
    rgb = [round(a + (b - a) * (at - low)) for a, b in zip(_SHADES[low], _SHADES[low + 1], strict=True)]
    return rgb[0], rgb[1], rgb[2]


def _ink_on(rgb: Rgb) -> Rgb:
    return (255, 255, 255) if sum(rgb) < 384 else (0, 0, 0)


def _titled(title: str, width: int) -> list[Shape]:
    return [Words(PAD, PAD + LINE_PX / 2, shortened(title, width - 2 * PAD), strong=True)]


def _frame(x: Limits, y: Limits, width: int, height: int) -> Frame:
    left = PAD + 8 * LETTER_PX
    top, bottom = PAD + 2.6 * LINE_PX, height - PAD - 2.0 * LINE_PX
    return Frame(left, top, max(width - PAD - 3 * LETTER_PX, left + 10), max(bottom, top + 10), x, y)


def _below(frame: Frame, text: str) -> Words:
    return Words((frame.left + frame.right) / 2, frame.bottom + 1.7 * LINE_PX, text, "middle")


def drawing_of_histogram(data: Histogram, width: int, height: int) -> Drawing:
    """Return a histogram as a drawing in a size in pixels."""
    frame = _frame((float(data.edges[0]), float(data.edges[-1])), value_limits(0.0, max(data.counts)), width, height)
    shapes = [*_titled(data.title, width), *grid_of(frame), Words(PAD, PAD + 1.5 * LINE_PX, "runs")]
    edges = frame.xs(data.edges)
    for at, count in enumerate(data.counts):
        top = float(frame.ys(count))
        shapes.append(Fill(float(edges[at]) + 0.5, top, float(edges[at + 1] - edges[at]) - 1, frame.bottom - top,
                           COLORS[0]))  # fmt: skip
    return Drawing(data.title, width, height, (*shapes, *borders_of(frame), _below(frame, with_unit(data.name))))


def text_of_histogram(data: Histogram, width: int, height: int) -> Text:
    """Return a histogram as text in a size in characters: one line for each interval."""
    together = math.ceil(len(data.counts) / max(height - 2, 1))
    edges = data.edges[::together].tolist()
    if len(data.counts) % together:
        edges.append(float(data.edges[-1]))
    counts = [sum(data.counts[at : at + together]) for at in range(0, len(data.counts), together)]
    labels = [f"{low:.5g} … {high:.5g}" for low, high in pairwise(edges)]
    left, right = max(map(len, labels)), max(len(str(count)) for count in counts)
    columns = max(width - left - right - 3, 1)
    lines = [Text(data.title, "bold"), Text(with_unit(data.name))]
    for label, count in zip(labels, counts, strict=True):
        eighths = round(count / max(*counts, 1) * columns * 8)
        bar = "█" * (eighths // 8) + (_BAR[eighths % 8 - 1] if eighths % 8 else "")
        lines.append(Text.assemble(f"{label:>{left}} │", (bar, Style(color=Color.from_rgb(*COLORS[0]))), f" {count}"))
    return _cropped(lines, width)


def drawing_of_against(data: Against, width: int, height: int) -> Drawing:
    """Return a result against a parameter as a drawing in a size in pixels, with the means joined by a line."""
    at, names = data.positions()
    good = np.isfinite(data.ys)
    xs, ys = at[good], data.ys[good]
    x = (-0.5, len(names) - 0.5) if names else _limits(xs)
    frame = _frame(x, _limits(ys), width, height)
    shapes = _titled(data.title, width)
    grid = grid_of(frame, with_x=not names)
    shapes += [one for one in grid if not (names and isinstance(one, Rule) and one.x1 == one.x2)]
    room = (frame.right - frame.left) / max(len(names), 1)
    for number, name in enumerate(names):
        text = shortened(name, room - LETTER_PX)
        shapes.append(Words(float(frame.xs(number)), frame.bottom + 0.7 * LINE_PX, text, "middle"))
    if len(xs):
        shapes.append(Stroke(np.column_stack((frame.xs(xs), frame.ys(ys))), COLORS[0], dots=True))
        mean_x, mean_y = data.means()
        means = np.column_stack((frame.xs(mean_x), frame.ys(mean_y)))
        bar_px = min(room / 4, 60.0)
        bars = [Stroke(mean + np.array([[-bar_px, 0.0], [bar_px, 0.0]]), COLORS[1]) for mean in means]
        shapes += bars if names else [Stroke(means, COLORS[1], dots=len(means) == 1)]
        shapes.append(Words(frame.right, PAD + 1.5 * LINE_PX, "means", "end", rgb=COLORS[1]))
    shapes.append(Words(PAD, PAD + 1.5 * LINE_PX, with_unit(data.name), rgb=COLORS[0]))
    return Drawing(data.title, width, height, (*shapes, *borders_of(frame), _below(frame, with_unit(data.parameter))))


def _limits(values: FloatArray) -> Limits:
    return value_limits(float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)


def text_of_against(data: Against, width: int, height: int, *, colors: bool) -> Text:
    """Return a result against a parameter as text in a size in characters."""
    at, names = data.positions()
    lines = [Text(data.title, "bold")]
    legend = [Text(f"{number}: {name}") for number, name in enumerate(names)]
    rows = max(height - 1 - len(legend), 6)
    marker = BRAILLE if colors and len(at) > width else "•"
    for line in xy_lines(at, data.ys, None, (data.parameter, data.name), COLORS[0], marker, width, rows, joined=False):
        lines.append(Text.assemble(*line) if colors else Text("".join(text for text, _ in line)))
    return _cropped([*lines, *legend], width)


def drawing_of_heat_map(data: HeatMap, width: int, height: int) -> Drawing:
    """Return a heat map as a drawing in a size in pixels: the first value of `ys` at the bottom."""
    labels = [_words(y) for y in data.ys]
    left = PAD + max(max(map(len, labels)), 3) * LETTER_PX + 8
    top, bottom = PAD + 3.0 * LINE_PX, height - PAD - 2.0 * LINE_PX
    right = max(width - PAD - _LEGEND_PX, left + 10)
    frame = Frame(left, top, right, max(bottom, top + 10), (0, len(data.xs)), (0, len(data.ys)))
    shapes = _titled(data.title, width)
    shapes.append(Words(PAD, PAD + 1.7 * LINE_PX, with_unit(data.y_name)))
    cell_px = (frame.right - frame.left) / len(data.xs), (frame.bottom - frame.top) / len(data.ys)
    low, high = data.limits()
    for row, column in np.argwhere(np.isfinite(data.means)).tolist():
        mean = float(data.means[row, column])
        x, y = float(frame.xs(column)), float(frame.ys(row + 1))
        rgb = shade((mean - low) / (high - low) if high > low else 0.5)
        shapes.append(Fill(x, y, cell_px[0] + 0.5, cell_px[1] + 0.5, rgb))
        text = f"{mean:.4g}"
        if len(text) * LETTER_PX < cell_px[0] and cell_px[1] > LINE_PX:
            shapes.append(Words(x + cell_px[0] / 2, y + cell_px[1] / 2, text, "middle", rgb=_ink_on(rgb)))
    shapes += _cell_labels(data, frame, labels)
    shapes += _color_scale(data, frame)
    return Drawing(data.title, width, height, (*shapes, _below(frame, with_unit(data.x_name))))


def _cell_labels(data: HeatMap, frame: Frame, labels: Sequence[str]) -> list[Shape]:
    """Return the values of both parameters beside the cells, as many as fit."""
    shapes: list[Shape] = []
    each = max(math.ceil(LINE_PX * len(labels) / (frame.bottom - frame.top)), 1)
    for row in range(0, len(labels), each):
        shapes.append(Words(frame.left - 6, float(frame.ys(row + 0.5)), labels[row], "end"))
    names = [_words(x) for x in data.xs]
    widest_px = (max(map(len, names)) + 1) * LETTER_PX
    each = max(math.ceil(widest_px * len(names) / (frame.right - frame.left)), 1)
    for column in range(0, len(names), each):
        shapes.append(Words(float(frame.xs(column + 0.5)), frame.bottom + 0.7 * LINE_PX, names[column], "middle"))
    return shapes


def _color_scale(data: HeatMap, frame: Frame) -> list[Shape]:
    """Return the colours with their least and greatest value, to the right of the cells."""
    steps, left = 50, frame.right + 16
    each = (frame.bottom - frame.top) / steps
    shapes: list[Shape] = [
        Fill(left, frame.bottom - (step + 1) * each, 14, each + 0.5, shade((step + 0.5) / steps))
        for step in range(steps)
    ]
    low, high = data.limits()
    shapes.append(Words(left + 20, frame.top + LINE_PX / 2, f"{high:.4g}"))
    shapes.append(Words(left + 20, frame.bottom - LINE_PX / 2, f"{low:.4g}"))
    name = shortened(with_unit(data.name), _LEGEND_PX + 60)
    return [*shapes, Words(frame.right + _LEGEND_PX, frame.top - 0.7 * LINE_PX, name, "end")]


def text_of_heat_map(data: HeatMap, width: int, height: int, *, colors: bool) -> Text:
    """Return a heat map as a table of means, coloured if there are colours; what does not fit is left out."""
    labels = [_words(y) for y in data.ys]
    cells = [[f"{mean:.4g}" if math.isfinite(mean) else "" for mean in row] for row in data.means.tolist()]
    names = [_words(x) for x in data.xs]
    each = max([len(cell) for row in cells for cell in row] + [len(name) for name in names]) + 2
    left = max(map(len, labels)) + 1
    columns = max((width - left - 1) // each, 1)
    lines = [Text(data.title, "bold"), Text(f"mean of {with_unit(data.name)}; {data.y_name} ↑, {data.x_name} →")]
    low, high = data.limits()
    rows = list(range(len(labels)))[: max(height - 4, 1)]
    for row in reversed(rows):
        line = Text(f"{labels[row]:>{left}}│")
        for column in range(min(columns, len(names))):
            mean = float(data.means[row, column])
            rgb = shade((mean - low) / (high - low) if high > low else 0.5) if math.isfinite(mean) else None
            style = (
                Style(color=Color.from_rgb(*_ink_on(rgb)), bgcolor=Color.from_rgb(*rgb)) if rgb and colors else Style()
            )
            line.append(f"{cells[row][column]:^{each}}", style)
        lines.append(line)
    lines.append(Text(" " * left + "└" + "─" * (each * min(columns, len(names)))))
    lines.append(Text(" " * (left + 1) + "".join(f"{name:^{each}}" for name in names[:columns])))
    if len(names) > columns or len(labels) > len(rows):
        lines.append(Text(f"{len(names)} × {len(labels)} cells do not fit; a picture file has all of them"))
    return _cropped(lines, width)


def _cropped(lines: Sequence[Text], width: int) -> Text:
    for line in lines:
        line.rstrip()
        line.truncate(width)
    return Text("\n").join(lines)
