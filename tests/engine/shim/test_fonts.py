"""The fonts of the brick: each name can be loaded, and looks as its name says."""

from __future__ import annotations

import pytest
from PIL.ImageFont import ImageFont

from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn
from tests.engine.shim.table_display import FONTS
from tests.running import Run
from tuisim.engine.shim.fonts import FACES, drawn

LATIN = "".join(map(chr, (*range(33, 127), *range(161, 256))))


def ink(font: ImageFont, text: str) -> int:
    """Count the dark pixels of a text."""
    mask = font.getmask(text)
    return sum(mask.getpixel((x, y)) > 0 for x in range(mask.size[0]) for y in range(mask.size[1]))


@pytest.mark.slow
@pytest.mark.parametrize("name", FACES)
def test_every_letter_of_a_font_leaves_ink(name: str) -> None:
    font = drawn(FACES[name])
    assert not [letter for letter in LATIN if letter != "\xad" and not ink(font, letter)]


@pytest.mark.parametrize(
    ("name", "width"),
    [
        ("courB08", 5),
        ("courR14", 9),
        ("courB18", 11),
        ("courBO24", 15),
        ("lutRS19", 11),
        ("term14", 8),
    ],
)
def test_a_fixed_font_has_letters_of_one_width(name: str, width: int) -> None:
    font = drawn(FACES[name])
    assert {font.getlength(letter) for letter in "iW.@ü "} == {width}


@pytest.mark.parametrize(
    ("lighter", "bolder"),
    [("courR24", "courB24"), ("helvO12", "helvBO12"), ("luRS18", "luBS18"), ("term14", "termB14")],
)
def test_bold_letters_have_more_ink(lighter: str, bolder: str) -> None:
    assert ink(drawn(FACES[bolder]), "Hello") > 1.2 * ink(drawn(FACES[lighter]), "Hello")


@pytest.mark.quick_cases("helvR")
@pytest.mark.parametrize("family", ["charI", "helvR", "ncenB"])
def test_letters_are_as_high_as_the_fonts_name_says(family: str) -> None:
    heights = [
        drawn(FACES[f"{family}{size:02}"]).getmask("H").getbbox() for size in (8, 12, 18, 24)
    ]
    assert [bottom - top for _, top, _, bottom in heights] == pytest.approx([6, 9, 13, 17], abs=1)


def test_slanted_letters_lean_to_the_right() -> None:
    def middles(name: str) -> tuple[float, float]:
        mask = drawn(FACES[name]).getmask("l")
        columns = [
            [x for x in range(mask.size[0]) if mask.getpixel((x, y))] for y in range(mask.size[1])
        ]
        inked = [sum(row) / len(row) for row in columns if row]
        return inked[0], inked[-1]

    top, bottom = middles("timI24")
    assert top > bottom + 2


@pytest.mark.quick_cases("ev3")
@pytest.mark.parametrize("profile", ["robolab", "ev3"])
def test_fonts_that_are_drawn_are_told_once(run_on: RunOn, profile: str) -> None:
    done = run_on(
        "from ev3dev2 import fonts\nfrom ev3dev2.display import Display\n"
        "font = fonts.load('courB18')\nd = Display()\nd.text_pixels('Hello', font=font)\n"
        "d.text_pixels('Hello', False, 0, 40, font='courB24')\nd.text_grid('x', False, 3, 3, font='timR08')\n"
        "print(font.getlength('Hello'), d.draw.textbbox((0, 0), 'i', font=fonts.load('courB24'))[2])",
        profile=profile,
    )
    assert done.lines == ["55 15"]
    assert done.errors == [
        "courB18: the published library has no font files; another font stands in, of that size and weight"
    ]


def test_deprecations_of_pillow_do_not_warn_a_program_for_the_brick(
    run: Run,
) -> None:
    warn = "warnings.warn('x is deprecated and will be removed in Pillow 14 (2027-10-15).', DeprecationWarning)"
    assert not run(f"import warnings\nfrom PIL import Image\n{warn}", prelude="none").errors


TABLES: Tables = {
    "fonts": (FONTS, "plain", "empty"),
}


@cases(TABLES)
def test_each_font_loads_and_draws_as_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
