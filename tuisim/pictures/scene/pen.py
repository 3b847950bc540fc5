"""The trace that the pen has drawn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby
from typing import Any

import numpy as np
import numpy.typing as npt

from tuisim.base.data_class import dataclass
from tuisim.engine.core.css_colors import Rgb, parse_css_rgb
from tuisim.engine.core.spec import PenSpec, RobotSpec, RunSpec
from tuisim.engine.core.tick_record import FLAG_PEN_DOWN
from tuisim.engine.runs.arrays import FloatArray, compute_world_points_mm, number_members
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import Pixels

_LUMA = np.array([0.299, 0.587, 0.114])
_APART = 130.0
_GREY_APART = 90.0
"""Least difference of a line from the ground: as a distance of colours, and of their brightness."""


def choose_pen_rgb(ground: Pixels, rgb: Rgb, grey: bool = False) -> Pixels:
    """Return a colour for each pixel of a line: the line's own, or where that is hard to see, a darker or lighter one.

    Args:
        ground: The pixels below the line, shape (n, 3).
        rgb: Colour of the line.
        grey: Whether the terminal shows only brightness.
    """
    line = np.array(rgb, np.float64)
    if grey:
        vanishes = np.abs(ground @ _LUMA - line @ _LUMA) < _GREY_APART
    else:
        vanishes = np.square(ground - line).sum(axis=1) < _APART**2
    visible = np.repeat(line[None], len(ground), axis=0)
    is_light = (ground @ _LUMA > 127)[:, None]
    visible[vanishes] = np.where(is_light, line * 0.3, line * 0.3 + 178)[vanishes]
    pixels: Pixels = np.rint(visible).astype(np.uint8)
    return pixels


_LONGEST_STEP_MM = 250.0
"""Two trace points further apart are not joined: the robot was placed elsewhere."""


def trace_pixels(
    view: Viewport, xs_mm: FloatArray, ys_mm: FloatArray, width_mm: float
) -> tuple[FloatArray, ...]:
    """Return the pixels of a picture that a pen trace covers.

    Args:
        view: The visible part of the field.
        xs_mm: World x of the points in order, shape (n,); NaN lifts the pen.
        ys_mm: World y of the points, shape (n,).
        width_mm: Width of the pen; at least one pixel is drawn.

    Returns:
        Rows and columns, each shape (m,), whole numbers inside the picture, possibly repeated.
    """
    xs, ys = _join_points(xs_mm, ys_mm, view.mm_per_px / 2)
    cols = (xs - view.left_mm) / view.mm_per_px
    rows = (view.top_mm - ys) / view.mm_per_row
    across = _spread(width_mm / view.mm_per_px)
    down = _spread(width_mm / view.mm_per_row)
    cols = np.floor(cols[:, None, None] + across[None, :, None] + 0 * down[None, None, :]).ravel()
    rows = np.floor(rows[:, None, None] + 0 * across[None, :, None] + down[None, None, :]).ravel()
    inside = (cols >= 0) & (cols < view.width_px) & (rows >= 0) & (rows < view.height_px)
    return rows[inside].astype(np.intp), cols[inside].astype(np.intp)


def _spread(width_px: float) -> FloatArray:
    """Return the offsets in pixels, from the middle of a line, of the pixels across it."""
    count = max(1, round(width_px))
    return np.arange(count, dtype=np.float64) - (count - 1) / 2


def _join_points(xs: FloatArray, ys: FloatArray, step_mm: float) -> tuple[FloatArray, FloatArray]:
    """Return the points of a trace without NaN, and further points between any two of them that the pen has joined.

    The further points are at most `step_mm` apart; they follow all others. Points more than `_LONGEST_STEP_MM` apart
    are not joined.
    """
    good = np.isfinite(xs) & np.isfinite(ys)
    if len(xs) < 2:
        return xs[good], ys[good]
    lengths = np.hypot(np.diff(xs), np.diff(ys))
    drawn = np.isfinite(lengths) & (lengths <= _LONGEST_STEP_MM) & (lengths > step_mm)
    starts = np.flatnonzero(drawn)
    counts = np.ceil(lengths[starts] / step_mm).astype(np.intp)
    if not len(starts):
        return xs[good], ys[good]
    step, number = number_members(counts)
    which = starts[step]
    share = number / counts[step]
    between_x = xs[which] + share * (xs[which + 1] - xs[which])
    between_y = ys[which] + share * (ys[which + 1] - ys[which])
    return np.concatenate((xs[good], between_x)), np.concatenate((ys[good], between_y))


_FALLBACK = "red"


def parse_pen_color(color: str) -> Rgb:
    """Return the colour of a pen, given as a CSS name or `#rrggbb`; anything else is red."""
    rgb = parse_css_rgb(color) or parse_css_rgb(_FALLBACK)
    assert rgb is not None
    return rgb


@dataclass(frozen=True, slots=True)
class Piece:
    """A part of the pen trace, drawn with one pen."""

    xs_mm: FloatArray
    """World x of the points, shape (n,); NaN lifts the pen."""
    ys_mm: FloatArray
    rgb: Rgb
    width_mm: float

    @classmethod
    def from_points(cls, xs_mm: FloatArray, ys_mm: FloatArray, pen: PenSpec) -> Piece:
        """Return a piece of a trace with the points at which a pen has drawn.

        Args:
            xs_mm, ys_mm: World x and y of the points, each of shape (n,); NaN where the pen is up.
            pen: The pen.
        """
        return cls(xs_mm, ys_mm, parse_pen_color(pen.color), pen.width_mm)

    @classmethod
    def from_run(cls, spec: RunSpec, telemetry: npt.NDArray[Any]) -> Piece:
        """Return the pen trace of a run, from the records of `engine.runs.views.TelemetryView.array`."""
        xs_mm, ys_mm, _ = place_drawn_mm(spec.robot, telemetry)
        # Damaged records may have no valid pose.
        far = (np.abs(xs_mm) >= FAR_MM) | (np.abs(ys_mm) >= FAR_MM)
        xs_mm[far] = ys_mm[far] = np.nan
        places = np.nan_to_num(np.round(np.stack((xs_mm, ys_mm)) / _FINE_MM), nan=FAR_MM)
        moved = np.any(np.diff(places, axis=1, prepend=np.nan) != 0, axis=0)
        # The last point before a move is needed, too: it ends a line.
        needed = moved | np.append(moved[1:], True)
        return cls.from_points(xs_mm[needed], ys_mm[needed], spec.robot.pen)

    def lift(self) -> Piece:
        """Return the piece with NaN as its first point, so that it is not joined to the piece before it."""
        return replace(
            self, xs_mm=np.insert(self.xs_mm, 0, np.nan), ys_mm=np.insert(self.ys_mm, 0, np.nan)
        )

    @property
    def pen(self) -> tuple[Rgb, float]:
        """The colour and the width in mm of the pen."""
        return self.rgb, self.width_mm


class PenTrace:
    """The trace that the pen has drawn since it was last cleared, in pieces."""

    def __init__(self) -> None:
        self._pieces: list[Piece] = []
        self.count = 0
        """Number of points ever added; grows with every change but clearing."""
        self.clears = 0
        """How often the trace was cleared."""

    def add(self, piece: Piece) -> None:
        """Add a piece; its points are joined to those of the piece before if the pen is the same."""
        if not len(piece.xs_mm):
            return
        self.count += len(piece.xs_mm)
        if self._pieces and self._pieces[-1].pen == piece.pen:
            last = self._pieces[-1]
            xs_mm = np.concatenate((last.xs_mm[-1:], piece.xs_mm))
            piece = replace(
                piece, xs_mm=xs_mm, ys_mm=np.concatenate((last.ys_mm[-1:], piece.ys_mm))
            )
        self._pieces.append(piece)

    def clear(self) -> list[Piece]:
        """Remove all pieces, and return them."""
        pieces = self._pieces
        self._pieces = []
        self.clears += 1
        return pieces

    def put_back(self, pieces: list[Piece]) -> None:
        """Insert pieces of a cleared trace before all other pieces; painters then draw the whole trace again."""
        self._pieces[:0] = pieces
        self.clears += 1

    def iterate_pieces(self, first: int) -> Iterator[Piece]:
        """Yield the pieces of the trace from index `first` on."""
        return iter(self._pieces[first:])

    def __len__(self) -> int:
        return len(self._pieces)

    def join(self) -> None:
        """Merge consecutive pieces of the same pen, so that they are drawn in one step."""
        joined = []
        for (rgb, width_mm), alike in groupby(self._pieces, key=lambda piece: piece.pen):
            pieces = list(alike)
            xs_mm, ys_mm = (
                np.concatenate(parts)
                for parts in zip(*((p.xs_mm, p.ys_mm) for p in pieces), strict=True)
            )
            joined.append(Piece(xs_mm, ys_mm, rgb, width_mm))
        self._pieces = joined


def place_pen_mm(robot: RobotSpec, telemetry: npt.NDArray[Any]) -> tuple[FloatArray, FloatArray]:
    """Return x and y of the pen in mm in the world at each record, also where it is up, each of shape (n,)."""
    return compute_world_points_mm(telemetry, robot.pen.x_mm, robot.pen.y_mm)


def place_drawn_mm(
    robot: RobotSpec, telemetry: npt.NDArray[Any]
) -> tuple[FloatArray, FloatArray, npt.NDArray[np.bool_]]:
    """Return x and y of the pen in mm at each record, NaN where the pen is up; and whether the pen is up.

    Each has shape (n,).
    """
    xs_mm, ys_mm = place_pen_mm(robot, telemetry)
    lifted = (telemetry["flags"] & FLAG_PEN_DOWN) == 0
    xs_mm[lifted] = ys_mm[lifted] = np.nan
    return xs_mm, ys_mm, lifted


FAR_MM = 1e5
"""What is drawn farther from the field is left out: the time for a line grows with its length."""
_FINE_MM = 1.0
"""Accuracy of the points of a trace: in most ticks the pen moves less."""
