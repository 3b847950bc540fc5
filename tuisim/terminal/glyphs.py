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

from tuisim.terminal.picture_options import CellSet

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


def _list_octants() -> list[str]:
    """Return the glyphs of all 256 patterns of octants, in the order of the patterns.

    The glyphs are the characters from U+1CD00 on; the patterns of `_ELSEWHERE` have other characters.
    """
    following = iter(range(0x1CD00, 0x1CDE6))
    return [_ELSEWHERE.get(pattern) or chr(next(following)) for pattern in range(256)]


def _list_sextants() -> list[str]:
    known = {0: " ", 21: "▌", 42: "▐", 63: "█"}
    following = iter(range(0x1FB00, 0x1FB3C))
    return [known.get(pattern) or chr(next(following)) for pattern in range(64)]


def _list_braille() -> list[str]:
    return [
        chr(
            0x2800
            + sum(1 << bit for point, bit in enumerate(_BRAILLE_BITS) if pattern >> point & 1)
        )
        for pattern in range(256)
    ]


_SEXTANTS_FROM, BRAILLE_FROM, _ASCII_FROM = 256, 320, 576

GLYPHS: tuple[str, ...] = (
    "▀",
    *_list_octants()[1:],
    *_list_sextants(),
    *_list_braille(),
    *map(chr, range(128)),
)
"""Every glyph by its number in a cell. 0 is the upper half block: two colours without a glyph are a half block."""


@cache
def block_patterns() -> dict[str, tuple[int, int]]:
    """Return for each glyph of sextants or octants how many rows of points it has, and which points it covers.

    Each row has two points. The covered points are the bits of a number: bit 0 is the upper left point, and the bits
    follow row by row.
    """
    octants = {char: (4, pattern) for pattern, char in enumerate(_list_octants())}
    return {char: (3, pattern) for pattern, char in enumerate(_list_sextants())} | octants


_INK = {
    ' ': "00000000", '.': "00001111", ',': "00001131", ':': "00221111", "'": "00220000", '`': "20010000",
    '"': "11440000", '-': "00002200", '_': "00000044", '=': "00334500", '+': "00226600", '~': "00004400",
    '^': "11440000", '/': "01055130", '\\': "10602403", '|': "11232323", '(': "01325113", ')': "10231531",
    '[': "12414132", ']': "21151523", '<': "00246400", '>': "00424600", 'r': "00446010", 'L': "10606034",
    'J': "12161632", "7": "22173320", 'T': "33443311", 'Y': "11663311", 'v': "00335511", 'o': "00446622",
    'x': "00335522", 'z': "00354233", 'c': "00436013", 'n': "00555511", 'u': "00336623", 'X': "11566622",
    'O': "11666622", '#': "01788711", '%': "10933703", "8": "22777722", 'M': "11997711", 'W': "11779922",
    '@': "00699843",
}  # fmt: skip
"""How much of each of 2 × 4 points the strokes of a character cover, row by row, from 0 to 9 for half of it or more;
measured with DejaVu Sans Mono."""

SIGNS = tuple(_INK)
"""The characters that pictures in ASCII consist of."""


@cache
def sign_ink() -> Covered:
    """Return how dark each point of each of `SIGNS` is, 0 to 1, shape (signs, 8)."""
    return np.array([[int(digit) / 9 for digit in ink] for ink in _INK.values()], np.float32)


def sign_number(sign: str) -> int:
    """Return the number of an ASCII character in `GLYPHS`."""
    return _ASCII_FROM + ord(sign)


def find_nearest_signs(ink: Covered, letters: bool = True) -> npt.NDArray[np.int64]:
    """Return for each cell the number of the ASCII character that looks most like its points.

    Args:
        ink: How dark each point is, 0 to 1, shape (n, 8).
        letters: Whether letters may be among the characters.
    """
    table = sign_ink()
    away = np.square(table).sum(axis=1) - 2 * ink @ table.T
    numbers = np.array([sign_number(sign) for sign in SIGNS])
    if not letters:
        away[:, [sign.isalnum() for sign in SIGNS]] = np.inf
    nearest: npt.NDArray[np.int64] = numbers[away.argmin(axis=1)]
    return nearest


@dataclass(frozen=True, slots=True)
class GlyphSet:
    """The glyphs of a set, with the grid of points in a cell and the points that each glyph covers."""

    cols: int
    rows: int
    covered: Covered
    """For each glyph the share of each point that it covers, shape (glyphs, cols × rows)."""
    numbers: npt.NDArray[np.int64]
    """Number of each glyph in `GLYPHS`; ascending, except for ASCII, where several patterns have the same glyph."""


def _unpack_bits(patterns: list[int], points: int) -> Covered:
    return (np.array(patterns)[:, None] >> np.arange(points) & 1).astype(np.float32)


@cache
def build_glyph_set(cells: CellSet) -> GlyphSet:
    """Return the glyphs of a set, with the points that they cover.

    A pattern and its inverse look the same if their two colours are exchanged, so the set has only one of the two. A
    set of blocks has the pattern with the upper left point. Braille has the pattern with fewer dots, which leaves most
    of the cell to the background.
    """
    if cells is CellSet.SEXTANT:
        patterns = list(range(1, 63, 2))
        return GlyphSet(2, 3, _unpack_bits(patterns, 6), np.array(patterns) + _SEXTANTS_FROM)
    if cells is CellSet.QUADRANT:
        whole = [0x05, 0x0F, 0x55, 0x5F, 0xA5, 0xAF, 0xF5]
        return GlyphSet(2, 2, _unpack_bits(whole, 8)[:, [0, 1, 4, 5]], np.array(whole))
    if cells is CellSet.OCTANT:
        patterns = list(range(1, 255, 2))
        return GlyphSet(2, 4, _unpack_bits(patterns, 8), np.array(patterns))
    if cells in (CellSet.BRAILLE, CellSet.ASCII):
        patterns = [
            pattern
            for pattern in range(1, 255)
            if pattern.bit_count() < 4 or (pattern.bit_count() == 4 and pattern & 1)
        ]
        covered = _unpack_bits(patterns, 8)
        numbers = (
            np.array(patterns) + BRAILLE_FROM
            if cells is CellSet.BRAILLE
            else find_nearest_signs(covered, letters=False)
        )
        return GlyphSet(2, 4, covered, numbers)
    return GlyphSet(1, 2, _unpack_bits([1], 2), np.array([0]))


@cache
def build_half_block(cells: CellSet) -> GlyphSet:
    """Return a set with only the upper half block, in a cell with as many points as the set `cells` has."""
    fine = build_glyph_set(cells)
    upper = np.clip(fine.rows / 2 - np.arange(fine.rows), 0, 1).astype(np.float32)
    return GlyphSet(fine.cols, fine.rows, np.repeat(upper, fine.cols)[None], np.array([0]))
