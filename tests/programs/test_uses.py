"""How programs use what they read and set, by their text."""

from __future__ import annotations

from tests.cases import cases, for_rows
from tuisim.base.source import Program
from tuisim.programs.facts import ProgramFacts
from tuisim.programs.uses import list_lone_stops, list_lost_values, list_stale_reads

READ = "light = eye.reflected_light_intensity\n"


def read(text: str) -> ProgramFacts:
    return ProgramFacts(Program("task.py", text))


@for_rows(
    "text, uses",
    {
        "a comparison": (f"{READ}while True:\n    if light < 20:\n        pass\n", [(3, "<")]),
        "a condition": (f"{READ}while light > 20 and go():\n    pass\n", [(2, ">")]),
        "a truth": ("hit = touch.is_pressed\nwhile not hit:\n    pass\n", [(2, "")]),
        "steering by a name computed from it": (
            f"{READ}for i in range(9):\n    turn = 2 * (light - 50)\n    tank.on(turn, 20)\n",
            [(4, "")],
        ),
        "in a function": (
            f"def go():\n    {READ}    while True:\n        tank.on(light, 20)\n",
            [(4, "")],
        ),
        "an answer": ("near = us.distance < 20\nwhile not near:\n    pass\n", [(2, "")]),
        "an answer that is compared": (
            "near = us.distance < 20\nwhile near == False:\n    pass\n",
            [(2, "")],
        ),
        "an answer that chooses": (
            "near = us.distance < 20\nwhile us.distance < 90:\n    if near:\n        go()\n",
            [],
        ),
        "an answer in a loop with an end": (
            "near = us.distance < 20\nwhile near:\n    if go():\n        break\n",
            [],
        ),
        "an answer asked again": (
            "near = us.distance < 20\nwhile not near:\n    near = us.distance < 20\n",
            [],
        ),
        "a setting": ("fast = MODE == 1\nwhile fast:\n    go()\n", []),
        "read again": (f"{READ}while light > 20:\n    {READ}", []),
        "a start value": ("start = gyro.angle\nwhile gyro.angle - start < 90:\n    pass\n", []),
        "a start value to steer by": (
            "aim = gyro.angle\nwhile True:\n    tank.on(aim - gyro.angle, 20)\n",
            [],
        ),
        "changed by a function": (
            f"def look():\n    global light\n    {READ}{READ}while light > 20:\n    look()\n",
            [],
        ),
        "a start value to compare": (
            "start_light = eye.color\nwhile True:\n    if start_light > 5:\n        pass\n",
            [],
        ),
        "a choice among moves that end": (
            f"{READ}for i in range(4):\n    if light > 50:\n        t.on_for_seconds(9, 9, 1)\n",
            [],
        ),
        "a number": ("limit = 20\nwhile True:\n    if limit < 30:\n        pass\n", []),
    },
)
def test_a_reading_that_a_loop_does_not_renew_is_found(
    text: str, uses: list[tuple[int, str]]
) -> None:
    facts = read(text)
    reads = list_stale_reads(facts.tree, facts.constants)
    assert [(use.line, use.operator) for use in reads] == uses


@cases(
    "text, lines",
    {
        "at once": ("tank.on(20, 20)\nif us.distance() < 9:\n    tank.off()\n", (2, 2, 3, 1, True)),
        "a reading with a name": (
            f"tank.on(20, 20)\n{READ}sleep(2)\nif light < 9:\n    tank.off()\n",
            (4, 2, 5, 1, False),
        ),
        "in a loop that asks again": (
            "while True:\n    tank.on(20, 20)\n    if touch.pressed():\n        tank.off()\n",
            None,
        ),
        "after a move that has ended": (
            "tank.on(20, 20)\ntank.on_for_seconds(5, 5, 1)\nif touch.pressed():\n    tank.off()\n",
            None,
        ),
        "with another way": (
            "tank.on(20, 20)\nif touch.pressed():\n    tank.off()\nelse:\n    tank.on(5, 5)\n",
            None,
        ),
    },
)
def test_a_stop_that_depends_on_one_reading_is_found(text: str, lines: object) -> None:
    facts = read(text)
    stops = [
        (stop.line, stop.read_line, stop.stop_line, stop.start_line, stop.is_direct)
        for stop in list_lone_stops(facts.tree, facts.constants)
    ]
    assert stops == ([lines] if lines else [])


LOST = "count = 0\ndef look():\n    {}\nlook()\nprint(count)\n"


@for_rows(
    "text, line",
    {
        "assigned": (LOST.format("count = 1"), 3),
        "assigned and printed": (LOST.format("count = 1; print(count)"), 3),
        "returned to nobody": (LOST.format("count = 1; return count"), 3),
        "global": (LOST.format("global count; count = 1"), None),
        "used": (LOST.format("count = 1; go(count)"), None),
        "returned": (
            LOST.format("count = 1; return count").replace("\nlook()", "\nx = look()"),
            None,
        ),
        "never called": (LOST.format("count = 1").replace("\nlook()", "\n"), None),
        "not read afterwards": (
            LOST.format("count = 1").replace("look()\nprint(count)", "print(count)\nlook()"),
            None,
        ),
        "a parameter": (LOST.format("count = 1").replace("look()", "look(count)"), None),
    },
)
def test_a_value_that_a_function_gives_to_a_name_of_its_own_is_found(
    text: str, line: int | None
) -> None:
    values = list_lost_values(read(text).tree)
    assert [lost.line for lost in values] == ([line] if line else [])


def test_a_long_chain_of_branches_is_read_to_its_end() -> None:
    branches = "".join(f"elif x == {number}:\n    b()\n" for number in range(1000))
    facts = read(f"if x < 0:\n    a()\n{branches}")
    assert [*list_stale_reads(facts.tree, facts.constants)] == []
    assert facts.slips == ()
