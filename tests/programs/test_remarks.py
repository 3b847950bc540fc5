"""What comments, prints and names say that a program means."""

from __future__ import annotations

from tests.cases import cases, for_rows
from tuisim.base.source import Program
from tuisim.programs.facts import ProgramFacts


@cases(
    "text, color",
    {
        "above": ("# until black\nwhile x > 9:\n    pass\n", "black"),
        "below": ("pass\nwhile x > 9:\n    pass\nprint('white!')\n", "white"),
        "both": ("# from white to black\nwhile x > 9:\n    pass\n", ""),
        "not": ("# not yet black\nwhile x > 9:\n    pass\n", ""),
        "another band": ("# the grey band before black\nwhile x > 9:\n    pass\n", ""),
        "the mat": ("# %%sim_magic -b black\nwhile x > 9:\n    pass\n", ""),
    },
)
def test_the_colour_of_which_the_lines_around_a_loop_speak_is_found(text: str, color: str) -> None:
    assert ProgramFacts(Program("task.py", text)).remarks.find_color(2, 3) == color


@cases(
    "text, words",
    {
        "a comment": ("# drive straight\nt.on(30, -30)\n", ["30 and -30"]),
        "a function": (
            "def forward():\n    a.on(SpeedPercent(-9))\n    b.on(9)\n",
            ["-9 and 9"],
        ),
        "a turn": ("# straight, then turn\nt.on(30, -30)\n", []),
        "no word": ("t.on(30, -30)\n", []),
        "named speeds": (
            "t.on_for_seconds(left_speed=9, right_speed=-9, seconds=1)  # forwards\n",
            ["9 and -9"],
        ),
        "equal signs": ("t.on(30, 30)  # forwards\n", []),
    },
)
def test_wheels_set_against_each_other_are_no_way_forwards(text: str, words: list[str]) -> None:
    facts = ProgramFacts(Program("task.py", text))
    assert [spin.words for spin in facts.remarks.list_spins()] == words


@for_rows(
    "text, words",
    {
        "cm": (
            "b.straight(50)  # 50 cm\n",
            "straight(50) drives 50 mm: straight(500) drives 50 cm",
        ),
        "cm of a name": (
            "WAY = 50  # cm\nb.straight(WAY)\n",
            "straight counts in mm, but WAY is in cm: line 1 says so",
        ),
        "mm": ("b.straight(50)  # 5 cm\n", ""),
        "ms": ("sleep(2000)\n", "sleep(2000) waits 2000 s, not ms: sleep(2) waits 2000 ms"),
        "s": ("sleep(20)\n", ""),
        "the time first": (
            "t.on_for_seconds(3, SpeedPercent(40), 40)\n",
            "on_for_seconds takes the time last: this is 3 % on the left and 40 % on the right for 40 s",
        ),
        "the time first, one motor": (
            "m.on_for_seconds(3, 50)\n",
            "on_for_seconds takes the time last: this is 3 % for 50 s",
        ),
        "a curve": ("t.on_for_seconds(5, 40, 3)\n", ""),
        "slowly": ("m.on_for_seconds(5, 3)\n", ""),
    },
)
def test_numbers_in_another_unit_are_found_where_that_is_clear(text: str, words: str) -> None:
    facts = ProgramFacts(Program("task.py", text))
    wrong = facts.remarks.list_wrong_units()
    assert [each.text for each in wrong] == ([words] if words else [])
