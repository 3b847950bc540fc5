"""Views: which part of the field a picture shows, and in which scale."""

from __future__ import annotations

import math

from tuisim.core.geometry import Pose
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.data_class import dataclass
from tuisim.terminal.pixels import SQUARE, CellPoints

ZOOMS = (1, 2, 4)
"""Zoom factors, relative to the whole field."""

_KEEP_INSIDE = 0.22
"""A following view moves once the robot is nearer to an edge than this share of its size."""


@dataclass(frozen=True, slots=True)
class Viewport:
    """A picture of part of the field, in the app of character cells."""

    width_px: int
    height_px: int
    mm_per_px: float
    left_mm: float
    """World x of the left edge of the picture."""
    top_mm: float
    """World y of the top edge of the picture."""
    cell: CellPoints = SQUARE

    @property
    def mm_per_row(self) -> float:
        """The height of a pixel."""
        return self.mm_per_px * self.cell.tall

    def to_px(self, x_mm: float, y_mm: float) -> tuple[float, float]:
        """Return the picture column and row of a world point; whole numbers are pixel corners."""
        return (x_mm - self.left_mm) / self.mm_per_px, (self.top_mm - y_mm) / self.mm_per_row

    def to_mm(self, col_px: float, row_px: float) -> tuple[float, float]:
        """Return the world point of a picture position."""
        return self.left_mm + col_px * self.mm_per_px, self.top_mm - row_px * self.mm_per_row


def whole_field(width_px: int, height_px: int, cell: CellPoints = SQUARE) -> Viewport:
    """Return the viewport that shows the whole field, centred, in a picture of that size (each at least 1)."""
    mm_per_px = _fit_mm_per_px(width_px, height_px, cell)
    return _around(width_px, height_px, mm_per_px, FIELD_WIDTH_MM / 2, FIELD_HEIGHT_MM / 2, cell)


def following(
    width_px: int,
    height_px: int,
    zoom: int,
    pose: Pose,
    previous: Viewport | None,
    cell: CellPoints = SQUARE,
) -> Viewport:
    """Return a viewport that keeps the robot visible.

    The view stays still until the robot comes near an edge, and then jumps so that the robot is in the middle again: a
    picture that moved all the time would have to be sent completely in each frame.

    Args:
        width_px: Width of the picture, at least 1.
        height_px: Height of the picture, at least 1.
        zoom: One of `ZOOMS`; 1 shows the whole field and never moves.
        pose: The pose of the robot.
        previous: The viewport of the last frame, if any.
        cell: The pixels in a character cell.
    """
    if zoom == 1:
        return whole_field(width_px, height_px, cell)
    mm_per_px = _fit_mm_per_px(width_px, height_px, cell) / zoom
    same_scale = (
        previous is not None
        and (previous.width_px, previous.height_px, previous.cell) == (width_px, height_px, cell)
        and math.isclose(previous.mm_per_px, mm_per_px)
    )
    if same_scale and previous is not None and _well_inside(previous, pose):
        return previous
    x_mm = _clamped(pose.x_mm, width_px * mm_per_px, FIELD_WIDTH_MM)
    y_mm = _clamped(pose.y_mm, height_px * mm_per_px * cell.tall, FIELD_HEIGHT_MM)
    moved = _around(width_px, height_px, mm_per_px, x_mm, y_mm, cell)
    return previous if previous is not None and moved == previous else moved


def _fit_mm_per_px(width_px: int, height_px: int, cell: CellPoints) -> float:
    return max(FIELD_WIDTH_MM / width_px, FIELD_HEIGHT_MM / (height_px * cell.tall))


def _around(
    width_px: int, height_px: int, mm_per_px: float, x_mm: float, y_mm: float, cell: CellPoints
) -> Viewport:
    # Whole-pixel margins: a field edge that falls between pixels would be a blurred line.
    mm_per_row = mm_per_px * cell.tall
    left_px = round(width_px / 2 - x_mm / mm_per_px)
    top_px = round(height_px / 2 - (FIELD_HEIGHT_MM - y_mm) / mm_per_row)
    left_mm, top_mm = -left_px * mm_per_px, FIELD_HEIGHT_MM + top_px * mm_per_row
    return Viewport(width_px, height_px, mm_per_px, left_mm, top_mm, cell)


def _clamped(centre_mm: float, shown_mm: float, field_mm: float) -> float:
    """Return the centre of a view, clamped so that as little as possible off the field is shown."""
    if shown_mm >= field_mm:
        return field_mm / 2
    return min(max(centre_mm, shown_mm / 2), field_mm - shown_mm / 2)


def _well_inside(view: Viewport, pose: Pose) -> bool:
    col, row = view.to_px(pose.x_mm, pose.y_mm)
    margin_col, margin_row = view.width_px * _KEEP_INSIDE, view.height_px * _KEEP_INSIDE
    # At the edge of the field there is nothing more to show.
    left = view.left_mm <= 0 or col >= margin_col
    right = (
        view.left_mm + view.width_px * view.mm_per_px >= FIELD_WIDTH_MM
        or col <= view.width_px - margin_col
    )
    top = view.top_mm >= FIELD_HEIGHT_MM or row >= margin_row
    bottom = (
        view.top_mm - view.height_px * view.mm_per_row <= 0 or row <= view.height_px - margin_row
    )
    return left and right and top and bottom
