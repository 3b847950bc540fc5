"""Strips of half-block cells are strips like any other, and drawn ones go with their widget."""

from __future__ import annotations

from weakref import ref

from rich.style import Style
from textual._styles_cache import StylesCache
from textual.color import Color

import tuisim.app.terminal_app  # noqa: F401  # what it changes in Textual is tested
from tuisim.terminal.cell_view import CellStrip


def test_cropping_or_dividing_a_cell_strip_gives_cell_strips() -> None:
    cells = CellStrip(list(range(10)))

    assert [piece.cell_length for piece in cells.divide([3, 10])] == [3, 7]
    assert all(isinstance(piece, CellStrip) for piece in [cells.crop(2, 5), *cells.divide([3, 10])])
    assert cells.crop(20, 30).cell_length == 0


def test_a_cell_strip_can_be_used_like_a_textual_strip() -> None:
    strip = CellStrip([0xFF0000_0000FF, 0x00FF00_00FF00])

    assert strip.text == "▀ "
    assert strip.adjust_cell_length(4, Style()).cell_length == 4
    assert strip.crop_extend(0, 3, Style()).cell_length == 3
    assert strip.apply_style(Style(bold=True)).text == "▀ "
    assert bool(strip)
    assert not CellStrip([])


def test_cached_rows_of_a_widget_are_freed_with_it() -> None:
    drawn = StylesCache()
    black = Color(0, 0, 0)
    assert drawn.get_inner_outer(black, Color(9, 9, 9)) == drawn.get_inner_outer(
        black, Color(9, 9, 9)
    )
    kept = ref(drawn)
    del drawn
    assert kept() is None
