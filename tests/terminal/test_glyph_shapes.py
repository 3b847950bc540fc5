"""Blocks, dots, lines and arcs as shapes in a cell of any size."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tuisim.terminal.glyph_shapes import Bend, GlyphArea, GlyphShape, draw_character


def painted(shapes: tuple[GlyphShape, ...] | None) -> set[tuple[int, int]]:
    """Pixels that areas cover."""
    areas = [shape for shape in shapes or () if isinstance(shape, GlyphArea)]
    edges = [tuple(map(int, (at.left, at.top, at.right, at.bottom))) for at in areas]
    return {
        (x, y)
        for left, top, right, bottom in edges
        for x in range(left, right)
        for y in range(top, bottom)
    }


@pytest.mark.parametrize("width, height", [(4, 8), (7, 15), (20, 41)])
@pytest.mark.parametrize("char", "┼╬╋")
def test_crossing_line_characters_are_drawn_to_all_edges_of_the_cell(
    char: str, width: int, height: int
) -> None:
    found = painted(draw_character(char, width, height))
    assert {0, width - 1} <= {x for x, _ in found}
    assert {0, height - 1} <= {y for _, y in found}
    assert all(0 <= x < width and 0 <= y < height for x, y in found)


def test_an_eighth_block_in_a_small_cell_is_drawn_one_pixel_high() -> None:
    assert painted(draw_character("▁", 3, 3)) == {(x, 2) for x in range(3)}
    assert painted(draw_character("▔", 3, 3)) == {(x, 0) for x in range(3)}


def test_an_arc_character_ends_where_lines_of_the_next_cells_begin() -> None:
    (arc,) = draw_character("╭", 8, 16) or ()
    assert isinstance(arc, Bend)
    assert (arc.points[0], arc.points[-1]) == ((3.5, 16.0), (8.0, 7.5))


@pytest.mark.parametrize("char, count", [("┄", 3), ("┈", 4), ("╌", 2)])
def test_dashed_lines_have_their_number_of_dashes(char: str, count: int) -> None:
    columns = sorted({x for x, _ in painted(draw_character(char, 24, 24))})
    gaps = sum(after - before > 1 for before, after in pairwise(columns))
    assert gaps + 1 == count
