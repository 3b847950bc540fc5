"""Cells: two pixels one above the other, the difference between two frames, and the colours that terminals support."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

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


TRUECOLOR, PALETTE_256, PALETTE_16 = 1 << 24, 256, 16
"""Colour depths, as numbers of colours."""

_CUBE = (0, 95, 135, 175, 215, 255)
_GREYS = tuple(range(8, 248, 10))

_STANDARD = np.array(
    [
        (0, 0, 0), (200, 0, 0), (0, 190, 0), (205, 160, 0), (0, 0, 225), (195, 0, 195), (0, 185, 195), (205, 205, 205),
        (110, 110, 110), (255, 70, 70), (70, 255, 70), (255, 250, 70), (85, 110, 255), (255, 80, 255), (80, 255, 255),
        (255, 255, 255),
    ],
    np.int32,
)  # fmt: skip
"""The 16 colours roughly as common terminals show them; no two agree exactly."""

_BAYER = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])
_DITHER = 24.0
"""Half of the smallest step between two greys of the 16: more would put dots on pure white."""

_LUMA = np.array([0.299, 0.587, 0.114], np.float32)


@dataclass(frozen=True, slots=True)
class ColorMode:
    """The colours that the terminal supports."""

    depth: int = TRUECOLOR
    grey: bool = False
    """Colours are unwanted (NO_COLOR)."""


def reduce_pixels(pixels: Pixels, rows: npt.NDArray[np.intp], cols: npt.NDArray[np.intp], mode: ColorMode) -> Pixels:
    """Return pixels in colours that the terminal supports.

    With 16 colours, shades between them are dithered, so that a pale band on white does not vanish.

    Args:
        pixels: Shape (n, 3).
        rows: The picture row of each, shape (n,); the dither pattern depends on it.
        cols: The picture column of each, shape (n,).
        mode: The colours that the terminal supports.

    Returns:
        Shape (n, 3).
    """
    if mode.grey:
        pixels = np.repeat(np.rint(pixels @ _LUMA).astype(np.uint8)[:, None], 3, axis=1)
    if mode.depth >= TRUECOLOR:
        return pixels
    if mode.depth >= PALETTE_256:
        return _palette_rgb()[_nearest_256(pixels.astype(np.int32))]
    # Strong colours are close enough to one of the 16; dithering would only spoil them.
    paleness = 1 - (pixels.max(axis=1).astype(np.float32) - pixels.min(axis=1)) / 255
    offset = (_BAYER[rows % 4, cols % 4] - 7.5) / 8 * _DITHER * paleness
    shaded = np.clip(pixels + offset[:, None], 0, 255).astype(np.int32)
    return _STANDARD[_nearest_16(shaded)].astype(np.uint8)


def sgr_index(rgb: int, depth: int) -> int:
    """Return the palette number nearest to 0xRRGGBB: 16 to 255, or 0 to 15 for a depth of 16."""
    color = np.array([[rgb >> 16, rgb >> 8 & 255, rgb & 255]], np.int32)
    return int((_nearest_256(color) if depth >= PALETTE_256 else _nearest_16(color))[0])


@lru_cache(maxsize=1)
def _palette_rgb() -> Pixels:
    """Return the 256 colours; the first 16 are never used."""
    cube = [(red, green, blue) for red in _CUBE for green in _CUBE for blue in _CUBE]
    return np.array([(0, 0, 0)] * 16 + cube + [(grey,) * 3 for grey in _GREYS], np.uint8)


def _nearest_256(pixels: npt.NDArray[np.int32]) -> npt.NDArray[np.intp]:
    levels = np.array(_CUBE, np.int32)
    steps = np.searchsorted((levels[1:] + levels[:-1]) / 2, pixels)
    cube = 16 + steps @ np.array([36, 6, 1])
    grey = np.clip(np.rint((pixels.mean(axis=1) - 8) / 10), 0, 23).astype(np.intp)
    cube_error = ((levels[steps] - pixels) ** 2).sum(axis=1)
    grey_error = ((8 + 10 * grey[:, None] - pixels) ** 2).sum(axis=1)
    nearest: npt.NDArray[np.intp] = np.where(grey_error < cube_error, 232 + grey, cube)
    return nearest


def _nearest_16(pixels: npt.NDArray[np.int32]) -> npt.NDArray[np.intp]:
    # Green weighs most and blue least, as in human vision.
    errors = ((pixels[:, None, :] - _STANDARD) ** 2) @ np.array([3, 5, 2])
    nearest: npt.NDArray[np.intp] = errors.argmin(axis=1)
    return nearest
