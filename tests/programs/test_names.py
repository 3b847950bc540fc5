"""Names that nobody has defined."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import for_each, for_rows
from tests.conftest import ROOT
from tuisim.programs.names import find_unknown_names

PROGRAMS = sorted((ROOT / "programs").glob("*.py"))


def found(text: str) -> list[tuple[int, int, int, str]] | None:
    names = find_unknown_names(text, "prog.py")
    return None if names is None else [(one.row, one.start, one.end, one.hint) for one in names]


@for_rows(
    "text, unknown",
    [
        ("tank_drve.on(1)", [(0, 0, 9, "did you mean `tank_drive`?")]),
        ("x = 1\nprnt(X)", [(1, 0, 4, "did you mean `print`?"), (1, 5, 6, "did you mean `x`?")]),
        ("é = 'é'; a = foo", [(0, 13, 16, "")]),
        ("def f():\n    speed = 1\n\nprint(speed)", [(3, 6, 11, "it exists only inside `f`")]),
        ("import tim\ntime.sleep(1)", [(1, 0, 4, "`import time`")]),
        ("slept = 1\nsleep(1)", [(1, 0, 5, "did you mean `time.sleep`? `import time`")]),
        ("randint(1, 6)", [(0, 0, 7, "did you mean `random.randint`? `import random`")]),
        ("sqrt(2)", [(0, 0, 4, "did you mean `math.sqrt`? `import math`")]),
        (
            "# %%sim_magic\nSpeedPercent(1)",
            [(1, 0, 12, "`from ev3dev2.motor import SpeedPercent`")],
        ),
        ("# %%sim_magic\ntank_drive", [(1, 0, 10, "put `# %%sim_magic_preloaded` into line 1")]),
        (
            "from ev3dev2.motor import MoveTank\ntank_drive",
            [(1, 0, 10, "put `# %%sim_magic_preloaded` into line 1")],
        ),
        ("class A:\n    v = 1\n    def m(self):\n        return v", [(3, 15, 16, "")]),
        ("tank_drive.\nfoo", [(1, 0, 3, "")]),
        ("for n in rnge(\n    print(n, foo)", [(1, 13, 16, "")]),
    ],
)
def test_names_used_without_a_definition_are_found_in_a_program(
    text: str, unknown: list[tuple[int, int, int, str]]
) -> None:
    assert found(text) == unknown


@for_each(
    text=[
        "def f():\n    return later\n\nlater = f",
        "def f():\n    global made\n    made = 1\n\nf()\nprint(made)",
        "[x for x in range(3)]",
        "try:\n    import a\nexcept ImportError as error:\n    print(error)",
        "class A:\n    v = 1\n    w = v",
        "print(__name__, __file__, True, Ellipsis)",
        "with open('x') as file, (y := file):\n    print(y)",
        "match 1:\n    case [a, *b]:\n        print(a, b)",
        "import os.path as p\np, say, gyro, get_clock",
        "for i in range(3):\n    del i",
    ]
)
def test_names_that_are_defined_in_any_way_are_not_called_unknown(text: str) -> None:
    assert found(text) == []


@pytest.mark.parametrize(
    "text", ["from helper import *\nfoo", "exec('foo = 1')\nfoo", "globals()['foo'] = 1\nfoo"]
)
def test_names_are_not_checked_where_they_may_come_from_elsewhere(text: str) -> None:
    assert found(text) is None


@for_each(path=PROGRAMS)
def test_the_examples_have_no_unknown_names(path: Path) -> None:
    assert not found(path.read_text())
