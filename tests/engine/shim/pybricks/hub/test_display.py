"""The matrix of a hub, its light, and the menu on it."""

from __future__ import annotations

import json
from typing import Any

import pytest

from tests.engine.shim.pybricks.lab import Lab
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.runs.brick_state import PIXEL_NAMES
from tuisim.engine.shim.pybricks.hub.display import Icon, hub_menu
from tuisim.engine.shim.pybricks.hub.hubs import PrimeHub
from tuisim.engine.shim.pybricks.matrix import Side


@pytest.fixture
def lab() -> Lab:
    return Lab(MotorLaw.PYBRICKS_4, {}, hub="PrimeHub")


@pytest.fixture
def hub(lab: Lab) -> Any:
    return PrimeHub()


def read_rows(lab: Lab) -> list[str]:
    levels = json.loads(lab.shown[-1][0])
    pixels = "".join(" .#"[(levels[name] > 0) + (levels[name] > 200)] for name in PIXEL_NAMES)
    return [pixels[at : at + 5] for at in range(0, 25, 5)]


def test_a_hubs_matrix_shows_characters_and_numbers(lab: Lab, hub: Any) -> None:
    hub.display.char("1")
    assert read_rows(lab) == ["  #  ", " ##  ", "  #  ", "  #  ", " ### "]
    hub.display.number(-42)
    assert read_rows(lab)[:3] == ["#  ##", "## ##"[:2] + "  #", "##.##"]
    hub.display.number(100)
    assert read_rows(lab) == [" #   ", "  #  ", "   # ", "  #  ", " #   "]


def test_an_icon_turns_with_the_orientation_of_a_hubs_matrix(lab: Lab, hub: Any) -> None:
    hub.display.icon(Icon.ARROW_UP)  # type: ignore[attr-defined]
    up = read_rows(lab)
    hub.display.orientation(Side.LEFT)
    left = read_rows(lab)
    assert left[2] == "#####" and left[1][1] == "#"
    hub.display.orientation(Side.BOTTOM)
    assert read_rows(lab) == [row[::-1] for row in up[::-1]]


@pytest.mark.parametrize("icon", [[[100] * 5] * 4, [[1, 2], [3, 4]], 7])
def test_only_pictures_of_25_pixels_are_icons(hub: Any, icon: Any) -> None:
    with pytest.raises(ValueError, match="Invalid argument"):
        hub.display.icon(icon)


@pytest.mark.parametrize("count", [1, 256])
def test_an_animation_has_another_number_of_icons_than_a_hub_takes(hub: Any, count: int) -> None:
    with pytest.raises(ValueError, match="Invalid argument"):
        hub.display.animate([[[100] * 5] * 5] * count, 100)


def test_a_hubs_matrix_shows_a_text_character_by_character_and_then_nothing(
    lab: Lab, hub: Any
) -> None:
    hub.display.text("Hi")
    assert lab.now == 2 * (500 + 50) * 1_000_000
    assert read_rows(lab) == ["     "] * 5


@pytest.mark.parametrize("symbols", [("A",), ("A", "BC"), (1, 100)])
def test_a_menu_takes_characters_and_numbers_of_two_digits(
    hub: Any, symbols: tuple[Any, ...]
) -> None:
    with pytest.raises(ValueError, match="Invalid argument"):
        hub_menu(*symbols)


def test_a_menu_is_chosen_from_by_buttons(lab: Lab, hub: Any) -> None:
    presses = {100: "right", 200: "", 300: "right", 400: "", 500: "left", 600: "", 700: "enter"}

    def press(now_ms: int) -> None:
        if now_ms in presses or now_ms == 800:
            lab.pressed = frozenset(filter(None, [presses.get(now_ms, "")]))

    lab.looks.append(press)
    assert hub_menu("A", 2, "C") == 2
    assert 800 <= lab.now // 1_000_000 <= 820
