"""What colour sensors see: discs of pixels, side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from tuisim.core.css_colors import Rgb
from tuisim.core.field import disc_mask
from tuisim.core.spec import ColorSensorSpec
from tuisim.data_class import dataclass
from tuisim.terminal.pixels import Pixels

if TYPE_CHECKING:
    from PIL.Image import Image

ARRAY_PX = 6
"""Side of one sensor pixel in the arrays' picture."""

CORNER_RGB = (58, 70, 88)
"""Outside the disc of a sensor: neither black, white nor a colour of a mat, so that its outline is seen on any of them.
"""

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


def disc_in_box(box: bytes, corner_rgb: Rgb) -> Pixels:
    """Return the pixels of a square around a disc, d × d, three bytes a pixel, with the corners in one colour."""
    diameter = round((len(box) / 3) ** 0.5)
    pixels = np.frombuffer(box, np.uint8).reshape(diameter, diameter, 3).copy()
    pixels[~np.array(disc_mask(diameter))] = corner_rgb
    return pixels


def arrays_picture(arrays: Sequence[tuple[ColorSensorSpec, bytes]]) -> Image:
    """Return side by side the discs that sensors see, each given as RGB bytes, d × d pixels, row by row."""
    from PIL import Image

    tiles = [
        Image.fromarray(disc_in_box(pixels, CORNER_RGB)).resize(
            (sensor.diameter_mm * ARRAY_PX,) * 2, Image.Resampling.NEAREST
        )
        for sensor, pixels in arrays
    ]
    whole = Image.new(
        "RGB", (sum(t.width + 12 for t in tiles) or 1, max((t.height for t in tiles), default=1)), "white"
    )
    left = 0
    for tile in tiles:
        whole.paste(tile, (left, 0))
        left += tile.width + 12
    return whole
