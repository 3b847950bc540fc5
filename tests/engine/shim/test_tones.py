"""Tones as `beep` takes them."""

from __future__ import annotations

import pytest

from tests.cases import for_each
from tuisim.engine.shim.tones import Tone, parse_beep


@pytest.mark.parametrize(
    "words, tones",
    [
        ("", [Tone(440, 200)]),
        ("-f 500", [Tone(500, 200)]),
        ("-f500 -l 10", [Tone(500, 10)]),
        ("-r 2", [Tone(440, 200, 100), Tone(440, 200)]),
        ("-r 2 -D 5", [Tone(440, 200, 5)] * 2),
        ("-r 0", []),
        ("-l 1 -n -l 2 --new -l 3 -d 9", [Tone(440, 1), Tone(440, 2), Tone(440, 3)]),
    ],
)
def test_options_of_the_beep_command_are_read_as_tones(words: str, tones: list[Tone]) -> None:
    assert parse_beep(words.split()) == tones


@for_each(
    words=[
        "-f",
        "-f x",
        "-f 20001",
        "-f -1",
        "-l -1",
        "-l inf",
        "-D nan",
        "-r 1e9",
        "-r -1",
        "-x",
        "loud",
    ]
)
def test_the_beep_command_refuses_wrong_options(words: str) -> None:
    with pytest.raises(ValueError):
        parse_beep(words.split())
