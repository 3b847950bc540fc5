"""How pictures are drawn on the terminal: with which glyphs, and how fine at the moment."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from textual.app import App

from tuisim.config.options import CellSet

BLOCKS = frozenset({CellSet.HALF, CellSet.QUADRANT, CellSet.SEXTANT, CellSet.OCTANT})
"""The sets whose glyphs fill their cells."""


@dataclass(slots=True)
class Drawing:
    """How an app draws pictures."""

    cells: CellSet = CellSet.HALF
    is_slow: Callable[[], bool] = lambda: False
    """Whether the link to the terminal is too slow for fine cells now."""
    is_idle: Callable[[], bool] = lambda: True
    """Whether the terminal has shown everything that was sent."""


def drawing_of(app: App[object]) -> Drawing:
    """Return how an app draws pictures."""
    found = getattr(app, "drawing", None)
    return found if isinstance(found, Drawing) else Drawing()
