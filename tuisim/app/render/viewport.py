"""The viewport: which part of the field a picture shows, and its scale."""

from __future__ import annotations

import math

from tuisim.charts.world_image import Viewport
from tuisim.core.geometry import Pose
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

ZOOMS = (1, 2, 4)
"""Zoom factors, relative to the whole field."""

_KEEP_INSIDE = 0.22
"""A following view moves once the robot is nearer to an edge than this share of its size."""


def whole_field(width_px: int, height_px: int) -> Viewport:
    """Return the viewport that shows the whole field, centred, in a picture of that size (each at least 1)."""
    return _around(width_px, height_px, _fit_mm_per_px(width_px, height_px), FIELD_WIDTH_MM / 2, FIELD_HEIGHT_MM / 2)


def following(width_px: int, height_px: int, zoom: int, pose: Pose, previous: Viewport | None) -> Viewport:
    """Return a viewport that keeps the robot visible.

    The view stays still until the robot comes near an edge, and then jumps so that the robot is in the middle again: a
    picture that moved all the time would have to be sent completely in each frame.

    Args:
        width_px: Width of the picture, at least 1.
        height_px: Height of the picture, at least 1.
        zoom: One of `ZOOMS`; 1 shows the whole field and never moves.
        pose: The pose of the robot.
        previous: The viewport of the last frame, if any.
    """
    if zoom == 1:
        return whole_field(width_px, height_px)
    mm_per_px = _fit_mm_per_px(width_px, height_px) / zoom
    same_scale = (
        previous is not None
        and (previous.width_px, previous.height_px) == (width_px, height_px)
        and math.isclose(previous.mm_per_px, mm_per_px)
    )
    if same_scale and previous is not None and _well_inside(previous, pose):
        return previous
    x_mm = _clamped(pose.x_mm, width_px * mm_per_px, FIELD_WIDTH_MM)
    y_mm = _clamped(pose.y_mm, height_px * mm_per_px, FIELD_HEIGHT_MM)
    moved = _around(width_px, height_px, mm_per_px, x_mm, y_mm)
    return previous if previous is not None and moved == previous else moved


def _fit_mm_per_px(width_px: int, height_px: int) -> float:
    return max(FIELD_WIDTH_MM / width_px, FIELD_HEIGHT_MM / height_px)


def _around(width_px: int, height_px: int, mm_per_px: float, x_mm: float, y_mm: float) -> Viewport:
    # Whole-pixel margins: a field edge that falls between pixels would be a blurred line.
    left_px = round(width_px / 2 - x_mm / mm_per_px)
    top_px = round(height_px / 2 - (FIELD_HEIGHT_MM - y_mm) / mm_per_px)
    return Viewport(width_px, height_px, mm_per_px, -left_px * mm_per_px, FIELD_HEIGHT_MM + top_px * mm_per_px)


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
    right = view.left_mm + view.width_px * view.mm_per_px >= FIELD_WIDTH_MM or col <= view.width_px - margin_col
    top = view.top_mm >= FIELD_HEIGHT_MM or row >= margin_row
    bottom = view.top_mm - view.height_px * view.mm_per_px <= 0 or row <= view.height_px - margin_row
    return left and right and top and bottom
