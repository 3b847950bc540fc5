"""The tables of block glyphs and dots."""

from __future__ import annotations

import unicodedata

import numpy as np
import pytest

from tests.cases import for_rows
from tuisim.terminal.glyphs import GLYPHS, build_glyph_set
from tuisim.terminal.picture_options import CellSet


def shown(cells: CellSet) -> dict[str, str]:
    """The points of each glyph, row by row from the upper left."""
    glyphs = build_glyph_set(cells)
    points = ["".join("#" if point else "." for point in covered) for covered in glyphs.covered]
    return dict(zip((GLYPHS[number] for number in glyphs.numbers), points, strict=True))


@for_rows(
    "cells, glyph, points",
    {
        "upper half": (CellSet.HALF, "▀", "#."),
        "quadrants 1 2 3": (CellSet.QUADRANT, "▛", "###."),
        "a diagonal": (CellSet.QUADRANT, "▚", "#..#"),
        "sextant 1": (CellSet.SEXTANT, "\N{BLOCK SEXTANT-1}", "#....."),
        "sextants 12346": (CellSet.SEXTANT, "\N{BLOCK SEXTANT-12346}", "####.#"),
        "the left half, which is older": (CellSet.SEXTANT, "▌", "#.#.#."),
        # The names of octants are in The Unicode Standard 16.0, Symbols for Legacy Computing Supplement.
        "octants 123": (CellSet.OCTANT, "\U0001cd02", "###....."),
        "octants 1345678": (CellSet.OCTANT, "\U0001cde4", "#.######"),
        "octant 1, left half upper one quarter block": (CellSet.OCTANT, "\U0001cea8", "#......."),
        "octants 12, upper one quarter block": (CellSet.OCTANT, "\U0001fb82", "##......"),
        "a quadrant": (CellSet.OCTANT, "▙", "#.#.####"),
        "dot 1": (CellSet.BRAILLE, "\N{BRAILLE PATTERN DOTS-1}", "#......."),
        "dots 478": (CellSet.BRAILLE, "\N{BRAILLE PATTERN DOTS-478}", ".#....##"),
    },
)
def test_each_glyph_is_chosen_for_its_pattern_of_points(
    cells: CellSet, glyph: str, points: str
) -> None:
    assert shown(cells)[glyph] == points


@pytest.mark.parametrize("cells", list(CellSet)[1:5])
def test_every_pattern_of_a_cells_points_has_exactly_one_glyph(cells: CellSet) -> None:
    glyphs = build_glyph_set(cells)
    points = glyphs.rows * glyphs.cols
    patterns = {tuple(row) for row in glyphs.covered} | {tuple(1 - row) for row in glyphs.covered}

    assert len(glyphs.numbers) == 2 ** (points - 1) - 1 or cells is CellSet.BRAILLE
    assert len(patterns) == 2**points - 2
    assert (np.diff(glyphs.numbers) > 0).all()


def test_the_points_of_each_sextant_glyph_match_its_unicode_name() -> None:
    for glyph, points in shown(CellSet.SEXTANT).items():
        name = unicodedata.name(glyph, "")
        if name.startswith("BLOCK SEXTANT-"):
            assert name.removeprefix("BLOCK SEXTANT-") == "".join(
                str(at) for at, point in enumerate(points, 1) if point == "#"
            )
