"""Other values of a program's constants."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tuisim.base.errors import ConfigError
from tuisim.programs.constants import set_constants
from tuisim.programs.program_file import parse_program

PROGRAM = """\
ä = "é"; GAIN = 1.2  # per cent
SPEEDS: list = [
    10,
    20,
]
TWICE = 1
TWICE = 2
def go():
    LOCAL = 1
"""
CHANGED = """\
ä = 'ü'; GAIN = 0.5  # per cent
SPEEDS: list = [1]



TWICE = 1
TWICE = 2
def go():
    LOCAL = 1
"""


def test_set_constants_replaces_values_and_keeps_line_numbers() -> None:
    source = parse_program(PROGRAM, "program")
    values = {"GAIN": 0.5, "SPEEDS": [1], "ä": "ü"}
    assert set_constants(source, values).program.text == CHANGED
    assert set_constants(source, {}) is source


@cases(
    "text, name, words",
    {
        "misspelt": (PROGRAM, "GAINS", "program has no constant GAINS .did you mean GAIN?"),
        "in a function": (PROGRAM, "LOCAL", "has no constant LOCAL"),
        "twice": (PROGRAM, "TWICE", "assigns 2 values to TWICE"),
        "no Python": ("x = = 1\n", "x", "is not Python"),
    },
)
def test_a_name_that_is_no_constant_cannot_be_set(text: str, name: str, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        set_constants(parse_program(text, "program"), {name: 1})
