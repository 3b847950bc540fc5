"""Whether a program compiles, and how it is made."""

from __future__ import annotations

from pathlib import Path

from tests.cases import cases
from tests.goals.recorded import Run, goals_of, world
from tuisim.goals.judge import judge
from tuisim.goals.program_text import fault_in
from tuisim.runs.store import RunStore

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
    assert fault_in(text) == fault


PROGRAM = """\
'''Drive.'''
import time


def side(mm):
    '''Drive a side.'''
    # Slowly.
    for part in range(4):
        if part:
            time.sleep(1)


def never():
    time.sleep(2)


while False:
    print(1)
for _ in range(3):
    pass
side(
    400,
)
"""

STRUCTURE = {
    "a loop": ("loops >= 1", ""),
    "only one loop does anything": ("for <= 1", ""),
    "no loop that waits": ("while >= 1", "while >= 1 is asked for, and the program has 0."),
    "a function that is called": ("functions = 1", ""),
    "two functions": ("functions >= 2", "functions >= 2 is asked for, and the program has 1."),
    "lines": ("lines <= 13", ""),
    "fewer lines": ("lines <= 12", "lines <= 12 is asked for, and the program has 13."),
    "blocks in blocks": ("depth = 3", ""),
    "no class": ("classes = 0", ""),
}


@cases("comparison, reason", STRUCTURE)
def test_structure(comparison: str, reason: str, tmp_path: Path, home: Path) -> None:
    goals = goals_of(tmp_path, f"[[goal]]\nname = 'a'\nstructure = '{comparison}'\n")
    (found,) = judge(goals, Run(RunStore(), world(), PROGRAM).end())
    assert (found.state, found.reason) == ("missed" if reason else "met", reason)
