"""The options of how a terminal shows pictures: the sets of glyphs, and the protocols for pixels."""

from __future__ import annotations

from enum import StrEnum


class CellSet(StrEnum):
    """A set of glyphs with which pictures are drawn, named by the points in a cell (columns × rows)."""

    HALF = "half"
    """1 × 2 points in a cell."""
    QUADRANT = "quadrant"
    """2 × 2 points in a cell."""
    SEXTANT = "sextant"
    """2 × 3 points in a cell."""
    OCTANT = "octant"
    """2 × 4 points in a cell, with glyphs of Unicode 16."""
    BRAILLE = "braille"
    """2 × 4 points in a cell, as dots."""
    ASCII = "ascii"
    """One letter or sign of ASCII for each cell."""


BLOCKS = frozenset({CellSet.HALF, CellSet.QUADRANT, CellSet.SEXTANT, CellSet.OCTANT})
"""The sets whose glyphs fill their cells."""
AUTO = "auto"


class Protocol(StrEnum):
    """The protocol with which a terminal draws pixels."""

    KITTY = "kitty"
    ITERM = "iterm"
    SIXEL = "sixel"


NO_PIXELS = "none"
