"""Cells: two pixels one above the other packed into a number, and the difference between two frames."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tuisim.app.render.mat import Pixels

Cells = npt.NDArray[np.int64]
"""Shape (rows, columns): the upper colour in bits 24 to 47, the lower in bits 0 to 23, each 0xRRGGBB."""

MERGE_GAP = 3
"""Unchanged cells between two runs that are cheaper to send again than to jump over."""


def to_cells(picture: Pixels) -> Cells:
    """Return the half-block cells of a picture with an even number of rows."""
    colors = picture.astype(np.int64)
    packed = colors[..., 0] << 16 | colors[..., 1] << 8 | colors[..., 2]
    cells: Cells = packed[0::2] << 24 | packed[1::2]
    return cells


def changed_runs(old: Cells, new: Cells, gap: int = MERGE_GAP) -> list[tuple[int, int, int]]:
    """Return the runs of cells that differ between two frames of the same shape.

    Args:
        old: The frame on the screen.
        new: The next frame.
        gap: Runs with fewer unchanged cells than this between them are joined.

    Returns:
        (row, first column, number of cells), from the top left.
    """
    rows, cols = np.nonzero(old != new)
    if not len(rows):
        return []
    # A run ends where the row changes or the next changed cell is too far away.
    breaks = np.flatnonzero((np.diff(rows) != 0) | (np.diff(cols) > gap))
    firsts = np.concatenate(([0], breaks + 1))
    lasts = np.concatenate((breaks, [len(rows) - 1]))
    return list(
        zip(rows[firsts].tolist(), cols[firsts].tolist(), (cols[lasts] - cols[firsts] + 1).tolist(), strict=True)
    )
