"""A hub as lines of text."""

from __future__ import annotations

import pytest

from tuisim.app.render.hub import draw_hub
from tuisim.engine.runs.brick_state import BrickState

FACE = BrickState(leds={"red": 255, "green": 0, "blue": 0, "00": 255, "44": 120}, sound="[beep]")


def read_texts(width: int, height: int, *, has_matrix: bool = True) -> list[str]:
    picture = draw_hub(FACE, {"enter"}, width, height, ("F",), has_matrix=has_matrix)
    return ["".join(text for text, _ in line).rstrip() for line in picture.lines]


def test_a_hubs_lit_pixels_differ_from_dark_ones_also_without_colours() -> None:
    texts = read_texts(40, 12)
    assert [text.split() for text in texts[:5]] == [
        ["■", *"····"],
        *[[*"·····"]] * 3,
        [*"····", "■"],
    ]
    assert texts[5].split() == ["◀", "●", "▶", "B"]
    assert texts[6].split() == ["F", "□"] and texts[7] == "♪ beep"


@pytest.mark.parametrize(("height", "rows"), [(1, 1), (3, 3), (6, 6)])
def test_a_drawn_hub_keeps_its_buttons_where_room_is_short(height: int, rows: int) -> None:
    texts = read_texts(30, height)
    assert len(texts) == rows
    assert any("●" in text for text in texts)


def test_a_hub_without_a_matrix_has_one_button() -> None:
    picture = draw_hub(FACE, (), 30, 10, has_matrix=False)
    assert [box.name for box in picture.buttons] == ["enter"]


def test_a_drawn_hubs_buttons_have_their_clickable_places() -> None:
    picture = draw_hub(FACE, (), 30, 10)
    assert [box.name for box in picture.buttons] == ["left", "enter", "right", "up"]
    assert {box.row for box in picture.buttons} == {5}


@pytest.mark.parametrize(("width", "rows"), [(40, 1), (24, 2)])
def test_the_keys_of_a_remote_control_cannot_be_clicked(width: int, rows: int) -> None:
    connected = BrickState(leds={"remote red": 0, "remote green": 255, "remote blue": 0})
    picture = draw_hub(connected, {"remote.left"}, width, 6 + rows)
    texts = ["".join(text for text, _ in line) for line in picture.lines]
    keys = [box for box in picture.buttons if box.name.startswith("remote.")]
    assert [texts[box.row][box.first : box.end].strip() for box in keys] == [
        *("L+", "L", "L-", "●", "R+", "R", "R-")
    ]
    assert {box.row for box in keys} == {*range(6, 6 + rows)}
    assert max(map(len, texts)) <= width
    assert len(draw_hub(connected, (), width, 6).lines) <= 6


def test_a_light_on_a_hubs_port_is_shown_with_its_brightness() -> None:
    picture = draw_hub(BrickState(leds={"light B": 204}), (), 30, 10, has_matrix=False)
    assert "".join(text for text, _ in picture.lines[1]).strip() == "B light 80 %"
