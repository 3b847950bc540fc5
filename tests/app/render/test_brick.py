"""The brick is drawn as what it shows, at every size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tuisim.app.render.brick import draw_brick, name_led, shrink_pixels
from tuisim.engine.core.spec import BUTTONS
from tuisim.engine.runs.brick_state import (
    DISPLAY_HEIGHT,
    DISPLAY_WIDTH,
    ROW_BYTES,
    BrickState,
    TextScreen,
)

SIZES = [(178, 70), (118, 37), (78, 20), (44, 12), (26, 6), (12, 3), (1, 1)]


def picture(*dark: tuple[slice, slice]) -> bytes:
    """A picture that is dark in some places."""
    ink = np.zeros((DISPLAY_HEIGHT, ROW_BYTES * 8), np.uint8)
    for place in dark:
        ink[place] = 1
    return np.packbits(ink).tobytes()


def text_of(face: BrickState, width: int, height: int) -> list[str]:
    return ["".join(text for text, _ in line) for line in draw_brick(face, (), width, height).lines]


@pytest.mark.parametrize("width, height", SIZES)
def test_the_drawn_brick_is_no_wider_or_higher_than_its_panel(width: int, height: int) -> None:
    face = BrickState(
        picture=picture((slice(0, 60), slice(0, 90))), text=TextScreen(14, 5, ("x" * 14,) * 5)
    )
    for shown in (face, BrickState(text=face.text, shows_text=True), BrickState()):
        drawn = draw_brick(replace(shown, sound="la la la" * 20), {"enter"}, width, height)
        lines = ["".join(text for text, _ in line) for line in drawn.lines]
        assert len(lines) <= height
        # The row of buttons needs its room; a panel so narrow cuts it.
        assert max(map(len, lines)) <= max(width, 27)


def test_the_bricks_display_shows_every_pixel_where_there_is_room() -> None:
    lines = draw_brick(
        BrickState(picture=picture((slice(10, 11), slice(20, 30)))), (), 178, 70
    ).lines
    cells = [[(char, style) for text, style in line for char in text] for line in lines]
    dark = [column for row in cells for column, (char, _) in enumerate(row) if char == "▀"]
    assert dark == list(range(20, 30))


@pytest.mark.parametrize("width, height", [(60, 24), (30, 9), (16, 6)])
def test_a_small_display_keeps_every_thin_line(width: int, height: int) -> None:
    def dots(*place: slice) -> int:
        lines = text_of(BrickState(picture=picture((place[0], place[1]))), width, height)
        return sum(0x2800 < ord(char) <= 0x28FF for line in lines for char in line)

    everything = slice(None)
    assert all(dots(slice(row, row + 1), everything) for row in range(DISPLAY_HEIGHT))
    assert all(dots(everything, slice(column, column + 1)) for column in range(DISPLAY_WIDTH))


def test_a_display_drawn_smaller_shows_the_mean_of_its_pixels() -> None:
    ink = np.zeros((4, 4), np.uint8)
    ink[:2, :2] = 1
    ink[3, 3] = 1
    assert shrink_pixels(ink, 2, 2).tolist() == [[1.0, 0.0], [0.0, 0.25]]


def test_the_bricks_text_screen_is_shown_as_text() -> None:
    screen = TextScreen(14, 5, ("Mission 1", "", "go", "", ""), ((0, 0, 7),))
    lines = text_of(BrickState(text=screen, shows_text=True), 40, 14)
    assert [line.strip() for line in lines if line.strip() in ("Mission 1", "go")] == [
        "Mission 1",
        "go",
    ]


@pytest.mark.parametrize("width, height", [(60, 20), (44, 6)], ids=["pad", "row"])
def test_buttons_are_where_they_are_drawn(width: int, height: int) -> None:
    drawn = draw_brick(BrickState(), {"enter", "left"}, width, height)
    assert {box.name for box in drawn.buttons} == set(BUTTONS)
    symbols = {"backspace": "⌫", "up": "▲", "left": "◀", "enter": "●", "right": "▶", "down": "▼"}
    for box in drawn.buttons:
        whole = "".join(text for text, _ in drawn.lines[box.row])
        assert whole[box.first : box.end].strip() == symbols[box.name]


def test_a_pressed_button_stands_out() -> None:
    lit = {
        text.strip()
        for line in draw_brick(BrickState(), {"enter"}, 60, 20).lines
        for text, style in line
        if style.bgcolor
        and style.bgcolor.triplet
        and style.bgcolor.triplet.red == 255
        and text.strip() in "▲●◀▶▼⌫"
    }
    assert "●" in lit
    assert "▲" not in lit


@pytest.mark.parametrize(
    "red, green, name",
    [
        (0, 0, "off"),
        (255, 0, "red"),
        (0, 255, "green"),
        (255, 255, "amber"),
        (255, 127, "orange"),
        (25, 255, "yellow"),
    ],
)
def test_the_bricks_lights_are_named_by_their_colour(red: int, green: int, name: str) -> None:
    assert name_led(red, green) == name
    leds = {"left red": red, "left green": green, "right red": 0, "right green": 0}
    assert any(name in line for line in text_of(BrickState(leds=leds), 60, 20))


def test_the_bricks_lights_are_green_until_a_program_changes_them() -> None:
    assert sum(line.count("green") for line in text_of(BrickState(), 60, 20)) == 2


@pytest.mark.parametrize(
    "sound, shown",
    [
        ("[♪ song of 3 notes, 1.5 s]", "♪ song of 3 notes, 1.5 s"),
        ("[beep]", "♪ beep"),
        ("hello", "♪ hello"),
        ("", ""),
    ],
)
def test_the_last_sound_is_named_below_the_brick(sound: str, shown: str) -> None:
    assert text_of(BrickState(sound=sound), 60, 20)[-1].strip() == shown


@pytest.mark.parametrize("width, shown", [(60, "green"), (31, "gr…"), (27, "")], ids=str)
def test_the_name_of_a_lamp_is_cut_with_an_ellipsis(width: int, shown: str) -> None:
    (row,) = [line for line in text_of(BrickState(), width, 6) if "▲" in line]
    assert row.split("⌫")[0].strip() == shown
