"""Lines of some width: straight pieces with round or pointed corners, and lines whose width changes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Literal

from shapes import Floats, Mask, Point, Shape, disc, polygon, union

WidePoint = tuple[float, float, float]
"""x, y, and the width of the line there."""


def bent(points: Sequence[Point], steps: int = 5) -> list[Point]:
    """Return a smooth line from the first point to the last, in straight pieces.

    Args:
        points: Three or more; the line bends towards those between the ends, and touches
            the middles between them.
        steps: Pieces for each of the points between the ends.
    """
    middles = [((x1 + x2) / 2, (y1 + y2) / 2) for (x1, y1), (x2, y2) in pairwise(points)]
    stations = [points[0], *middles[1:-1], points[-1]]
    line = [stations[0]]
    for ((x1, y1), (x2, y2)), (bx, by) in zip(pairwise(stations), points[1:-1], strict=True):
        for step in range(1, steps + 1):
            t = step / steps
            near, middle, far = (1 - t) ** 2, 2 * t * (1 - t), t**2
            line.append((near * x1 + middle * bx + far * x2, near * y1 + middle * by + far * y2))
    return line


def _piece(start: WidePoint, end: WidePoint) -> Shape:
    """A straight piece between two points, cut square at its ends."""
    (x1, y1, width1), (x2, y2, width2) = start, end
    length = math.hypot(x2 - x1, y2 - y1)
    across, down = (y1 - y2) / length / 2, (x2 - x1) / length / 2
    return polygon(
        [
            (x1 + across * width1, y1 + down * width1),
            (x2 + across * width2, y2 + down * width2),
            (x2 - across * width2, y2 - down * width2),
            (x1 - across * width1, y1 - down * width1),
        ]
    )


def _mitre(before: Point, corner: Point, after: Point, width: float) -> Shape:
    """The kite that fills the outer side of a corner between two lines."""
    away1 = math.atan2(corner[1] - before[1], corner[0] - before[0])
    away2 = math.atan2(after[1] - corner[1], after[0] - corner[0])
    turn = math.remainder(away2 - away1, math.tau)
    side = -math.copysign(math.pi / 2, turn)
    tip = width / 2 / math.cos(turn / 2)
    arms = [(away1 + side, width / 2), (away1 + turn / 2 + side, tip), (away2 + side, width / 2)]
    return polygon(
        [corner, *((corner[0] + math.cos(a) * r, corner[1] + math.sin(a) * r) for a, r in arms)]
    )


def stroke(
    points: Sequence[Point], width: float, join: Literal["round", "miter"] = "round"
) -> Shape:
    """Return a line of constant width along straight pieces, cut square at both ends.

    Args:
        points: The middle of the line, two or more, each unlike the one before.
        width: Its width.
        join: What a corner looks like from outside.
    """
    parts = [_piece((*start, width), (*end, width)) for start, end in pairwise(points)]
    for before, corner, after in zip(points, points[1:], points[2:], strict=False):
        parts.append(
            disc(corner, width / 2) if join == "round" else _mitre(before, corner, after, width)
        )
    return union(parts)


def closed_line(points: Sequence[WidePoint]) -> Shape:
    """Return a line that comes back to its first point, its width changing evenly along each piece."""
    pieces = [_piece(start, end) for start, end in pairwise([*points, points[0]])]
    return union([*pieces, *(disc((x, y), width / 2) for x, y, width in points)])


def pen_line(points: Sequence[Point], pen_width: float, pen_height: float) -> Shape:
    """Return what an elliptic pen leaves along straight pieces, rounded at both ends."""
    return union([_pen_piece(start, end, pen_width, pen_height) for start, end in pairwise(points)])


def _pen_piece(start: Point, end: Point, pen_width: float, pen_height: float) -> Shape:
    (x1, y1), (x2, y2) = start, end
    # Measured in pens, the pen is a circle.
    dx, dy = (x2 - x1) / pen_width, (y2 - y1) / pen_height
    length2 = dx * dx + dy * dy

    def inside(x: Floats, y: Floats) -> Mask:
        across, down = (x - x1) / pen_width, (y - y1) / pen_height
        along = ((across * dx + down * dy) / length2).clip(0.0, 1.0) if length2 else 0.0
        found: Mask = (across - along * dx) ** 2 + (down - along * dy) ** 2 <= 0.25
        return found

    half_x, half_y = pen_width / 2, pen_height / 2
    return Shape(
        (min(x1, x2) - half_x, min(y1, y2) - half_y, max(x1, x2) + half_x, max(y1, y2) + half_y),
        inside,
    )
