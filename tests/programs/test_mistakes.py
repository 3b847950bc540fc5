"""Why a program cannot run: its faults, and the mistake that is shown of them."""

from __future__ import annotations

import pytest

from tests.cases import for_rows
from tuisim.programs.mistakes import find_fault
from tuisim.programs.program_file import find_mistake

NO_TEXT = "'rot13' is not a text encoding; use codecs.encode() to handle arbitrary codecs"
FAULTS = {
    "good": ("print(1)\n", None),
    "empty": ("", None),
    "a bracket": ("print(1\n", ("'(' was never closed", 1)),
    "outside of a function": ("x = 1\nreturn x\n", ("'return' outside function", 2)),
    "an encoding that there is not": ("# coding: klingon\n", ("unknown encoding: klingon", 0)),
    "one that is no text": ("# coding: rot13\n", (NO_TEXT, 0)),
    "one of domain names": (
        "# coding: punycode\n",
        ("'punycode' is an encoding of domain names", 0),
    ),
    "UTF-7": ("# coding: utf-7\nprint('Ä ~')\n", None),
    "Latin-1": ("# coding: latin-1\nprint('Ä ~')\n", None),
    "an odd escape, which is only warned of": ("print('\\d')\n", None),
}


@for_rows("text, fault", FAULTS)
def test_a_program_that_does_not_compile_has_a_fault(
    text: str, fault: tuple[str, int] | None
) -> None:
    assert find_fault(text) == fault


@pytest.mark.parametrize(
    "text, line, words",
    [
        ("x = 1\n", None, ""),
        ("%%sim_magic_preloaded -b Grey_bands\nprint(colorLeft)\n", None, ""),
        ("x = 1\nif x\n    pass\n", 2, "line 2: expected ':'"),
        ("return 3\n", 1, "line 1: 'return' outside function"),
        ("# %%sim_magic -b\n", 1, "-b"),
        ("assert (1, 'x is \\d')\n", None, ""),
        ("x = " + "(" * 500 + ")" * 500, 1, "nested"),
    ],
    ids=["good", "magic", "syntax", "outside", "wrong magic", "warning", "deep"],
)
def test_a_faulty_program_is_explained_at_its_line(text: str, line: int | None, words: str) -> None:
    found = find_mistake(text, "p.py")
    if line is None:
        assert found is None
    else:
        assert found is not None
        assert found.line == line
        assert words in found.message
