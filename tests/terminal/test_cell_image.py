"""Screens of character cells as pictures: which part of a cell each glyph fills, colours, text, and the SVG."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.cases import for_each
from tuisim.terminal.cell_image import CELL_PX, Cell, CellGrid, Look, draw_cells, draw_cells_svg

RED = (255, 0, 0)
BLUE = (0, 0, 255)
WHITE = (255, 255, 255)
BLACK = (0, 0, 0)
LOOK = Look(WHITE, BLACK)
SVG = "{http://www.w3.org/2000/svg}"


def cells(text: str, look: Look = LOOK) -> list[Cell]:
    return [(char, look) for char in text]


def pixels(grid: CellGrid) -> Any:
    return np.asarray(draw_cells(grid))


# What each glyph fills, in parts of its cell.
FILLED = {
    "full block": ("█", ["#"]),
    "upper half": ("▀", ["#", "."]),
    "lower half": ("▄", [".", "#"]),
    "left half": ("▌", ["#."]),
    "right half": ("▐", [".#"]),
    "lower quarter": ("▂", [".", ".", ".", "#"]),
    "quadrants": ("▚", ["#.", ".#"]),
    "quadrant missing": ("▟", [".#", "##"]),
    "first sextant": ("\U0001fb00", ["#.", "..", ".."]),
    "last sextant": ("\U0001fb3b", [".#", "##", "##"]),
    "sextants after the left half": ("\U0001fb14", [".#", "#.", "#."]),
    "octant 3": ("\U0001cd00", ["..", "#.", "..", ".."]),
    "octants 2 and 3": ("\U0001cd01", [".#", "#.", "..", ".."]),
    "last octants": ("\U0001cde5", [".#", "##", "##", "##"]),
    "octant 1": ("\U0001cea8", ["#.", "..", "..", ".."]),
    "middle left": ("\U0001fbe6", ["..", "#.", "#.", ".."]),
    "upper three quarters": ("\U0001fb85", ["#", "#", "#", "."]),
}


@for_each(name=FILLED)
def test_block_characters_in_a_screenshot_fill_their_part_of_the_cell(name: str) -> None:
    char, parts = FILLED[name]
    width, height = CELL_PX
    wanted = np.zeros((height, width), bool)
    rows, columns = len(parts), len(parts[0])
    for y, x in np.ndindex(rows, columns):
        top, bottom = (int(at * height / rows + 0.5) for at in (y, y + 1))
        wanted[top:bottom, x * width // columns : (x + 1) * width // columns] = parts[y][x] == "#"
    assert (pixels([cells(char)]) == np.where(wanted, 255, 0)[..., None]).all()


# Lines that leave a cell through its left, right, upper and lower edge.
LINES = {
    "horizontal": ("─", "LR"),
    "vertical": ("│", "UD"),
    "corner": ("┌", "RD"),
    "arc": ("╯", "LU"),
    "tee": ("┤", "LUD"),
    "cross": ("┼", "LRUD"),
    "heavy": ("━", "LR"),
    "mixed": ("┮", "LRD"),
    "double": ("╚", "RU"),
    "half": ("╷", "D"),
    "rising": ("╱", ""),
    "dashes": ("┆", "U"),
}


@for_each(name=LINES)
def test_line_characters_in_a_screenshot_reach_the_cells_edges(name: str) -> None:
    char, edges = LINES[name]
    light = pixels([cells(char)])[..., 0] > 128
    width, height = CELL_PX
    rows, columns = (
        light[height // 2 - 4 : height // 2 + 4],
        light[:, width // 2 - 3 : width // 2 + 3],
    )
    ends = {"L": rows[:, 0], "R": rows[:, -1], "U": columns[0], "D": columns[-1]}
    assert {side for side, found in ends.items() if found.any()} == set(edges)
    assert light.any()


@pytest.mark.parametrize("char, count", [("⠁", 1), ("⣿", 8), ("⠀", 0)])
def test_braille_characters_in_a_screenshot_have_their_dots(char: str, count: int) -> None:
    light = pixels([cells(char)])[..., 0] > 128
    width, height = CELL_PX
    dots = light.reshape(4, height // 4, 2, width // 2).any(axis=(1, 3))
    assert dots.sum() == count
    assert not count or dots[0, 0]


def test_a_screenshot_has_the_colours_of_the_cells() -> None:
    top, bottom = pixels([[("▀", Look(RED, BLUE)), (" ", Look(RED, WHITE))]]).reshape(
        2, CELL_PX[1] // 2, -1, 3
    )
    assert (top[:, : CELL_PX[0]] == RED).all() and (bottom[:, : CELL_PX[0]] == BLUE).all()
    assert (top[:, CELL_PX[0] :] == WHITE).all()


@pytest.mark.parametrize(
    "look",
    [LOOK, Look(WHITE, BLACK, bold=True), Look(WHITE, BLACK, italic=True)],
    ids=["plain", "bold", "italic"],
)
def test_letters_in_a_screenshot_stay_within_their_cell(look: Look) -> None:
    shown = pixels([cells(" g ", look)])[..., 0]
    (left, middle, right) = np.split(shown, 3, axis=1)
    assert (middle > 128).sum() > 20
    # What leans out of a cell is cut off, as in a terminal.
    assert not left.any() and not right.any()
    assert {
        char: (pixels([cells(char, look)]) > 128).sum() > 10 for char in "äЖλ→●✗"
    } == dict.fromkeys("äЖλ→●✗", True)


def test_bold_text_in_a_screenshot_is_bolder_and_underlines_are_drawn() -> None:
    plain, bold, under, strike = (
        pixels([cells("m", look)])[..., 0].astype(int)
        for look in (
            LOOK,
            Look(WHITE, BLACK, bold=True),
            Look(WHITE, BLACK, underline=True),
            Look(WHITE, BLACK, strike=True),
        )
    )
    assert bold.sum() > plain.sum()
    assert [(shown == 255).all(axis=1).sum() for shown in (plain, under, strike)] == [0, 1, 1]


def test_a_wide_character_in_a_screenshot_takes_two_cells() -> None:
    left, right = np.split(pixels([[("日", LOOK), ("", LOOK)]])[..., 0], 2, axis=1)
    assert left.any() and (left != right).any()


def texts_of(svg: str) -> list[str]:
    return ["".join(node.itertext()) for node in ElementTree.fromstring(svg).iter(f"{SVG}text")]


ROWS: Sequence[tuple[str, list[str]]] = [
    ("a b", ["ab"]),
    ("<&>", ["<&>"]),
    ("│▀⣿", []),
    ("   ", []),
]


@pytest.mark.parametrize("row, texts", ROWS)
def test_an_svg_screenshot_holds_text_as_text(row: str, texts: list[str]) -> None:
    svg = draw_cells_svg([cells(row)], "a <title>")
    assert texts_of(svg) == texts
    root = ElementTree.fromstring(svg)
    assert (root.attrib["width"], root.attrib["height"]) == (str(3 * CELL_PX[0]), str(CELL_PX[1]))


def test_an_svg_screenshot_places_each_letter_in_its_cell() -> None:
    root = ElementTree.fromstring(draw_cells_svg([cells("x  y"), cells("  z ")], ""))
    places = [
        (node.attrib["x"], int(node.attrib["y"]) // CELL_PX[1]) for node in root.iter(f"{SVG}text")
    ]
    assert places == [("0 30", 0), ("20", 1)]
