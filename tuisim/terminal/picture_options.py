"""How a terminal shows pictures: the glyphs and the ways to draw pixels that one can choose."""

from __future__ import annotations

from enum import StrEnum


class CellSet(StrEnum):
    """The glyphs that pictures are drawn with, by the points in a cell (columns × rows)."""

    HALF = "half"
    """1 × 2"""
    QUADRANT = "quadrant"
    """2 × 2"""
    SEXTANT = "sextant"
    """2 × 3"""
    OCTANT = "octant"
    """2 × 4, Unicode 16"""
    BRAILLE = "braille"
    """2 × 4, as dots"""
    ASCII = "ascii"
    """Letters and signs"""


AUTO = "auto"


class Protocol(StrEnum):
    """How a terminal is told to draw pixels."""

    KITTY = "kitty"
    ITERM = "iterm"
    SIXEL = "sixel"


NO_PIXELS = "none"
