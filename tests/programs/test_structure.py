"""Whether a program compiles."""

from __future__ import annotations

from tests.cases import cases
from tuisim.programs.structure import find_fault

NO_TEXT = "'rot13' is not a text encoding; use codecs.encode() to handle arbitrary codecs"
FAULTS = {
    "good": ("print(1)\n", None),
    "empty": ("", None),
    "a bracket": ("print(1\n", ("'(' was never closed", 1)),
    "outside of a function": ("x = 1\nreturn x\n", ("'return' outside function", 2)),
    "an encoding that there is not": ("# coding: klingon\n", ("unknown encoding: klingon", 0)),
    "one that is no text": ("# coding: rot13\n", (NO_TEXT, 0)),
    "UTF-7": ("# coding: utf-7\nprint('Ä ~')\n", None),
    "Latin-1": ("# coding: latin-1\nprint('Ä ~')\n", None),
    "an odd escape, which is only warned of": ("print('\\d')\n", None),
}


@cases("text, fault", FAULTS)
def test_a_program_that_does_not_compile_has_a_fault(
    text: str, fault: tuple[str, int] | None
) -> None:
    assert find_fault(text) == fault
