"""What the brick shows travels through the output rows unchanged."""

from __future__ import annotations

import random

import pytest

from tuisim.engine.runs.brick_state import (
    BLANK,
    BrickState,
    TextScreen,
    build_console_row,
    build_led_row,
    build_motors_row,
    display_row,
)
from tuisim.engine.runs.records import OutputRow, Stream


def row(text: str, stream: Stream) -> OutputRow:
    return OutputRow(text, 1, 10, 3, stream)


def test_a_brick_without_output_is_blank() -> None:
    face = BrickState().update_face([row("Colour: 3", Stream.STDOUT)])
    assert face == BrickState()
    assert not any(face.picture)


def test_the_bricks_state_has_the_last_lights_picture_and_text_of_the_output() -> None:
    picture = random.Random(5).randbytes(len(BLANK))
    screen = TextScreen(14, 5, ("hello", "", "", "", ""), ((0, 1, 3),))
    lights = {"left red": 255, "left green": 0, "right red": 7, "right green": 128}
    face = BrickState().update_face(
        [
            row(build_led_row(lights), Stream.LED),
            row(display_row(picture), Stream.DISPLAY),
            row(build_console_row(screen), Stream.CONSOLE),
        ],
    )
    assert face == BrickState(lights, picture, screen, True)


def test_the_newest_screen_of_text_or_picture_is_shown() -> None:
    screen = TextScreen(14, 5, ("",) * 5)
    face = BrickState().update_face(
        [row(build_console_row(screen), Stream.CONSOLE), row(display_row(BLANK), Stream.DISPLAY)],
    )
    assert face.text == screen
    assert not face.shows_text


def test_the_bricks_state_has_the_last_sound() -> None:
    assert (
        BrickState()
        .update_face(
            [
                row("[beep]", Stream.SPEECH),
                row("hello", Stream.SPEECH),
                row("Colour: 3", Stream.STDOUT),
            ],
        )
        .sound
        == "hello"
    )


def test_motors_without_a_newer_row_are_drawn_turning_on_evenly() -> None:
    face = BrickState().update_face(
        [row(build_motors_row([(90.0, -50.0), (1.5, 0.0)]), Stream.MOTORS)]
    )
    # The row is of tick 1.
    (turning, standing) = face.extrapolate_turns(2.01, 100)
    assert turning == pytest.approx((-10.0, -50.0))
    assert standing == (1.5, 0.0)
