"""`Font` of `pybricks.media.ev3dev`."""

from __future__ import annotations

from typing import Any

import pytest

from tuisim.engine.shim.pybricks.font import Font, drawable


def test_the_default_font_is_lucida_12() -> None:
    same = Font("Lucida", 12)
    assert (Font.DEFAULT.family, Font.DEFAULT.style, Font.DEFAULT.height) == (
        "Lucida",
        "Regular",
        15,
    )
    assert (same.width, same.text_width("Hello")) == (
        Font.DEFAULT.width,
        Font.DEFAULT.text_width("Hello"),
    )


def test_fonts_of_different_sizes_differ_in_height_and_width() -> None:
    small = Font(size=8)
    large = Font(None, 24, bold=True)
    assert small.height < Font.DEFAULT.height < large.height
    assert small.text_width("Hello") < Font.DEFAULT.text_width("Hello") < large.text_width("Hello")
    assert large.style == "Bold"


@pytest.mark.parametrize("size_px, cell_px", [(12, 7), (24, 14), (30, 18)])
def test_characters_of_a_monospaced_font_are_equally_wide(size_px: int, cell_px: int) -> None:
    font = Font(size=size_px, monospace=True)
    assert [font.text_width(text) for text in ("i", "W", "iW il")] == [
        cell_px,
        cell_px,
        5 * cell_px,
    ]
    assert font.width == cell_px


def test_text_height_is_the_fonts_line_height_for_any_text() -> None:
    assert Font.DEFAULT.text_height("") == Font.DEFAULT.text_height("gÄ") == Font.DEFAULT.height
    assert Font.DEFAULT.text_width("") == 0


@pytest.mark.slow
def test_a_font_is_no_higher_than_the_screen() -> None:
    assert Font(size=1_000_000).height == Font(size=128).height


@pytest.mark.parametrize(
    "given, error",
    [({"size": 0}, ValueError), ({"size": "12"}, TypeError), ({"family": 12}, TypeError)],
)
def test_a_font_with_impossible_arguments_is_refused(
    given: dict[str, Any], error: type[Exception]
) -> None:
    with pytest.raises(error):
        Font(**given)


def test_characters_that_a_font_lacks_are_drawn_as_question_marks() -> None:
    assert drawable("Größe 5 €\t✓\x07") == "Größe 5 ? ? "
