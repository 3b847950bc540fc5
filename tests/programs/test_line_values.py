"""Which variables stand beside which lines of a paused program."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tuisim.engine.protocol import FrameState, Inspected, Variable
from tuisim.programs.line_values import MODULE, map_line_values

TEXT = """\
total = 0
def add(a, b=1, *more):
    c = a + b
    return [d for d in (c,)]
for n in range(3):
    total = total + n
    pause = add(n)
class Robot:
    speed = 1
done = True
done = False
a, (b, *rest) = 1, (2, 3)
"""


def inspected(
    stack: Sequence[tuple[str, int]],
    variables: dict[str, str],
    outer: dict[str, str] | None = None,
    file: str = "",
) -> Inspected:
    frames = tuple(
        FrameState(function, line, file if at == 0 else "")
        for at, (function, line) in enumerate(stack)
    )
    known = [
        tuple(Variable(name, "int", value, False) for name, value in d.items())
        for d in (variables, outer or {})
    ]
    return Inspected(0, 0, "MainThread", 0, "", (), frames, known[0], known[1], ())


def shown(text: str, state: Inspected) -> dict[int, list[str]]:
    return {
        line: [f"{one.name}={one.value}" for one in found]
        for line, found in map_line_values(text, state).items()
    }


@pytest.mark.parametrize(
    "line, variables, beside",
    [
        (5, {"total": "0"}, {6: ["total=0"]}),
        (6, {"total": "3", "n": "2"}, {5: ["n=2"], 6: ["total=3"]}),
        (11, {"n": "2", "done": "True", "speed": "1"}, {5: ["n=2"], 10: ["done=True"]}),
        (
            0,
            {"done": "False", "a": "1", "b": "2", "rest": "[3]"},
            {11: ["done=False"], 12: ["a=1", "b=2", "rest=[3]"]},
        ),
    ],
    ids=["loop", "constant of before", "not yet", "at the end"],
)
def test_values_of_globals_stand_beside_the_lines_that_use_them(
    line: int, variables: dict[str, str], beside: dict[int, list[str]]
) -> None:
    assert shown(TEXT, inspected([(MODULE, line)], variables)) == beside


def test_locals_and_globals_stand_beside_the_lines_of_a_paused_function() -> None:
    state = inspected(
        [("add", 4), (MODULE, 7)],
        {"a": "1", "b": "1", "c": "2", "d": "9"},
        {"n": "1", "total": "1"},
    )
    assert shown(TEXT, state) == {2: ["a=1", "b=1"], 3: ["c=2"], 5: ["n=1"], 6: ["total=1"]}


def test_while_another_module_runs_only_globals_are_shown_beside_lines() -> None:
    state = inspected([("add", 4), (MODULE, 7)], {"c": "2"}, {"n": "1"}, file="other.py")
    assert shown(TEXT, state) == {5: ["n=1"]}


@pytest.mark.parametrize("text", ["x = (", ""])
def test_a_text_without_lines_has_no_values(text: str) -> None:
    assert map_line_values(text, inspected([(MODULE, 1)], {"x": "1"})) == {}
