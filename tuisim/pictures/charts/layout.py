"""A chart as data, and its layout in pixels, which `pictures.charts.files` writes as SVG and PNG."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tuisim.base.data_class import dataclass
from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.runs.arrays import FloatArray
from tuisim.pictures.charts.axes import Limits, label_ticks
from tuisim.pictures.charts.scales import Scales, add_unit, find_unit

COLORS: tuple[Rgb, ...] = (
    (31, 119, 180),
    (217, 95, 2),
    (27, 158, 119),
    (201, 60, 140),
    (117, 112, 199),
    (166, 118, 29),
    (214, 39, 40),
    (80, 150, 30),
    (23, 160, 190),
    (120, 120, 120),
)
"""Line colours, distinguishable on white and on black."""

FONT_PX = 13
"""Height of the letters."""
LETTER_PX = 7.2
"""Upper estimate of a character's width."""
PAD = 10
LINE_PX = 20
"""Margin of a picture, and height of a line of text."""
_FACET_GAP_PX = 12
_SCALE_GAP_PX = 6


@dataclass(frozen=True, slots=True)
class Line:
    """The points of one variable of a chart, and how they are drawn."""

    name: str
    xs: FloatArray
    """Shape (n,), finite; increasing except for a path."""
    ys: FloatArray
    """Shape (n,), finite."""
    number: int
    """Index that selects colour and marker."""
    scale: str = ""
    """Name of the scale to which the line is drawn, as `Trace.scale`."""

    @property
    def label(self) -> str:
        """The name of the variable, with its unit if the name implies it."""
        return add_unit(self.name)


@dataclass(frozen=True, slots=True)
class Span:
    """A highlighted range of the x axis, with a label."""

    start: float
    stop: float
    texts: tuple[str, ...]
    """Names of the span, the longest first: the first one with room is written."""
    name: str
    """Name of the variable whose band the span is."""

    @classmethod
    def of_band(cls, name: str, start: float, stop: float, level: float, grey: str) -> Span:
        """Return a band as a shaded range of the time axis, named by its level and its grey."""
        text = f"{level:.4g}"
        return cls(start, stop, (f"{text} {grey}".rstrip(), text), name)


@dataclass(frozen=True, slots=True)
class ChartData:
    """The data of a whole chart: its lines, its axes and its title."""

    title: str
    lines: tuple[Line, ...]
    x_limits: Limits
    x_label: str
    facets: bool = False
    marks: bool = False
    path: bool = False
    """Whether one variable is drawn against another."""
    spans: tuple[Span, ...] = ()
    zoomed: bool = False
    """Whether the time range is zoomed: the vertical axis then fits the visible data."""

    def lay_out(self, width: int, height: int, *, titled: bool = True) -> Drawing:
        """Return the picture of a chart.

        Args:
            width, height: Size in pixels.
            titled: Whether the title is above it.
        """
        shapes: list[Shape] = []
        top: float = PAD
        if titled:
            shapes.append(
                Words(PAD, top + LINE_PX / 2, shorten(self.title, width - 2 * PAD), strong=True)
            )
            top += LINE_PX + 4
        groups = [(line,) for line in self.lines] if self.facets else [self.lines]
        scales = [_group_lines(group, self.zoomed or self.path) for group in groups]
        if not self.facets:
            legend, lines = _draw_legend(self.lines, scales[0], width, top)
            shapes += legend
            top += lines * LINE_PX + 4
        plots: list[Frame] = []
        left = PAD + max(_measure_widest(each_scales.left.limits) for each_scales in scales)
        right_px = max(
            [3 * LETTER_PX, *(_measure_right_width(each_scales) for each_scales in scales)]
        )
        right = max(width - PAD - right_px, left + 1)
        bottom = height - PAD - 2 * LINE_PX
        each = (bottom - top) / len(groups)
        for number, (group, scale) in enumerate(zip(groups, scales, strict=True)):
            upper, lower = top + number * each, top + (number + 1) * each
            shapes.append(_title_axis(self, group, scale, upper + LINE_PX / 2))
            upper += LINE_PX + 4
            last = number == len(groups) - 1
            lower = max(lower if last else lower - _FACET_GAP_PX, upper + 1)
            frame = _match_scales(
                self, Frame(left, upper, right, lower, self.x_limits, scale.left.limits)
            )
            plots.append(frame)
            shapes += _draw_spans(self, group, frame)
            shapes += _draw_axes(frame, scale, group, with_x=last)
            shapes += _draw_strokes(self, group, scale, frame)
        shapes.append(Words((left + right) / 2, bottom + 1.7 * LINE_PX, self.x_label, "middle"))
        return Drawing(self.title, width, height, tuple(shapes), tuple(plots))


@dataclass(frozen=True, slots=True)
class Rule:
    """A straight line of an axis or of the grid, as a shape of a drawing."""

    x1: float
    y1: float
    x2: float
    y2: float
    faint: bool = False


@dataclass(frozen=True, slots=True)
class Words:
    """A line of text, as a shape of a drawing."""

    x: float
    y: float
    """Middle of the letters."""
    text: str
    anchor: str = "start"
    """Anchor at x: `start`, `middle` or `end`."""
    rgb: Rgb | None = None
    """Colour of the text; None for the default one."""
    strong: bool = False


@dataclass(frozen=True, slots=True)
class Shade:
    """A shaded rectangle, as a shape of a drawing."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True, slots=True)
class Stroke:
    """A line through points, or the points themselves, as a shape of a drawing."""

    points: FloatArray
    """Shape (n, 2): x and y."""
    rgb: Rgb
    dots: bool = False


@dataclass(frozen=True, slots=True)
class Raster:
    """Pixels stretched over a rectangle, as a shape of a drawing."""

    x: float
    y: float
    width: float
    height: float
    pixels: npt.NDArray[np.uint8]
    """Shape (rows, columns, 3)."""


Shape: TypeAlias = Rule | Words | Shade | Stroke | Raster


@dataclass(frozen=True, slots=True)
class Drawing:
    """A picture that consists of shapes, with its size in pixels."""

    title: str
    width: int
    height: int
    shapes: tuple[Shape, ...]
    plots: tuple[Frame, ...] = ()
    """The rectangles with the data of a chart, those of facets from the top."""


@dataclass(frozen=True, slots=True)
class Frame:
    """The rectangle of a chart in which data are drawn, in pixels, and the limits of its axes."""

    left: float
    top: float
    right: float
    bottom: float
    x: Limits
    y: Limits

    def find_xs(self, values: FloatArray | float) -> FloatArray:
        """Return where values of x are in the picture: in pixels from its left edge."""
        return np.asarray(
            self.left
            + (np.asarray(values) - self.x[0]) / (self.x[1] - self.x[0]) * (self.right - self.left)
        )

    def find_ys(self, values: FloatArray | float) -> FloatArray:
        """Return where values of y are in the picture: in pixels from its upper edge."""
        return np.asarray(
            self.bottom
            - (np.asarray(values) - self.y[0]) / (self.y[1] - self.y[0]) * (self.bottom - self.top)
        )

    def replace_y(self, limits: Limits) -> Frame:
        """Return a frame with the same rectangle and other limits of y."""
        return Frame(self.left, self.top, self.right, self.bottom, self.x, limits)


def _title_axis(chart: ChartData, lines: Sequence[Line], scales: Scales, y: float) -> Words:
    """Return the title above a vertical axis, such as its unit.

    In a chart of several facets, each of which has one line, the title is the name of that line.
    """
    if chart.facets:
        return Words(PAD, y, lines[0].label, rgb=find_color(lines[0]), strong=True)
    return Words(PAD, y, scales.left.title)


def cut_drawing(drawing: Drawing, x: float) -> Drawing:
    """Return the picture of a chart with a vertical line at a value of x, and without the data to its right."""
    shapes: list[Shape] = []
    for shape in drawing.shapes:
        plot = next((plot for plot in drawing.plots if _is_inside(shape, plot)), None)
        if isinstance(shape, Stroke) and plot is not None:
            points = shape.points[shape.points[:, 0] <= float(plot.find_xs(x)) + _EDGE_PX]
            if len(points):
                shapes.append(replace(shape, points=points, dots=shape.dots or len(points) == 1))
        else:
            shapes.append(shape)
    for plot in drawing.plots:
        end_px = float(plot.find_xs(x))
        shapes.append(Rule(end_px, plot.top, end_px, plot.bottom))
    return replace(drawing, shapes=tuple(shapes))


_EDGE_PX = 0.5
"""Tolerance for points at the edge of a plot."""


def _is_inside(shape: Shape, plot: Frame) -> bool:
    if not isinstance(shape, Stroke):
        return False
    rows = shape.points[:, 1]
    return bool(rows.min() >= plot.top - _EDGE_PX and rows.max() <= plot.bottom + _EDGE_PX)


def move_shapes(drawing: Drawing, right_px: float, down_px: float) -> list[Shape]:
    """Return the shapes of a picture, moved to the right and down by a number of pixels."""
    shapes: list[Shape] = []
    for shape in drawing.shapes:
        match shape:
            case Stroke():
                shapes.append(replace(shape, points=shape.points + np.array([right_px, down_px])))
            case Rule():
                ends = (
                    shape.x1 + right_px,
                    shape.y1 + down_px,
                    shape.x2 + right_px,
                    shape.y2 + down_px,
                )
                shapes.append(Rule(*ends, shape.faint))
            case _:
                shapes.append(replace(shape, x=shape.x + right_px, y=shape.y + down_px))
    return shapes


def find_color(line: Line) -> Rgb:
    """Return the colour in which a line of a chart is drawn."""
    return COLORS[line.number % len(COLORS)]


def shorten(text: str, width_px: float) -> str:
    """Return a text cut to a width in pixels; one that was cut ends in an ellipsis."""
    max_letters = max(int(width_px / LETTER_PX), 1)
    return text if len(text) <= max_letters else text[: max_letters - 1] + "…"


def _measure_right_width(scales: Scales) -> float:
    return sum(_measure_widest(scale.limits) + _SCALE_GAP_PX for scale in scales.right)


def _draw_legend(
    lines: Sequence[Line], scales: Scales, width: int, top: float
) -> tuple[list[Shape], int]:
    """Return the shapes of a chart's legend, and how many rows it has.

    Each line of the chart has a stroke and its name there, with a note if a right scale applies to it.

    Args:
        lines: The lines of the chart.
        scales: The scales of the chart.
        width: Width of the chart in pixels.
        top: The upper edge of the legend in pixels.
    """
    shapes: list[Shape] = []
    x = float(PAD)
    row = 0
    for line in lines:
        is_right = scales.find_scale(line.name) is not scales.left
        text = shorten(line.label + (", right scale" if is_right else ""), width - 2 * PAD - 30)
        width_px = 30 + len(text) * LETTER_PX
        if x > PAD and x + width_px > width - PAD:
            x = float(PAD)
            row = row + 1
        y = top + (row + 0.5) * LINE_PX
        shapes.append(Stroke(np.array([[x, y], [x + 22, y]]), find_color(line)))
        shapes.append(Words(x + 28, y, text))
        x += width_px + 14
    return shapes, row + 1 if lines else 0


def _group_lines(lines: Sequence[Line], zoomed: bool) -> Scales:
    return Scales.group([(line.name, line.ys, line.scale) for line in lines], zoomed)


def _measure_widest(limits: Limits) -> float:
    # The number of ticks depends on the height; with twenty, labels are longest.
    return max((len(text) for _, text in label_ticks(limits, 20)), default=1) * LETTER_PX + 8


def _match_scales(chart: ChartData, frame: Frame) -> Frame:
    """Return a frame for a chart; for a path on the field, both axes of the frame have the same mm per pixel."""
    names = [chart.x_label.partition(" (")[0], *(line.name for line in chart.lines)]
    if not chart.path or {find_unit(name) for name in names} != {"mm"}:
        return frame
    width_px, height_px = frame.right - frame.left, frame.bottom - frame.top
    scale = max((frame.x[1] - frame.x[0]) / width_px, (frame.y[1] - frame.y[0]) / height_px)
    limits = []
    for (low, high), size_px in ((frame.x, width_px), (frame.y, height_px)):
        more = (scale * size_px - (high - low)) / 2
        limits.append((low - more, high + more))
    return Frame(frame.left, frame.top, frame.right, frame.bottom, limits[0], limits[1])


def draw_grid(frame: Frame, *, with_x: bool = True) -> list[Shape]:
    """Return the shapes of the grid behind the data, with the labels of the left axis.

    Args:
        frame: The frame.
        with_x: Whether to add the labels of the lower axis.
    """
    shapes: list[Shape] = []
    for value, text in label_ticks(frame.y, _count_labels(frame)):
        y = float(frame.find_ys(value))
        shapes += [
            Rule(frame.left, y, frame.right, y, faint=True),
            Words(frame.left - 6, y, text, "end"),
        ]
    for value, text in label_ticks(frame.x, max(int((frame.right - frame.left) / 90), 2)):
        x = float(frame.find_xs(value))
        shapes.append(Rule(x, frame.top, x, frame.bottom, faint=True))
        if with_x:
            shapes.append(Words(x, frame.bottom + 0.7 * LINE_PX, text, "middle"))
    return shapes


def _count_labels(frame: Frame) -> int:
    return max(int((frame.bottom - frame.top) / 40), 2)


def draw_borders(frame: Frame) -> list[Shape]:
    """Return the lines of the left and the lower axis as shapes."""
    return [
        Rule(frame.left, frame.top, frame.left, frame.bottom),
        Rule(frame.left, frame.bottom, frame.right, frame.bottom),
    ]


def _draw_axes(frame: Frame, scales: Scales, lines: Sequence[Line], *, with_x: bool) -> list[Shape]:
    shapes = draw_grid(frame, with_x=with_x)
    x = frame.right
    for scale in scales.right:
        other = frame.replace_y(scale.limits)
        rgb = (
            next(find_color(line) for line in lines if line.name == scale.names[0])
            if len(scale.names) == 1
            else None
        )
        for value, text in label_ticks(scale.limits, _count_labels(frame)):
            y = float(other.find_ys(value))
            shapes += [Rule(x, y, x + 4, y), Words(x + 7, y, text, rgb=rgb)]
        shapes.append(Words(x, frame.top - LINE_PX / 2 - 4, scale.unit, rgb=rgb))
        shapes.append(Rule(x, frame.top, x, frame.bottom))
        x += _measure_widest(scale.limits) + _SCALE_GAP_PX
    return shapes + draw_borders(frame)


def _draw_strokes(
    chart: ChartData, lines: Sequence[Line], scales: Scales, frame: Frame
) -> list[Shape]:
    shapes: list[Shape] = []
    for line in lines:
        own = frame.replace_y(scales.find_scale(line.name).limits)
        if len(line.xs):
            points = np.column_stack((own.find_xs(line.xs), own.find_ys(line.ys)))
            shapes.append(Stroke(points, find_color(line), dots=chart.marks or len(points) == 1))
    if not shapes:
        shapes.append(
            Words(
                (frame.left + frame.right) / 2,
                (frame.top + frame.bottom) / 2,
                "no samples here",
                "middle",
            )
        )
    return shapes


def _draw_spans(chart: ChartData, lines: Sequence[Line], frame: Frame) -> list[Shape]:
    names = {line.name for line in lines}
    seen = [
        span
        for span in chart.spans
        if span.name in names and frame.x[0] <= span.stop and span.start <= frame.x[1]
    ]
    shades: list[Shade] = []
    for span in seen:
        x1, x2 = (
            float(frame.find_xs(min(max(x, frame.x[0]), frame.x[1])))
            for x in (span.start, span.stop)
        )
        shades.append(Shade(x1, frame.top, x2 - x1, frame.bottom - frame.top))
    texts = fit_names(seen, [shade.width / LETTER_PX for shade in shades])
    words = (
        Words(shade.x + shade.width / 2, frame.bottom - LINE_PX / 2, name, "middle")
        for shade, name in zip(shades, texts, strict=True)
        if name
    )
    return [*shades, *words]


_NARROW = 8
"""Spans of fewer letters do not keep others from their long names."""


def fit_names(spans: Sequence[Span], letters: Sequence[float], overhang: int = 0) -> list[str]:
    """Return a name for each span: the long names of all spans, or the short names of all.

    Long names are used if they fit into all but very narrow spans; a name that does not fit is empty.

    Args:
        spans: The spans.
        letters: The width of each span in letters.
        overhang: By how many letters a short name may be wider than its span.
    """
    rooms = list(zip(spans, letters, strict=True))
    is_long = all(len(span.texts[0]) < room for span, room in rooms if room >= _NARROW)
    names = [
        span.texts[0] if is_long and len(span.texts[0]) < room else span.texts[-1]
        for span, room in rooms
    ]
    return [
        name if room and len(name) <= room + overhang else ""
        for name, room in zip(names, letters, strict=True)
    ]
