"""Calls of programs that move motors."""

from __future__ import annotations

from tests.cases import cases
from tuisim.base.source import Program
from tuisim.programs.facts import ProgramFacts
from tuisim.programs.moves import list_unwaited_moves, list_wheel_turns


def read(text: str) -> ProgramFacts:
    return ProgramFacts(Program("task.py", text))


@cases(
    "text, moves",
    {
        "cut off by the next": ("t.on_for_seconds(9, 9, 1, block=False)\nt.turn(9)\n", [(1, 2)]),
        "after a pause": ("t.straight(9, wait=False)\nwait(9)\nprint(1)\nt.turn(9)\n", [(1, 4)]),
        "that of the same motor first": (
            "a.on_for_degrees(9, 9, block=False)\nb.on_for_degrees(9, 9)\na.on(9)\n",
            [(1, 3)],
        ),
        "waited for": ("a.run_angle(9, 9, wait=False)\na.wait_while(1)\na.run(9)\n", [(1, 0)]),
        "looked at": (
            "a.run_angle(9, 9, wait=False)\nwhile a.busy():\n    pass\na.run(9)\n",
            [(1, 0)],
        ),
        "blocking": ("a.run_angle(9, 9, wait=True)\na.run(9)\n", []),
    },
)
def test_a_move_for_which_nobody_waits_is_found(text: str, moves: list[tuple[int, int]]) -> None:
    unwaited = list_unwaited_moves(read(text).tree)
    assert [(move.line, move.next_line) for move in unwaited] == moves


@cases(
    "text, turns",
    {
        "against each other": ("t.on_for_degrees(30, -30, 90)\n", [(1, 1, 90)]),
        "by steering": ("t.on_for_rotations(-100, SpeedPercent(30), 0.25)\n", [(1, 1, 90)]),
        "two motors": ("a.run_angle(300, 90, wait=False)\nb.run_angle(-300, 90)\n", [(1, 2, 90)]),
        "one motor twice": ("a.run_angle(300, 90)\na.run_angle(-300, 90)\n", []),
        "a curve": ("t.on_for_degrees(30, 10, 90)\n", []),
        "another angle": ("t.on_for_degrees(30, -30, 289)\n", []),
    },
)
def test_turns_of_both_wheels_by_an_angle_usual_for_robots_are_found(
    text: str, turns: list[tuple[int, int, float]]
) -> None:
    wheel_turns = list_wheel_turns(read(text).tree)
    assert [(turn.first_line, turn.last_line, turn.angle_deg) for turn in wheel_turns] == turns
