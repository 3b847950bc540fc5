"""Cells: the difference between two frames, and a picture in the colours of a terminal, or in dots or signs without."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tuisim.terminal.fitted_cells import CellIndex, Cells, list_cells
from tuisim.terminal.glyphs import (
    BRAILLE_FROM,
    GLYPHS,
    Covered,
    GlyphSet,
    build_glyph_set,
    find_nearest_signs,
    sign_number,
)
from tuisim.terminal.picture_options import CellSet
from tuisim.terminal.pixels import CellPoints, Pixels, pack_rgb, unpack_rgb

CellRun: TypeAlias = tuple[int, int, int]
"""A run of cells in a row: row, first column and number of cells; several are in order from the top left."""

MERGE_GAP = 3
"""Unchanged cells between two runs that are cheaper to send again than to jump over."""


def find_changed_cells(old: Pixels, new: Pixels, glyphs: GlyphSet) -> CellIndex:
    """Return the rows and columns of the cells in which two pictures of the same shape differ."""
    cols = new.shape[1] // glyphs.cols
    row_bytes = new.shape[1] * 3
    # The bytes are compared four at a time; such a word may belong to two cells.
    word = np.uint32 if new.nbytes % 4 == 0 else np.uint16
    first = np.flatnonzero(_view_words(new, word) != _view_words(old, word)) * word().itemsize
    changed = np.zeros((len(new) // glyphs.rows, cols), bool)
    for offset in (first, first + word().itemsize - 1):
        changed[offset // (row_bytes * glyphs.rows), offset % row_bytes // (3 * glyphs.cols)] = True
    at_rows, at_cols = np.nonzero(changed)
    return at_rows, at_cols


def _view_words(picture: Pixels, word: type[np.unsignedinteger]) -> npt.NDArray[np.unsignedinteger]:
    return np.ascontiguousarray(picture).ravel().view(word)


def find_changed_runs(old: Cells, new: Cells) -> list[CellRun]:
    """Return the runs of cells that differ between two frames of the same shape; close runs are joined.

    Each run is (row, first column, number of cells).

    Args:
        old: The frame on the screen.
        new: The next frame.
    """
    return find_runs(old != new, MERGE_GAP)


def find_runs(changed: npt.NDArray[np.bool_], gap: int = 1) -> list[CellRun]:
    """Return the runs of true values in each row of an array of shape (rows, columns).

    Each run is (row, first column, number of cells). Runs with fewer than `gap` cells between them are joined.
    """
    rows, cols = np.nonzero(changed)
    if not len(rows):
        return []
    # A run ends where the row changes or the next changed cell is too far away.
    breaks = np.flatnonzero((np.diff(rows) != 0) | (np.diff(cols) > gap))
    firsts = np.concatenate(([0], breaks + 1))
    lasts = np.concatenate((breaks, [len(rows) - 1]))
    return list(
        zip(
            rows[firsts].tolist(),
            cols[firsts].tolist(),
            (cols[lasts] - cols[firsts] + 1).tolist(),
            strict=True,
        )
    )


TRUECOLOR = 1 << 24
PALETTE_256 = 256
PALETTE_16 = 16
PALETTE_8 = 8
MONO = 2
"""Colour depths, as numbers of colours; the two of `MONO` are those of the terminal itself."""

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
    """The number of colours of a terminal, and whether only greys are to be used."""

    depth: int = TRUECOLOR
    grey: bool = False
    """Whether only greys are to be used (NO_COLOR)."""

    @property
    def dithers(self) -> bool:
        """Whether the colours are so few that shades between them are shown as patterns of dots."""
        return MONO < self.depth < PALETTE_256


def reduce_cells(cells: Cells, mode: ColorMode) -> Cells:
    """Return cells in which each colour is replaced by a colour that the terminal has."""
    if mode.depth == MONO or (mode.depth >= TRUECOLOR and not mode.grey):
        return cells
    colors = np.stack((cells >> 24, cells), axis=-1)[..., None] >> np.array([16, 8, 0]) & 255
    flat = colors.reshape(-1, 3).astype(np.uint8)
    reduced = pack_rgb(
        _find_nearest(_convert_greys(flat, mode), mode.depth).astype(np.int64).T
    ).reshape(*cells.shape, 2)
    return cells >> 48 << 48 | reduced[..., 0] << 24 | reduced[..., 1]


def _convert_greys(pixels: Pixels, mode: ColorMode) -> Pixels:
    if not mode.grey:
        return pixels
    return np.repeat(np.rint(pixels @ _LUMA).astype(np.uint8)[:, None], 3, axis=1)


def _find_nearest(pixels: Pixels, depth: int) -> Pixels:
    """Return the nearest colour of the terminal for each pixel; `depth` is its number of colours."""
    if depth >= TRUECOLOR:
        return pixels
    if depth >= PALETTE_256:
        return _build_palette()[_find_nearest_256(pixels.astype(np.int32))]
    return _STANDARD[_find_nearest_16(pixels.astype(np.int32), depth)].astype(np.uint8)


def reduce_pixels(
    pixels: Pixels, rows: npt.NDArray[np.intp], cols: npt.NDArray[np.intp], mode: ColorMode
) -> Pixels:
    """Return pixels in which each colour is replaced by a colour that the terminal has.

    With 16 colours, shades between them are dithered, so that a pale band on white does not vanish.

    Args:
        pixels: Shape (n, 3).
        rows: The row of each pixel in the picture, shape (n,); the dither pattern depends on it.
        cols: The column of each pixel in the picture, shape (n,).
        mode: The colours that the terminal supports.

    Returns:
        Shape (n, 3).
    """
    pixels = _convert_greys(pixels, mode)
    if not mode.dithers:
        return _find_nearest(pixels, mode.depth)
    # Strong colours are close enough to one of the 16; dithering would only spoil them.
    paleness = 1 - (pixels.max(axis=1).astype(np.float32) - pixels.min(axis=1)) / 255
    if mode.depth == PALETTE_8:
        return _mix_pale_8(pixels, (_BAYER[rows % 4, cols % 4] + 0.5) / 16, paleness)
    offset = (_BAYER[rows % 4, cols % 4] - 7.5) / 8 * _DITHER * paleness
    return _find_nearest(np.clip(pixels + offset[:, None], 0, 255).astype(np.uint8), mode.depth)


_SHARES_8 = ((40, 128, 211, 220, 255), (0.0, 0.5, 0.75, 0.875, 1.0))
"""The share of white in a grey among 8 colours, which have no other grey; what is nearly black, as the ground of a
panel, gets no dots."""


def _mix_pale_8(
    pixels: Pixels, thresholds: npt.NDArray[np.float64], paleness: npt.NDArray[np.float32]
) -> Pixels:
    """Return pixels in the eight colours of a terminal: pale pixels become black or white, others the nearest colour.

    Args:
        pixels: Shape (n, 3).
        thresholds: The dither pattern, shape (n,): a pale pixel becomes white if its share of white is larger.
        paleness: From 0 for a full colour to 1 for grey, shape (n,); a pixel above 0.75 is pale.
    """
    white = np.interp(pixels @ _LUMA, *_SHARES_8) > thresholds
    dithered = np.where(white[:, None], _STANDARD[7], _STANDARD[0])
    return np.where((paleness > 0.75)[:, None], dithered, _find_nearest(pixels, PALETTE_8)).astype(
        np.uint8
    )


@lru_cache(maxsize=8192)
def build_color_codes(rgb: int, depth: int) -> tuple[str, str]:
    """Return the SGR codes that set a colour 0xRRGGBB as foreground and as background.

    Args:
        rgb: The colour.
        depth: Number of colours of the terminal; if the terminal lacks the colour, the codes are those of the
            nearest colour that it has.
    """
    if depth >= TRUECOLOR:
        channels = "{};{};{}".format(*unpack_rgb(rgb))
        return f"38;2;{channels}", f"48;2;{channels}"
    number = find_sgr_index(rgb, depth)
    if depth >= PALETTE_256:
        return f"38;5;{number}", f"48;5;{number}"
    # The codes of the bright colours are 90 to 97 and 100 to 107.
    shade = number if number < PALETTE_8 else number + 52
    return str(30 + shade), str(40 + shade)


def find_sgr_index(rgb: int, depth: int) -> int:
    """Return the index, in a terminal's palette of `depth` colours, of the colour nearest to 0xRRGGBB.

    The index is from 16 to 255 with 256 colours, else from 0 to `depth` - 1.
    """
    color = np.array([unpack_rgb(rgb)], np.int32)
    return int(
        (_find_nearest_256(color) if depth >= PALETTE_256 else _find_nearest_16(color, depth))[0]
    )


@lru_cache(maxsize=1)
def _build_palette() -> Pixels:
    """Return the 256 colours of a terminal, shape (256, 3); the first 16 are not used."""
    cube = [(red, green, blue) for red in _CUBE for green in _CUBE for blue in _CUBE]
    return np.array([(0, 0, 0)] * 16 + cube + [(grey,) * 3 for grey in _GREYS], np.uint8)


def _find_nearest_256(pixels: npt.NDArray[np.int32]) -> npt.NDArray[np.intp]:
    levels = np.array(_CUBE, np.int32)
    steps = np.searchsorted((levels[1:] + levels[:-1]) / 2, pixels)
    cube = 16 + steps @ np.array([36, 6, 1])
    grey = np.clip(np.rint((pixels.mean(axis=1) - 8) / 10), 0, 23).astype(np.intp)
    cube_error = ((levels[steps] - pixels) ** 2).sum(axis=1)
    grey_error = ((8 + 10 * grey[:, None] - pixels) ** 2).sum(axis=1)
    nearest: npt.NDArray[np.intp] = np.where(grey_error < cube_error, 232 + grey, cube)
    return nearest


def _find_nearest_16(
    pixels: npt.NDArray[np.int32], depth: int = PALETTE_16
) -> npt.NDArray[np.intp]:
    # Green weighs most and blue least, as in human vision.
    errors = ((pixels[:, None, :] - _STANDARD[:depth]) ** 2) @ np.array([3, 5, 2])
    nearest: npt.NDArray[np.intp] = errors.argmin(axis=1)
    return nearest


_INK_GREYS = (0, 128, 211, 220, 255)
_DARKNESS = (1.0, 0.5, 0.25, 0.125, 0.0)
"""Two, four and eight times the ink for the darker greys of the mats, which are hardly darker than each other."""
_THRESHOLDS = (np.array([0, 4, 6, 2, 1, 5, 7, 3], np.float32) + 0.5) / 8
"""The order in which the points of a cell get dots: each dot far from the last one."""
_RAMP = " .:-+xoO8@"
_EVEN = 0.13
"""Points whose darkness differs by less than this are shown by a sign for their mean."""
_INK_ON_PAPER = 0xFFFFFF << 24
"""Light dots on black where a picture needs colours after all, as in a screenshot."""


def measure_darkness(points: npt.NDArray[np.uint8]) -> Covered:
    """Return how dark colours are, from 0 for white to 1 for black.

    Args:
        points: The colours, shape (…, 3).
    """
    shares: Covered = np.interp(points @ _LUMA, _INK_GREYS, _DARKNESS).astype(np.float32)
    return shares


def draw_mono_cells(
    picture: Pixels, glyphs: GlyphSet, places: CellIndex, cell_set: CellSet
) -> Cells:
    """Return some cells of a picture, drawn without colours as braille dots or ASCII signs, shape (n,).

    Args:
        picture: The picture; each of its cells has as many points as the glyphs have.
        glyphs: The glyphs of `cell_set`.
        places: Rows and columns of the cells.
        cell_set: Braille or ASCII.
    """
    rows = len(picture) // glyphs.rows
    cols = picture.shape[1] // glyphs.cols
    points = picture.reshape(rows, glyphs.rows, cols, glyphs.cols, 3).transpose(0, 2, 1, 3, 4)[
        places
    ]
    ink = measure_darkness(points.reshape(len(points), glyphs.rows * glyphs.cols, 3))
    if cell_set is CellSet.BRAILLE:
        dots = ink > _THRESHOLDS
        patterns = (dots << np.arange(dots.shape[1])).sum(axis=1)
        numbers = np.where(patterns == 0, sign_number(" "), BRAILLE_FROM + patterns)
    else:
        ramp = np.array([sign_number(sign) for sign in _RAMP])
        even = np.ptp(ink, axis=1) < _EVEN
        steps = np.rint(ink.mean(axis=1) * (len(_RAMP) - 1)).astype(np.intp)
        numbers = np.where(even, ramp[steps], find_nearest_signs(ink))
    cells: Cells = numbers.astype(np.int64) << 48 | _INK_ON_PAPER
    return cells


def find_cell_points(cell_set: CellSet) -> CellPoints:
    """Return how many points across and down an image has in a cell that is drawn with a set of glyphs."""
    glyphs = build_glyph_set(cell_set)
    return CellPoints(glyphs.cols, glyphs.rows)


def draw_mono_rows(picture: Pixels, cell_set: CellSet) -> list[str]:
    """Return an image as rows of glyphs without colours.

    Args:
        picture: The image, with as many points in each cell as `find_cell_points(cell_set)` says.
        cell_set: The set of glyphs.
    """
    glyphs = build_glyph_set(cell_set)
    shape = len(picture) // glyphs.rows, picture.shape[1] // glyphs.cols
    cells = draw_mono_cells(picture, glyphs, list_cells(*shape), cell_set).reshape(shape)
    return ["".join(GLYPHS[cell >> 48] for cell in row).rstrip() for row in cells.tolist()]


def sign_cell(sign: str) -> int:
    """Return the number of a cell that shows an ASCII sign."""
    return sign_number(sign) << 48 | _INK_ON_PAPER
