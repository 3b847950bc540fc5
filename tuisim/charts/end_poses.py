"""Where many runs ended, over the mat: as a drawing for files, and as text."""

from __future__ import annotations

import math

import numpy as np
from rich.color import Color
from rich.style import Style
from rich.text import Text

from tuisim.charts import axes
from tuisim.charts.axes import Limits
from tuisim.charts.canvas import Curve, canvas
from tuisim.charts.layout import (
    COLORS,
    LETTER_PX,
    LINE_PX,
    PAD,
    Drawing,
    Frame,
    Raster,
    Shape,
    Stroke,
    Words,
    borders_of,
    grid_of,
    shortened,
)
from tuisim.core.css_colors import Rgb
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.data_class import dataclass
from tuisim.errors import counted
from tuisim.runs.arrays import FloatArray
from tuisim.terminal.pixels import Pixels

MOST_GROUPS = 8
"""Groups that can be distinguished by their colours."""

_LEAST_MM = 20.0
"""Least width and height of the part of the field that is drawn."""
_PART = 0.6
"""Poses that take up less of the field's width and height than this are drawn enlarged."""
_MARGIN = 0.15
"""Of what is drawn, beside the poses on each side."""
_STRENGTH = 0.3
"""Of the mat's colours, so that points and lines of any colour are visible on any mat."""
_ELLIPSE = 2.0
"""Size of the ellipses in standard deviations."""
_POINTS = 72
_TICKS_FOR = 1000
"""Most poses whose headings are drawn."""
_TICK_PX = 9.0
_INSET_PX = 150, 73
"""Size of the whole field beside an enlarged part."""
_GREY: Rgb = (120, 120, 120)
MARKS = "●▲■◆○△□◇"
"""Marks of the groups where there are no colours."""


@dataclass(frozen=True, slots=True)
class PoseGroup:
    """End poses of runs that have something in common."""

    label: str
    """Empty if there is one group only."""
    x_mm: FloatArray
    """Shape (n,), finite, as are the others."""
    y_mm: FloatArray
    heading_deg: FloatArray

    def in_words(self) -> str:
        """Return its label, mean and standard deviation."""
        if not len(self.x_mm):
            return f"{self.label}: none".removeprefix(": ")
        spread = [self.x_mm.std(), self.y_mm.std()]
        figures = f"x {self.x_mm.mean():.1f} ± {spread[0]:.1f}, y {self.y_mm.mean():.1f} ± {spread[1]:.1f} mm"
        return f"{self.label}: {figures}".removeprefix(": ")


@dataclass(frozen=True, slots=True)
class EndPoses:
    """The end poses of a batch."""

    title: str
    mat: Pixels
    """One pixel for each mm."""
    groups: tuple[PoseGroup, ...]

    def limits(self) -> tuple[Limits, Limits]:
        """Return the part of the field to be drawn, in mm: the whole field, or the surroundings of close poses."""
        xs = np.concatenate([group.x_mm for group in self.groups])
        ys = np.concatenate([group.y_mm for group in self.groups])
        if not len(xs):
            return (0.0, FIELD_WIDTH_MM), (0.0, FIELD_HEIGHT_MM)
        width = max(float(np.ptp(xs)), _LEAST_MM) * (1 + 2 * _MARGIN)
        height = max(float(np.ptp(ys)), _LEAST_MM) * (1 + 2 * _MARGIN)
        if width > _PART * FIELD_WIDTH_MM or height > _PART * FIELD_HEIGHT_MM:
            return (0.0, FIELD_WIDTH_MM), (0.0, FIELD_HEIGHT_MM)
        x, y = float(xs.min() + xs.max()) / 2, float(ys.min() + ys.max()) / 2
        return (x - width / 2, x + width / 2), (y - height / 2, y + height / 2)

    def outside(self) -> int:
        """Return how many poses are not on the field."""
        return sum(
            int(
                (
                    (each.x_mm < 0)
                    | (each.x_mm > FIELD_WIDTH_MM)
                    | (each.y_mm < 0)
                    | (each.y_mm > FIELD_HEIGHT_MM)
                ).sum()
            )
            for each in self.groups
        )

    def note(self) -> str:
        """Return what a reader needs to know beside the picture; empty for nothing."""
        outside = self.outside()
        return f"{counted(outside, 'run')} ended off the field" if outside else ""

    def is_enlarged(self) -> bool:
        """Return whether only a part of the field is drawn."""
        (left, right), _ = self.limits()
        return right - left < FIELD_WIDTH_MM


def _proportioned(limits: tuple[Limits, Limits], wide_per_high: float) -> tuple[Limits, Limits]:
    """Enlarge an area to a ratio of width to height, about its middle."""
    (left, right), (low, high) = limits
    width, height = right - left, high - low
    more_x = max(height * wide_per_high - width, 0.0) / 2
    more_y = max(width / wide_per_high - height, 0.0) / 2
    return (left - more_x, right + more_x), (low - more_y, high + more_y)


def _color(number: int) -> Rgb:
    return COLORS[(number + 1) % len(COLORS)] if number else COLORS[6]


def drawing_of_poses(poses: EndPoses, width: int, height: int) -> Drawing:
    """Return a drawing of end poses over the mat, in a size in pixels; equal scales on both axes."""
    shapes: list[Shape] = [
        Words(PAD, PAD + LINE_PX / 2, shortened(poses.title, width - 2 * PAD), strong=True)
    ]
    top = PAD + LINE_PX + 4.0
    for number, group in enumerate(poses.groups):
        text = shortened(
            f"{group.in_words()} ({counted(len(group.x_mm), 'run')})", width - 2 * PAD - 16
        )
        shapes.append(Stroke(np.array([[PAD + 5.0, top + LINE_PX / 2]]), _color(number), dots=True))
        shapes.append(Words(PAD + 16, top + LINE_PX / 2, text))
        top += LINE_PX
    ellipses = f"ellipses: {_ELLIPSE:g} standard deviations"
    shapes.append(
        Words(PAD + 16, top + LINE_PX / 2, "; ".join(filter(None, (ellipses, poses.note()))))
    )
    top += LINE_PX
    if poses.is_enlarged():
        top = max(top, PAD + _INSET_PX[1])
    area = PAD + 5 * LETTER_PX + 8, top + 6, width - PAD - 2 * LETTER_PX, height - PAD - 2 * LINE_PX
    frame = _fitted(area, poses.limits())
    shapes.append(_mat(poses.mat, frame))
    shapes += grid_of(frame) + borders_of(frame)
    # The first group, which often has the least spread, is on top.
    for number, group in reversed([*enumerate(poses.groups)]):
        shapes += _marks(group, frame, _color(number))
    if poses.is_enlarged():
        shapes += _inset(poses.mat, frame, width - PAD - _INSET_PX[0])
    shapes.append(
        Words((frame.left + frame.right) / 2, frame.bottom + 1.7 * LINE_PX, "x_mm, y_mm", "middle")
    )
    return Drawing(poses.title, width, height, tuple(shapes))


def _fitted(area: tuple[float, float, float, float], limits: tuple[Limits, Limits]) -> Frame:
    """Return the largest frame with equal scales inside an area; a part of the field fills all of it."""
    left, top, right, bottom = area
    right, bottom = max(right, left + 10), max(bottom, top + 10)
    (low_x, high_x), (low_y, high_y) = limits
    if (high_x - low_x) < FIELD_WIDTH_MM:
        return Frame(
            left, top, right, bottom, *_proportioned(limits, (right - left) / (bottom - top))
        )
    px_per_mm = min((right - left) / (high_x - low_x), (bottom - top) / (high_y - low_y))
    return Frame(
        left, top, left + px_per_mm * (high_x - low_x), top + px_per_mm * (high_y - low_y), *limits
    )


def _mat(mat: Pixels, frame: Frame) -> Raster:
    """Return the part of the mat in a frame, one pixel for each pixel or mm; grey beside the field."""
    columns = max(round(frame.right - frame.left), 1)
    rows = max(round(frame.bottom - frame.top), 1)
    return Raster(
        frame.left,
        frame.top,
        frame.right - frame.left,
        frame.bottom - frame.top,
        mat_cells(mat, frame.x, frame.y, columns, rows),
    )


def _inset(mat: Pixels, frame: Frame, left: float) -> list[Shape]:
    """Return the whole mat in small, with a rectangle around the part that is drawn."""
    small = Frame(
        left,
        PAD,
        left + _INSET_PX[0],
        PAD + _INSET_PX[1],
        (0, FIELD_WIDTH_MM),
        (0, FIELD_HEIGHT_MM),
    )
    field = (0.0, float(FIELD_WIDTH_MM)), (0.0, float(FIELD_HEIGHT_MM))
    pixels = mat_cells(mat, *field, *(2 * side for side in _INSET_PX))
    shapes: list[Shape] = [Raster(small.left, small.top, *_INSET_PX, pixels)]
    shapes += _outline(small.left, small.top, small.right, small.bottom, _GREY)
    x, y = (
        np.clip(limits, 0, most)
        for limits, most in zip((frame.x, frame.y), (FIELD_WIDTH_MM, FIELD_HEIGHT_MM), strict=True)
    )
    (x1, x2), (y1, y2) = small.xs(x).tolist(), small.ys(y).tolist()
    return [*shapes, *_outline(x1, y2, x2, y1, COLORS[6])]


def _outline(left: float, top: float, right: float, bottom: float, rgb: Rgb) -> list[Shape]:
    corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]]
    return [Stroke(np.array(corners, np.float64), rgb)]


def mat_cells(mat: Pixels, x: Limits, y: Limits, columns: int, rows: int) -> Pixels:
    """Return a part of the mat, lightened, with each pixel read at its middle; grey beside the field.

    Returns:
        Shape (rows, columns, 3), rows from the top.
    """
    at_x = np.floor(x[0] + (np.arange(columns) + 0.5) / columns * (x[1] - x[0])).astype(int)
    at_y = np.floor(FIELD_HEIGHT_MM - y[1] + (np.arange(rows) + 0.5) / rows * (y[1] - y[0])).astype(
        int
    )
    inside_x, inside_y = (at_x >= 0) & (at_x < mat.shape[1]), (at_y >= 0) & (at_y < mat.shape[0])
    found = mat[np.clip(at_y, 0, mat.shape[0] - 1)][:, np.clip(at_x, 0, mat.shape[1] - 1)].astype(
        float
    )
    found = 255 - (255 - found) * _STRENGTH
    found[~(inside_y[:, None] & inside_x[None, :])] = 160
    return np.asarray(np.rint(found), np.uint8)


def _marks(group: PoseGroup, frame: Frame, rgb: Rgb) -> list[Shape]:
    """Return points with their headings, and the ellipse about them."""
    on = (group.x_mm >= frame.x[0]) & (group.x_mm <= frame.x[1])
    on &= (group.y_mm >= frame.y[0]) & (group.y_mm <= frame.y[1])
    columns, rows = frame.xs(group.x_mm[on]), frame.ys(group.y_mm[on])
    shapes: list[Shape] = []
    if 0 < len(columns) <= _TICKS_FOR:
        turn = np.radians(group.heading_deg[on])
        for x, y, dx, dy in zip(columns, rows, np.cos(turn), np.sin(turn), strict=True):
            shapes.append(Stroke(np.array([[x, y], [x + _TICK_PX * dx, y - _TICK_PX * dy]]), rgb))
    if len(columns):
        shapes.append(Stroke(np.column_stack((columns, rows)), rgb, dots=True))
    if len(group.x_mm) > 2:
        outline = _ellipse(group)
        shapes.append(Stroke(np.column_stack((frame.xs(outline[0]), frame.ys(outline[1]))), rgb))
    return shapes


def _ellipse(group: PoseGroup) -> FloatArray:
    """Return the outline that covers the given number of standard deviations, shape (2, n)."""
    values, vectors = np.linalg.eigh(np.cov(group.x_mm, group.y_mm))
    angle = np.linspace(0.0, 2 * math.pi, _POINTS + 1)
    circle = np.vstack((np.cos(angle), np.sin(angle)))
    middle = np.array([[group.x_mm.mean()], [group.y_mm.mean()]])
    return np.asarray(
        middle + vectors @ (np.sqrt(np.maximum(values, 0.0))[:, None] * circle) * _ELLIPSE
    )


def text_of_poses(poses: EndPoses, width: int, height: int, *, colors: bool) -> Text:
    """Return end poses as text of a given size in characters; with colours over the mat, else without it.

    Args:
        colors: Whether colours distinguish the groups; otherwise marks do.
    """
    several = len(poses.groups) > 1
    lines = [Text(poses.title, "bold")]
    for number, group in enumerate(poses.groups):
        mark = MARKS[number % len(MARKS)] if several and not colors else "•"
        style = Style(color=Color.from_rgb(*_color(number))) if colors else Style()
        lines.append(Text.assemble((f"{mark} ", style), group.in_words()))
    enlarged = "a part of the field" if poses.is_enlarged() else ""
    if note := "; ".join(filter(None, (enlarged, poses.note()))):
        lines.append(Text(note))
    rows = max(height - len(lines) - 2, 4)
    limits = poses.limits()
    # A character is about twice as high as wide.
    limits = _proportioned(limits, (width - 7) / (2 * rows))
    whole = limits[0][1] - limits[0][0] >= FIELD_WIDTH_MM
    labels = axes.row_labels(limits[1], rows)
    left = max(map(len, labels.values()), default=0) + 1
    columns = max(width - left, 2)
    if whole:
        rows = min(rows, math.ceil(columns / 2 * FIELD_HEIGHT_MM / FIELD_WIDTH_MM))
        limits = (0.0, FIELD_WIDTH_MM), (0.0, FIELD_HEIGHT_MM)
        labels = axes.row_labels(limits[1], rows)
    lines += _framed(poses, limits, columns, rows, labels, left, colors)
    for line in lines:
        line.truncate(width)
    return Text("\n").join(lines)


def _framed(
    poses: EndPoses,
    limits: tuple[Limits, Limits],
    columns: int,
    rows: int,
    labels: dict[int, str],
    left: int,
    colors: bool,
) -> list[Text]:
    several = len(poses.groups) > 1 and not colors
    curves = [
        Curve(
            group.x_mm[on],
            group.y_mm[on],
            _color(number),
            MARKS[number % len(MARKS)],
            rising=False,
            joined=False,
        )
        for number, group in enumerate(poses.groups)
        if (on := _visible(group, limits)).any()
    ]
    if not several:
        curves = [
            Curve(one.times_s, one.values, one.rgb, rising=False, joined=False) for one in curves
        ]
    # What is drawn last is on top: the first group.
    drawn = canvas(curves[::-1], columns, rows, *limits)
    halves = mat_cells(poses.mat, *limits, columns, 2 * rows).tolist() if colors else None
    lines = []
    for row in range(rows):
        text = labels.get(row, "")
        line = Text(text.rjust(left - 1) + ("┤" if text else "│"))
        column = 0
        for part, rgb in drawn[row]:
            for letter in part:
                if halves is None:
                    line.append(letter)
                else:
                    upper, lower = halves[2 * row][column], halves[2 * row + 1][column]
                    if rgb is None or letter == " ":
                        line.append(
                            "▀", Style(color=Color.from_rgb(*upper), bgcolor=Color.from_rgb(*lower))
                        )
                    else:
                        ground = (
                            (one + other) // 2 for one, other in zip(upper, lower, strict=True)
                        )
                        line.append(
                            letter,
                            Style(color=Color.from_rgb(*rgb), bgcolor=Color.from_rgb(*ground)),
                        )
                column += 1
        lines.append(line)
    axis, below = axes.time_axis(limits[0], columns, "mm")
    return [*lines, Text(" " * (left - 1) + "└" + axis), Text(" " * left + below)]


def _visible(group: PoseGroup, limits: tuple[Limits, Limits]) -> FloatArray:
    (low_x, high_x), (low_y, high_y) = limits
    return np.asarray(
        (group.x_mm >= low_x)
        & (group.x_mm <= high_x)
        & (group.y_mm >= low_y)
        & (group.y_mm <= high_y)
    )
