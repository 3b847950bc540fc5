"""Pictures of the mat: the part of it in view, scaled down so that thin lines stay visible; discs under the sensors."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from tuisim.charts.world_image import Viewport, disc_in_box
from tuisim.core.geometry import Pose
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.terminal.pixels import SQUARE, CellPoints, Pixels

ZOOMS = (1, 2, 4)
"""Zoom factors, relative to the whole field."""

_KEEP_INSIDE = 0.22
"""A following view moves once the robot is nearer to an edge than this share of its size."""


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


def _around(width_px: int, height_px: int, mm_per_px: float, x_mm: float, y_mm: float, cell: CellPoints) -> Viewport:
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
    right = view.left_mm + view.width_px * view.mm_per_px >= FIELD_WIDTH_MM or col <= view.width_px - margin_col
    top = view.top_mm >= FIELD_HEIGHT_MM or row >= margin_row
    bottom = view.top_mm - view.height_px * view.mm_per_row <= 0 or row <= view.height_px - margin_row
    return left and right and top and bottom


_REMEMBERED = 4
_RARE = 0.25
"""What covers less of a pixel than this is drawn stronger."""


def shrink(mat: Pixels, view: Viewport, outside_rgb: tuple[int, int, int], whole_cells: bool = False) -> Pixels:
    """Return what a viewport shows of a mat.

    Each picture pixel is the mean of the mat pixels under it. Where a pixel is as wide as a cell, it is moved toward
    the colour that is rarer there, so that a line of 10 mm can still be seen when a pixel covers 30 mm.

    Args:
        mat: The mat, one pixel a mm, row 0 at the top of the field.
        view: The part to show.
        outside_rgb: Colour of what lies off the mat.
        whole_cells: End the mat where a cell ends, for glyphs that do not fill their cells: half of a cell in another
            colour would be a column of dots or brackets beside it.

    Returns:
        Shape (view.height_px, view.width_px, 3).
    """
    picture = np.empty((view.height_px, view.width_px, 3), np.uint8)
    picture[:] = outside_rgb
    height_mm, width_mm = mat.shape[:2]
    cols, col_edges = _edges(view.left_mm, view.mm_per_px, view.width_px, width_mm)
    rows, row_edges = _edges(height_mm - view.top_mm, view.mm_per_row, view.height_px, height_mm)
    if len(col_edges) < 2 or len(row_edges) < 2:
        return picture
    picture[rows, cols] = _reduced(mat, row_edges, col_edges, keep_detail=view.cell.cols == 1)
    if whole_cells:
        _end_with_a_cell(picture, rows, view.cell.rows, outside_rgb)
        _end_with_a_cell(picture.swapaxes(0, 1), cols, view.cell.cols, outside_rgb)
    return picture


def _end_with_a_cell(lines: Pixels, inside: slice, step: int, outside_rgb: tuple[int, int, int]) -> None:
    """Move both ends of the lines inside the mat to the nearest ends of cells of `step` lines; modified in place."""
    first, end = (step * math.floor(at / step + 0.5) for at in (inside.start, inside.stop))
    lines[first : inside.start] = lines[inside.start]
    lines[inside.start : first] = outside_rgb
    lines[inside.stop : end] = lines[inside.stop - 1]
    lines[end : inside.stop] = outside_rgb


def _edges(start_mm: float, mm_per_px: float, count: int, size_mm: int) -> tuple[slice, npt.NDArray[np.intp]]:
    """Return which picture pixels have their middle on the mat, and the mat edges between them, in mm."""
    middles = start_mm + (np.arange(count) + 0.5) * mm_per_px
    inside = np.flatnonzero((middles >= 0) & (middles < size_mm))
    if not len(inside):
        return slice(0, 0), np.empty(0, np.intp)
    first, last = int(inside[0]), int(inside[-1]) + 1
    edges = np.floor(start_mm + np.arange(first, last + 1) * mm_per_px + 0.5).astype(np.intp)
    edges = np.clip(edges, 0, size_mm)
    # Where a picture pixel is smaller than a mat pixel, it shows the one that begins there.
    edges[:-1] = np.minimum(edges[:-1], size_mm - 1)
    edges[-1] = max(edges[-1], edges[-2] + 1)
    return slice(first, last), edges


def _reduced(
    mat: Pixels, row_edges: npt.NDArray[np.intp], col_edges: npt.NDArray[np.intp], keep_detail: bool
) -> Pixels:
    part = mat[row_edges[0] : row_edges[-1], col_edges[0] : col_edges[-1]]
    rows, cols = row_edges[:-1] - row_edges[0], col_edges[:-1] - col_edges[0]
    # The sum over the rows of a pixel stays below 2^16 as long as it covers at most 257 mm.
    narrow = np.uint16 if int(np.diff(row_edges).max()) <= 257 else np.uint32
    sums = np.add.reduceat(_reduced_rows(np.add, part, rows, narrow), cols, axis=1, dtype=np.uint32)
    areas = np.maximum(np.diff(row_edges), 1)[:, None, None] * np.maximum(np.diff(col_edges), 1)[None, :, None]
    mean = (sums / areas).astype(np.float32)
    if not keep_detail:
        plain: Pixels = np.rint(mean).astype(np.uint8)
        return plain
    low = np.minimum.reduceat(_reduced_rows(np.minimum, part, rows, np.uint8), cols, axis=1).astype(np.float32)
    high = np.maximum.reduceat(_reduced_rows(np.maximum, part, rows, np.uint8), cols, axis=1).astype(np.float32)
    return _keep_detail(mean, low, high)


def _reduced_rows(
    operation: np.ufunc, part: Pixels, starts: npt.NDArray[np.intp], dtype: npt.DTypeLike
) -> npt.NDArray[Any]:
    """Return `operation.reduceat(part, starts, axis=0, dtype=dtype)`, in a tenth of its time."""
    reduced = np.empty((len(starts), *part.shape[1:]), dtype)
    for row, (start, end) in enumerate(pairwise([*starts, len(part)])):
        operation.reduce(part[start : max(end, start + 1)], axis=0, dtype=dtype, out=reduced[row])
    return reduced


def _keep_detail(mean: npt.NDArray[np.float32], low: npt.NDArray[np.float32], high: npt.NDArray[np.float32]) -> Pixels:
    """Move each mean toward whichever of low and high is the rarer one.

    Where the brighter colour has a share below a quarter, that is doubled, up to a quarter, and the same seen from the
    other end above three quarters: 5 % become 10 %, and 0 and 25 to 75 % stay, so that plain areas, gradients and
    edges are hardly touched.
    """
    span = high - low
    share = (mean - low) / np.where(span > 0, span, 1)
    rare = np.minimum(share, 1 - share)
    kept = np.maximum(rare, np.minimum(2 * rare, _RARE))
    share = np.where(share < 0.5, kept, 1 - kept)
    picture: Pixels = np.rint(low + span * share).astype(np.uint8)
    return picture


class MatPictures:
    """Scaled pictures of one mat, cached by viewport.

    Args:
        mat: The mat, shape (height in mm, width in mm, 3).
        outside_rgb: Colour of what lies off the mat.
        whole_cells: As for `shrink`.
    """

    def __init__(self, mat: Pixels, outside_rgb: tuple[int, int, int], whole_cells: bool = False) -> None:
        @lru_cache(maxsize=_REMEMBERED)
        def picture(view: Viewport) -> Pixels:
            made = shrink(mat, view, outside_rgb, whole_cells)
            made.flags.writeable = False
            return made

        self.picture: Callable[[Viewport], Pixels] = picture
        """Returns the picture for a viewport. It is shared: do not write into it."""


FULL_PX = 20
"""Largest size of a disc, besides its own diameter."""

CORNER_16_RGB = (0, 0, 135)
"""In place of `CORNER_RGB` for 8 or 16 colours: they have no grey to spare, and a pattern would outshine the disc."""


@dataclass(frozen=True, slots=True)
class DiscLayout:
    """Where the discs are in a picture, in pixels."""

    width_px: int
    height_px: int
    side_px: int
    """Side of the box around a disc."""
    corners: tuple[tuple[int, int], ...]
    """Column and row of the upper left corner of each box."""
    beside: bool
    """Whether they are side by side, and not one above the other."""


def lay_out(count: int, width_px: int, height_px: int) -> DiscLayout:
    """Side by side rather than one above the other.

    Args:
        count: How many discs.
        width_px: Width of the picture.
        height_px: Height of the picture, an even number.
    """
    count = max(count, 1)
    beside_px = min(FULL_PX, width_px // count, height_px)
    # Boxes start on even rows: a cell holds two pixels, one above the other.
    stacked_px = min(FULL_PX, width_px, height_px // count // 2 * 2)
    beside = beside_px >= stacked_px
    side = max(beside_px if beside else stacked_px, 1)
    if beside:
        spare = width_px - count * side
        gap = min(spare // (count + 1), 4)
        left = (width_px - count * side - (count - 1) * gap) // 2
        corners = [(left + at * (side + gap), 0) for at in range(count)]
    else:
        corners = [((width_px - side) // 2, at * side) for at in range(count)]
    return DiscLayout(width_px, height_px, side, tuple(corners), beside)


def draw_discs(
    layout: DiscLayout, boxes: Sequence[bytes], ground_rgb: tuple[int, int, int], corner_rgb: tuple[int, int, int]
) -> Pixels:
    """Return the picture of some discs.

    Args:
        layout: Their places.
        boxes: The pixels of each box: d × d, three bytes a pixel, row-major.
        ground_rgb: Background colour.
        corner_rgb: Colour of the corners of the boxes.

    Returns:
        Shape (layout.height_px, layout.width_px, 3).
    """
    picture = np.empty((layout.height_px, layout.width_px, 3), np.uint8)
    picture[:] = ground_rgb
    for (col, row), box in zip(layout.corners, boxes, strict=False):
        disc = _scaled(box, layout.side_px, corner_rgb)
        at = (layout.side_px - len(disc)) // 2
        picture[row + at : row + at + len(disc), col + at : col + at + len(disc)] = disc
    return picture


def _scaled(box: bytes, side_px: int, corner_rgb: tuple[int, int, int]) -> Pixels:
    """Return a disc of at most `side_px`, area-averaged if it has to be shrunk."""
    pixels = disc_in_box(box, corner_rgb)
    if len(pixels) <= side_px:
        return pixels
    return np.dstack([shrunk(channel, side_px, side_px) for channel in np.moveaxis(pixels, 2, 0)]).astype(np.uint8)


def shrunk(pixels: npt.NDArray[np.uint8], rows: int, columns: int) -> npt.NDArray[np.float64]:
    """Return the mean of the pixels in each cell of a coarser grid.

    Args:
        pixels: Shape (h, w).
        rows: Of the coarser grid, at most h.
        columns: Of the coarser grid, at most w.

    Returns:
        Shape (rows, columns).
    """
    down = np.arange(rows + 1) * pixels.shape[0] // rows
    across = np.arange(columns + 1) * pixels.shape[1] // columns
    sums = np.add.reduceat(np.add.reduceat(pixels, down[:-1], axis=0, dtype=np.float64), across[:-1], axis=1)
    means: npt.NDArray[np.float64] = sums / (np.diff(down)[:, None] * np.diff(across)[None, :])
    return means
