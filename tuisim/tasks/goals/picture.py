"""The picture that a drawing is compared with: a set of square cells of the field.

The cells are so small, compared with the tolerance, that their size does not matter, and so large that the comparison
stays quick: their side is an eighth of the tolerance, but at least 1 mm.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from msgspec import Meta

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.folders import user_path
from tuisim.engine.core.spec import BACKGROUND_FITS, FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.engine.mat_image import read_pixels
from tuisim.tasks.goals.condition import MAX_PLACES, Share, X, Y
from tuisim.tasks.goals.spec import DrawCondition

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

_DARK = 128
"""Pixels of an image whose mean channel is below this value belong to the picture."""
_MAX_POINTS_TOGETHER = 4096
"""Cells of a drawing that are compared in one step, which limits the memory."""


@dataclass(frozen=True, slots=True)
class PictureTable:
    """The keys of the condition `draw` in a goals file, which give the picture as an image or as lines."""

    within_mm: Annotated[float, Meta(ge=1, le=500)] = 15.0
    share: Share = 0.9
    image: str = ""
    """A file; what is dark in it is the picture."""
    fit: str = "stretch"
    """How the image is placed on the field, as a mat."""
    lines_mm: tuple[tuple[tuple[X, Y], ...], ...] = ()
    """Lines of points that are joined, x and y of each."""

    def __post_init__(self) -> None:
        if bool(self.image) == bool(self.lines_mm):
            raise ConfigError("needs a picture", "give image or lines_mm, not both")
        if self.fit not in BACKGROUND_FITS:
            raise ConfigError(
                f"no such value {self.fit!r}", f"one of {', '.join(BACKGROUND_FITS)}", key="fit"
            )
        for number, line in enumerate(self.lines_mm, start=1):
            if not 2 <= len(line) <= MAX_PLACES:
                raise ConfigError(
                    f"must have 2 to {MAX_PLACES} points, has {len(line)}",
                    key=f"lines_mm[{number}]",
                )


def draw_from_table(table: PictureTable, folder: Path) -> DrawCondition:
    """Return the condition `draw` with its picture; the path of an image is relative to `folder`.

    Raises:
        ConfigError: the image cannot be read, or has nothing dark in it.
    """
    import numpy as np

    if table.image:
        path = folder / user_path(table.image)
        points = _find_dark_points(path, table.fit)
    else:
        points = _sample_lines(table.lines_mm, compute_cell_mm(table.within_mm))
    numbers = np.unique(_number_cells(points, table.within_mm))
    return DrawCondition(numbers.astype("<i4").tobytes(), table.within_mm, table.share)


def _find_dark_points(path: Path, fit: str) -> Array:
    import numpy as np

    pixels = read_pixels(path, fit)
    rows, cols = np.nonzero(pixels.mean(axis=2) < _DARK)
    if not len(rows):
        raise ConfigError("has no dark pixels", "a picture is dark on light", file=str(path))
    return np.column_stack((cols + 0.5, FIELD_HEIGHT_MM - rows - 0.5))


def _sample_lines(lines: Sequence[Sequence[tuple[float, float]]], step_mm: float) -> Array:
    import numpy as np

    parts = []
    for line in lines:
        for (x0, y0), (x1, y1) in pairwise(line):
            count = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / step_mm))
            parts.append(
                np.column_stack((np.linspace(x0, x1, count + 1), np.linspace(y0, y1, count + 1)))
            )
    return np.concatenate(parts)


def compute_cell_mm(within_mm: float) -> float:
    """Return the side in mm of the square cells in which pictures are compared with a tolerance."""
    return max(1.0, within_mm / 8)


def _count_cells(within_mm: float) -> tuple[int, int]:
    """Return the number of columns and of rows of cells into which the field is divided, for a tolerance in mm."""
    side = compute_cell_mm(within_mm)
    return math.ceil(FIELD_WIDTH_MM / side), math.ceil(FIELD_HEIGHT_MM / side)


def _number_cells(points: Array, within_mm: float) -> Array:
    import numpy as np

    cols, rows = _count_cells(within_mm)
    col, row = (np.floor(points / compute_cell_mm(within_mm))).astype(np.int64).T
    numbers: Array = np.clip(row, 0, rows - 1) * cols + np.clip(col, 0, cols - 1)
    return numbers


def list_cells(condition: DrawCondition) -> Array:
    """Return the indices of the field's cells that contain lines of the condition's picture, ascending, shape (n,)."""
    import numpy as np

    return np.frombuffer(condition.picture, "<i4")


def compute_centres_mm(numbers: Array, within_mm: float) -> Array:
    """Return the centres of cells in mm, shape (n, 2).

    Args:
        numbers: Indices of the cells.
        within_mm: The tolerance, which determines the size of the cells.
    """
    import numpy as np

    cols, _ = _count_cells(within_mm)
    return np.column_stack((numbers % cols + 0.5, numbers // cols + 0.5)) * compute_cell_mm(
        within_mm
    )


def compare(cells: Array, points: Array, within_mm: float) -> tuple[Array, Array]:
    """Compare a drawing with a picture.

    Args:
        cells: Indices of the picture's cells, shape (n,).
        points: Points of the drawing in mm, shape (m, 2); they may be off the field.
        within_mm: The largest distance at which a point and a cell match.

    Returns:
        For each cell whether a point is near it, shape (n,), and for each point whether a cell is, shape (m,).
    """
    import numpy as np

    side = compute_cell_mm(within_mm)
    reach = math.ceil(within_mm / side) + 1
    # The grid has a margin around the field: points off the field are moved into its inner half, and the cells around
    # such points lie in its outer half.
    margin = 2 * reach
    cols, rows = _count_cells(within_mm)
    wide = cols + 2 * margin
    col = np.clip(np.floor(points[:, 0] / side).astype(np.int64), -reach, cols + reach - 1) + margin
    row = np.clip(np.floor(points[:, 1] / side).astype(np.int64), -reach, rows + reach - 1) + margin
    drawn, which = np.unique(row * wide + col, return_inverse=True)
    cells = (cells // cols + margin) * wide + cells % cols + margin
    picture, reached = (np.zeros(wide * (rows + 2 * margin), np.bool_) for _ in range(2))
    picture[cells] = True
    near = np.zeros(len(drawn), np.bool_)
    across, down = np.meshgrid(np.arange(-reach, reach + 1), np.arange(-reach, reach + 1))
    around = (down * wide + across)[np.hypot(down, across) * side <= within_mm]
    for start in range(0, len(drawn), _MAX_POINTS_TOGETHER):
        there = drawn[start : start + _MAX_POINTS_TOGETHER, None] + around
        near[start : start + _MAX_POINTS_TOGETHER] = picture[there].any(axis=1)
        reached[there] = True
    return reached[cells], near[which]
