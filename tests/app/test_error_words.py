"""What matters of an error, in the room that there is."""

from __future__ import annotations

import pytest

from tests.cases import for_rows
from tuisim.app.error_words import find_remedy, fit_words, shorten_error
from tuisim.base.errors import TuisimError

PORT = (
    "ev3dev2.DeviceNotFound: ColorSensor(ev3-ports:in1) is not connected. This robot has: in1 lego-ev3-us, "
    "in2 lego-ev3-color, in4 lego-ev3-gyro. Another robot: -r ROBOT; `tuisim robots --from PROGRAM --out FILE` writes "
    "the program's own."
)
TYPO = (
    "AttributeError: 'ColorSensor' object has no attribute 'reflected_lihgt_intensity'. "
    "Did you mean: 'reflected_light_intensity'?"
)
NAME = "NameError: name 'tank_drvie' is not defined. Did you mean: 'tank_drive'?"
IMPORT = "NameError: name 'sleep' is not defined. Did you forget `from time import sleep`?"
MAT = "line 1: no such mat 'Grey_bnds', did you mean Grey_bands?"


@for_rows(
    "words, width, told",
    {
        "it fits": (NAME, 76, NAME),
        "without its class": (NAME, 64, NAME.removeprefix("NameError: ")),
        "without its sentence": (NAME, 50, "no tank_drvie: did you mean tank_drive?"),
        "80x24": (
            TYPO,
            76,
            "no reflected_lihgt_intensity: did you mean reflected_light_intensity?",
        ),
        "what is meant": (TYPO, 39, "did you mean reflected_light_intensity?"),
        "only the name": (TYPO, 28, "reflected_light_intensity?"),
        "import": (IMPORT, 62, "no sleep: did you forget `from time import sleep`?"),
        "only the import": (IMPORT, 39, "`from time import sleep`?"),
        "mat": (MAT, 39, "no Grey_bnds: did you mean Grey_bands?"),
        "port, 80x24": (
            PORT,
            76,
            "no ColorSensor on in1; the robot has in1 us, in2 color, in4 gyro",
        ),
        "port and parts": (PORT, 54, "no ColorSensor on in1: in1 us, in2 color, in4 gyro"),
        "parts": (PORT, 39, "in1 us, in2 color, in4 gyro"),
        "another error": ("ZeroDivisionError: division by zero", 20, "division by zero"),
        "cut": ("SyntaxError: a very long sentence about it", 20, "a very long sentenc…"),
        "no room": ("boom", 0, ""),
    },
)
def test_the_cause_of_an_error_comes_first_in_a_short_row(
    words: str, width: int, told: str
) -> None:
    assert fit_words(words, width) == told


@pytest.mark.parametrize(
    "words, told",
    [
        (PORT, "no ColorSensor on in1: in1 us, in2 color, in4 gyro. {robot} chooses another robot"),
        (TYPO, "{went-wrong} goes there"),
        ("ValueError: no", "{went-wrong} goes there"),
    ],
)
def test_the_row_of_an_error_says_how_to_remedy_it(words: str, told: str) -> None:
    assert find_remedy(words) == told


@pytest.mark.parametrize(
    "hint, told",
    [
        (
            "did you mean Loop? one of Loop, Square, or the path of an image",
            "no mat 'lop' (did you mean Loop?)",
        ),
        ("one of Loop, Square, or the path of an image", "no mat 'lop'"),
        ("see `tuisim programs` for examples", "no mat 'lop'"),
        ("at most 10 mm", "no mat 'lop' (at most 10 mm)"),
    ],
)
def test_an_error_shown_below_a_list_does_not_repeat_the_lists_names(hint: str, told: str) -> None:
    assert shorten_error(TuisimError("no mat 'lop'", hint)) == told
