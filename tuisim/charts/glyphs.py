"""Glyphs that show several picture points in one cell: which sets there are, and which points each glyph covers.

Sources: The Unicode Standard 16.0, code charts Block Elements (U+2580), Symbols for Legacy Computing (U+1FB00) and its
Supplement (U+1CC00): a sextant or octant covers the points that its name lists, numbered row by row from the upper
left; Braille Patterns (U+2800): dots 1 to 8 are bits 0 to 7.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from tuisim.config.options import CellSet

Covered = npt.NDArray[np.float32]
"""Shape (n, points): the share of each point that a glyph covers, row by row from the upper left."""

_ELSEWHERE = {
    0x01: "\U0001cea8", 0x02: "\U0001ceab", 0x03: "\U0001fb82", 0x05: "▘", 0x0A: "▝", 0x0F: "▀", 0x14: "\U0001fbe6",
    0x28: "\U0001fbe7", 0x3F: "\U0001fb85", 0x40: "\U0001cea3", 0x50: "▖", 0x55: "▌", 0x5A: "▞", 0x5F: "▛",
    0x80: "\U0001cea0", 0xA0: "▗", 0xA5: "▚", 0xAA: "▐", 0xAF: "▜", 0xC0: "▂", 0xF0: "▄", 0xF5: "▙", 0xFA: "▟",
    0xFC: "▆", 0x00: " ", 0xFF: "█",
}  # fmt: skip
"""Octant patterns that have had a code point before Unicode 16; bit 0 is the upper left point."""

_BRAILLE_BITS = (0, 3, 1, 4, 2, 5, 6, 7)
"""The bit of a braille pattern for each point, row by row."""


def _octants() -> list[str]:
    """Return the glyphs of all 256 patterns; those of U+1CD00 are in the order of the patterns, without the others."""
    following = iter(range(0x1CD00, 0x1CDE6))
    return [_ELSEWHERE.get(pattern) or chr(next(following)) for pattern in range(256)]


def _sextants() -> list[str]:
    known = {0: " ", 21: "▌", 42: "▐", 63: "█"}
    following = iter(range(0x1FB00, 0x1FB3C))
    return [known.get(pattern) or chr(next(following)) for pattern in range(64)]


def _braille() -> list[str]:
    return [
        chr(0x2800 + sum(1 << bit for point, bit in enumerate(_BRAILLE_BITS) if pattern >> point & 1))
        for pattern in range(256)
    ]


_SEXTANTS_FROM, _BRAILLE_FROM, _ASCII_FROM = 256, 320, 576

GLYPHS: tuple[str, ...] = ("▀", *_octants()[1:], *_sextants(), *_braille(), *map(chr, range(128)))
"""Every glyph by its number in a cell. 0 is the upper half block: two colours without a glyph are a half block."""


@cache
def block_patterns() -> dict[str, tuple[int, int]]:
    """Return for each block glyph the number of rows of two points, and which it covers; bit 0 is the upper left."""
    octants = {char: (4, pattern) for pattern, char in enumerate(_octants())}
    return {char: (3, pattern) for pattern, char in enumerate(_sextants())} | octants


@dataclass(frozen=True, slots=True)
class GlyphSet:
    """A grid of points in a cell, and the glyphs that cover some of them."""

    cols: int
    rows: int
    covered: Covered
    """Shape (glyphs, cols × rows)."""
    numbers: npt.NDArray[np.int64]
    """Of each glyph, in `GLYPHS`; ascending."""


def _bits(patterns: list[int], points: int) -> Covered:
    return (np.array(patterns)[:, None] >> np.arange(points) & 1).astype(np.float32)


@cache
def glyph_set(cells: CellSet) -> GlyphSet:
    """Return the glyphs of a set.

    Of a pattern and its inverse a set of blocks has the one with the upper left point: two colours change places
    instead. Dots leave most of their cell to the background: braille has the pattern with fewer of them.
    """
    if cells is CellSet.SEXTANT:
        patterns = list(range(1, 63, 2))
        return GlyphSet(2, 3, _bits(patterns, 6), np.array(patterns) + _SEXTANTS_FROM)
    if cells is CellSet.QUADRANT:
        whole = [0x05, 0x0F, 0x55, 0x5F, 0xA5, 0xAF, 0xF5]
        return GlyphSet(2, 2, _bits(whole, 8)[:, [0, 1, 4, 5]], np.array(whole))
    if cells is CellSet.OCTANT:
        patterns = list(range(1, 255, 2))
        return GlyphSet(2, 4, _bits(patterns, 8), np.array(patterns))
    if cells is CellSet.BRAILLE:
        patterns = [at for at in range(1, 255) if at.bit_count() < 4 or (at.bit_count() == 4 and at & 1)]
        return GlyphSet(2, 4, _bits(patterns, 8), np.array(patterns) + _BRAILLE_FROM)
    return GlyphSet(1, 2, _bits([1], 2), np.array([0]))


@cache
def half_block_of(cells: CellSet) -> GlyphSet:
    """Return the half block alone, with the points of a finer set."""
    fine = glyph_set(cells)
    upper = np.clip(fine.rows / 2 - np.arange(fine.rows), 0, 1).astype(np.float32)
    return GlyphSet(fine.cols, fine.rows, np.repeat(upper, fine.cols)[None], np.array([0]))
