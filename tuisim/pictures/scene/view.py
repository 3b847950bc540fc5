"""Views: which part of the field a picture shows, and in which scale."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from tuisim.base.data_class import dataclass
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.terminal.pixels import CellPoints

SQUARE = CellPoints()
"""Two square pixels, one above the other."""


_KEEP_INSIDE = 0.22
"""A following view moves once the robot is nearer to an edge than this share of its size."""
_KEEP_ON_FLOOR = 0.15
"""The same for a view of the size of the field, once the robot has left the field."""


class Area(NamedTuple):
    """A rectangle of the world, in mm."""

    left: float
    lower: float
    right: float
    upper: float

    @property
    def size_mm(self) -> tuple[float, float]:
        """Width and height of the area."""
        return self.right - self.left, self.upper - self.lower


FIELD = Area(0.0, 0.0, float(FIELD_WIDTH_MM), float(FIELD_HEIGHT_MM))


@dataclass(frozen=True, slots=True)
class Viewport:
    """The part of the world that a picture shows, and the size of the picture in pixels."""

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
        """The height of a pixel of the picture in mm."""
        return self.mm_per_px * self.cell.tall

    @property
    def extent_mm(self) -> tuple[float, float, float, float]:
        """The edges of the picture in mm: left and right as world x, lower and upper as world y.

        The order is that of matplotlib's `extent`.
        """
        right_mm, lower_mm = self.to_mm(self.width_px, self.height_px)
        return self.left_mm, right_mm, lower_mm, self.top_mm

    def to_px(self, x_mm: float, y_mm: float) -> tuple[float, float]:
        """Return the column and row of the picture at a world point; whole numbers are pixel corners."""
        return (x_mm - self.left_mm) / self.mm_per_px, (self.top_mm - y_mm) / self.mm_per_row

    def to_mm(self, col_px: float, row_px: float) -> tuple[float, float]:
        """Return the world point, in mm, of a column and row of the picture; whole numbers are pixel corners."""
        return self.left_mm + col_px * self.mm_per_px, self.top_mm - row_px * self.mm_per_row

    @staticmethod
    def fit_field(
        width_px: int, height_px: int, cell: CellPoints = SQUARE, area: Area = FIELD
    ) -> Viewport:
        """Return the viewport that shows an area, centred, in a picture of a given size (each at least 1)."""
        mm_per_px = _fit_mm_per_px(width_px, height_px, cell, area)
        middle = (area.left + area.right) / 2, (area.lower + area.upper) / 2
        return _center_view(width_px, height_px, mm_per_px, *middle, cell)


def follow_robot(
    width_px: int,
    height_px: int,
    zoom: int,
    pose: Pose,
    previous: Viewport | None,
    cell: CellPoints = SQUARE,
    *,
    on_floor: bool = False,
) -> Viewport:
    """Return a viewport in which the robot is visible.

    The view stays still until the robot comes near an edge, and then jumps so that the robot is in the middle again: a
    picture that moved all the time would have to be sent completely in each frame.

    Args:
        width_px: Width of the picture, at least 1.
        height_px: Height of the picture, at least 1.
        zoom: How much the field is enlarged; 1 shows the whole field, and does not move while the robot is on it.
        pose: The pose of the robot.
        previous: The viewport of the last frame, if any.
        cell: The pixels in a character cell.
        on_floor: Whether the robot may leave the field: then the view follows it off the field, by thirds of its size.
    """
    on_field = 0 <= pose.x_mm <= FIELD_WIDTH_MM and 0 <= pose.y_mm <= FIELD_HEIGHT_MM
    if zoom == 1 and (on_field or not on_floor):
        return Viewport.fit_field(width_px, height_px, cell)
    mm_per_px = _fit_mm_per_px(width_px, height_px, cell) / zoom
    same_scale = (
        previous is not None
        and (previous.width_px, previous.height_px, previous.cell) == (width_px, height_px, cell)
        and math.isclose(previous.mm_per_px, mm_per_px)
    )
    basis = previous if same_scale else None
    if on_floor:
        at_mm = (pose.x_mm, pose.y_mm) if zoom > 1 else (FIELD_WIDTH_MM / 2, FIELD_HEIGHT_MM / 2)
        basis = basis or _center_view(width_px, height_px, mm_per_px, *at_mm, cell)
        return _shift_view(basis, zoom, pose)
    if basis is not None and _is_well_inside(basis, pose):
        return basis
    x_mm = _clamp_center(pose.x_mm, width_px * mm_per_px, FIELD_WIDTH_MM)
    y_mm = _clamp_center(pose.y_mm, height_px * mm_per_px * cell.tall, FIELD_HEIGHT_MM)
    moved = _center_view(width_px, height_px, mm_per_px, x_mm, y_mm, cell)
    return previous if previous is not None and moved == previous else moved


def _shift_view(view: Viewport, zoom: int, pose: Pose) -> Viewport:
    """Return a view that is moved, by multiples of a third of its size, until the robot is not near its edges."""
    share = _KEEP_ON_FLOOR if zoom == 1 else _KEEP_INSIDE
    col, row = view.to_px(pose.x_mm, pose.y_mm)
    right_px = _count_steps(col, view.width_px, share, view.cell.cols)
    down_px = _count_steps(row, view.height_px, share, view.cell.rows)
    left_mm, top_mm = view.to_mm(right_px, down_px)
    return replace(view, left_mm=left_mm, top_mm=top_mm)


def _count_steps(at_px: float, size_px: int, share: float, cell_px: int) -> int:
    """Return by how many pixels to move a view along an axis, so that a point is not near its edges.

    The result is a multiple of about a third of the size: negative to the left or up, 0 for no move.

    Args:
        at_px: Position of the point in the view.
        size_px: Size of the view.
        share: Share of the size that is near an edge.
        cell_px: Size of a cell; the view moves by whole cells.
    """
    margin_px = size_px * share
    beyond_px = min(at_px - margin_px, 0.0) + max(at_px - (size_px - margin_px), 0.0)
    if not math.isfinite(beyond_px):
        # A damaged record may have no valid pose.
        return 0
    step_px = max(size_px // 3 // cell_px, 1) * cell_px
    return int(math.copysign(math.ceil(abs(beyond_px) / step_px), beyond_px)) * step_px


def _fit_mm_per_px(width_px: int, height_px: int, cell: CellPoints, area: Area = FIELD) -> float:
    wide_mm, high_mm = area.size_mm
    return max(wide_mm / width_px, high_mm / (height_px * cell.tall))


def _center_view(
    width_px: int, height_px: int, mm_per_px: float, x_mm: float, y_mm: float, cell: CellPoints
) -> Viewport:
    # Whole-pixel margins: a field edge that falls between pixels would be a blurred line.
    mm_per_row = mm_per_px * cell.tall
    left_px = round(width_px / 2 - x_mm / mm_per_px)
    top_px = round(height_px / 2 - (FIELD_HEIGHT_MM - y_mm) / mm_per_row)
    left_mm, top_mm = -left_px * mm_per_px, FIELD_HEIGHT_MM + top_px * mm_per_row
    return Viewport(width_px, height_px, mm_per_px, left_mm, top_mm, cell)


def _clamp_center(centre_mm: float, shown_mm: float, field_mm: float) -> float:
    """Return the centre of a view along an axis, moved so that the view shows as little as possible off the field.

    Args:
        centre_mm: The centre.
        shown_mm: Size of the view.
        field_mm: Size of the field.
    """
    if shown_mm >= field_mm:
        return field_mm / 2
    return min(max(centre_mm, shown_mm / 2), field_mm - shown_mm / 2)


def _is_well_inside(view: Viewport, pose: Pose) -> bool:
    col, row = view.to_px(pose.x_mm, pose.y_mm)
    margin_col, margin_row = view.width_px * _KEEP_INSIDE, view.height_px * _KEEP_INSIDE
    # At the edge of the field there is nothing more to show, so the view need not move further.
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
