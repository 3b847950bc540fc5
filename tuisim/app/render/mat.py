"""Area-averaged downscaling of the mat that keeps thin lines visible."""

from __future__ import annotations

from collections import OrderedDict

import numpy as np
import numpy.typing as npt

from tuisim.app.render.viewport import Viewport
from tuisim.charts.world_image import Pixels as Pixels

_REMEMBERED = 4


def shrink(mat: Pixels, view: Viewport, outside_rgb: tuple[int, int, int]) -> Pixels:
    """Return what a viewport shows of a mat.

    Each picture pixel is the mean of the mat pixels under it, moved toward the colour that
    is rarer there, so that a line of 10 mm can still be seen when a pixel covers 30 mm.

    Args:
        mat: The mat, one pixel a mm, row 0 at the top of the field.
        view: The part to show.
        outside_rgb: Colour of what lies off the mat.

    Returns:
        Shape (view.height_px, view.width_px, 3).
    """
    picture = np.empty((view.height_px, view.width_px, 3), np.uint8)
    picture[:] = outside_rgb
    height_mm, width_mm = mat.shape[:2]
    cols, col_edges = _edges(view.left_mm, view.mm_per_px, view.width_px, width_mm)
    rows, row_edges = _edges(height_mm - view.top_mm, view.mm_per_px, view.height_px, height_mm)
    if len(col_edges) < 2 or len(row_edges) < 2:
        return picture
    picture[rows, cols] = _reduced(mat, row_edges, col_edges)
    return picture


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


def _reduced(mat: Pixels, row_edges: npt.NDArray[np.intp], col_edges: npt.NDArray[np.intp]) -> Pixels:
    part = mat[row_edges[0] : row_edges[-1], col_edges[0] : col_edges[-1]]
    rows, cols = row_edges[:-1] - row_edges[0], col_edges[:-1] - col_edges[0]
    # The sum over the rows of a pixel stays below 2^16 as long as it covers at most 257 mm.
    narrow = np.uint16 if int(np.diff(row_edges).max()) <= 257 else np.uint32
    sums = np.add.reduceat(np.add.reduceat(part, rows, axis=0, dtype=narrow), cols, axis=1, dtype=np.uint32)
    areas = np.maximum(np.diff(row_edges), 1)[:, None, None] * np.maximum(np.diff(col_edges), 1)[None, :, None]
    mean = (sums / areas).astype(np.float32)
    low = np.minimum.reduceat(np.minimum.reduceat(part, rows, axis=0), cols, axis=1).astype(np.float32)
    high = np.maximum.reduceat(np.maximum.reduceat(part, rows, axis=0), cols, axis=1).astype(np.float32)
    return _keep_detail(mean, low, high)


def _keep_detail(mean: npt.NDArray[np.float32], low: npt.NDArray[np.float32], high: npt.NDArray[np.float32]) -> Pixels:
    """Move each mean toward whichever of low and high is the rarer one.

    With the share s of the brighter colour, the result has the share sqrt(s / 2) where s is
    below one half, and the same seen from the other end above it: 5 % become 16 %, and
    0, 50 and 100 % stay, so that plain areas and gradients are not touched.
    """
    span = high - low
    share = (mean - low) / np.where(span > 0, span, 1)
    rare = np.minimum(share, 1 - share)
    kept = np.sqrt(np.maximum(rare, 0) / 2)
    share = np.where(share < 0.5, kept, 1 - kept)
    picture: Pixels = np.rint(low + span * share).astype(np.uint8)
    return picture


class MatPictures:
    """Scaled pictures of one mat, cached by viewport.

    Args:
        mat: The mat, shape (height in mm, width in mm, 3).
        outside_rgb: Colour of what lies off the mat.
    """

    def __init__(self, mat: Pixels, outside_rgb: tuple[int, int, int]) -> None:
        self._mat = mat
        self._outside_rgb = outside_rgb
        self._made: OrderedDict[Viewport, Pixels] = OrderedDict()

    def picture(self, view: Viewport) -> Pixels:
        """Return the picture for a viewport. It is shared: do not write into it."""
        made = self._made.pop(view, None)
        if made is None:
            made = shrink(self._mat, view, self._outside_rgb)
            made.flags.writeable = False
        self._made[view] = made
        if len(self._made) > _REMEMBERED:
            self._made.popitem(last=False)
        return made
