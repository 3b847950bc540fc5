"""Errors of programs for which Python has no hint."""

from __future__ import annotations

from tests.cases import cases
from tests.running import Run

HINTS = {
    "a part of a name": (
        "colorLeft.reflected_light",
        "'ColorSensor' object has no attribute 'reflected_light'. Did you mean: 'reflected_light_intensity'?",
    ),
    "another word": (
        "tank_drive.forward(3)",
        "'MoveTank' object has no attribute 'forward'. Did you mean: 'on'?",
    ),
    "a name that Python suggests": (
        "tank_drive.onn(1)",
        "'MoveTank' object has no attribute 'onn'. Did you mean: 'on'?",
    ),
    "a number after text": (
        "'Colour: ' + colorLeft.reflected_light_intensity",
        'can only concatenate str (not "int") to str. `str(number)` makes text of a number',
    ),
    "a number before text": (
        "1.5 + ' cm'",
        "unsupported operand type(s) for +: 'float' and 'str'. `str(number)` makes text of a number",
    ),
    "an object of the program": (
        "class Mine:\n    light_left = 1\nMine().light",
        "'Mine' object has no attribute 'light'",
    ),
    "text and a list": ("'a' + []", 'can only concatenate str (not "list") to str'),
}


@cases("text, words", HINTS)
def test_an_error_has_a_hint(run: Run, text: str, words: str) -> None:
    done = run(text, prelude="preloaded")
    summary = done.ended.summary.partition(": ")[2]
    assert summary.rpartition(" (line")[0] == words
    assert words in "\n".join(done.errors)
