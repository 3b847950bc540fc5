"""Colours of version 4."""

from __future__ import annotations

from typing import Any

import pytest

from tests.cases import for_rows
from tuisim.engine.shim.pybricks.hsv_color import Color
from tuisim.engine.shim.pybricks.image import paint_of


@for_rows(
    "color, hsv",
    {
        "usual": (Color(20), (20, 100, 100)),
        "hue round": (Color(380, 50, 40), (20, 50, 40)),
        "limits": (Color(-10, 150, -120), (350, 100, -100)),
        "fractions": (Color(20.9, 30.9, 40.9), (20, 30, 40)),
        "darker": (Color.RED * 0.255, (0, 100, 25)),
        "from the left": (0.5 * Color.BROWN, (30, 100, 25)),
        "divided": (Color.RED / 3, (0, 100, 33)),
        "whole": (Color.RED // 4, (0, 100, 25)),
        "shifted": (Color.MAGENTA >> 90, (30, 100, 100)),
        "back": (Color.RED << 30, (330, 100, 100)),
    },
)
def test_a_color_has_a_hue_a_saturation_and_a_value(
    color: Color, hsv: tuple[int, int, int]
) -> None:
    assert (color.h, color.s, color.v) == (*color,) == (color[0], color[1], color[2]) == hsv


def test_colors_are_equal_by_their_numbers() -> None:
    assert Color.RED == Color(0, 100, 100) != Color.BROWN
    assert Color.RED != "Color.RED"
    assert {Color.GREEN: 1}[Color(120)] == 1


def test_a_pybricks_color_is_printed_by_its_name_or_numbers() -> None:
    assert (str(Color.CYAN), str(Color(180, 90, 80))) == ("Color.CYAN", "Color(h=180, s=90, v=80)")


def test_a_program_can_add_its_own_named_colors() -> None:
    colors: Any = Color
    own = Color(20, 60, 90)
    colors.SKIN = own
    try:
        assert (str(colors.SKIN), colors["SKIN"], str(own)) == (
            "Color.SKIN",
            own,
            "Color(h=20, s=60, v=90)",
        )
        assert [*colors][-1] == "SKIN"
        with pytest.raises(TypeError):
            colors.WRONG = 5
        with pytest.raises(KeyError):
            colors["WRONG"]
    finally:
        del colors.SKIN


def test_a_pybricks_color_is_drawn_in_its_rgb_value() -> None:
    assert (paint_of(Color.WHITE), paint_of(Color.NONE)) == ((255, 255, 255), None)
    assert paint_of(Color(120, 100, 50)) == (0, 128, 0)
    with pytest.raises(TypeError):
        paint_of(5)
