"""The language of breaks."""

from __future__ import annotations

import pytest

from tests.cases import for_rows
from tuisim.app.kept_breaks import break_lines
from tuisim.base.errors import ConfigError
from tuisim.engine.breakpoints import (
    Breakpoint,
    BreakRule,
    LineBreak,
    StallBreak,
    TimeBreak,
    parse_breakpoints,
)
from tuisim.engine.core.conditions import ValueCondition, ValueSource
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.sensors import list_columns
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec

RUN = RunSpec(RobotSpec(), WorldSpec(), PROFILES["ev3"])

RULES: dict[str, tuple[BreakRule, str]] = {
    "12": (LineBreak(12), "12"),
    "line 12": (LineBreak(12), "12"),
    "12 if x > 3": (LineBreak(12, "x > 3"), "12 if x > 3"),
    "  7   if  a[0] ": (LineBreak(7, "a[0]"), "7 if a[0]"),
    "left_red_pc < 10": (ValueCondition("left_red_pc", "<", "10"), "left_red_pc < 10"),
    "left.red% < 10": (ValueCondition("left_red_pc", "<", "10"), "left_red_pc < 10"),
    "left sensor red % < 10": (ValueCondition("left_red_pc", "<", "10"), "left_red_pc < 10"),
    "left.red < 10": (ValueCondition("left_red", "<", "10"), "left_red < 10"),
    "right.color changes": (ValueCondition("right_color", "changes"), "right_color changes"),
    "left.color = Blue": (ValueCondition("left_color", "==", "Blue"), "left_color == Blue"),
    "ultrasonic<200": (ValueCondition("ultrasonic_mm", "<", "200"), "ultrasonic_mm < 200"),
    "ultrasonic sensor <= 2.5e2": (
        ValueCondition("ultrasonic_mm", "<=", "250"),
        "ultrasonic_mm <= 250",
    ),
    "gyro > 90": (ValueCondition("gyro_deg", ">", "90"), "gyro_deg > 90"),
    "gyro.rate != 0": (ValueCondition("gyro_rate_dps", "!=", "0"), "gyro_rate_dps != 0"),
    "x_mm > 1000": (ValueCondition("x_mm", ">", "1000"), "x_mm > 1000"),
    "x_mm > 0.1234567890123456": (
        ValueCondition("x_mm", ">", "0.1234567890123456"),
        "x_mm > 0.1234567890123456",
    ),
    "time 3.5": (TimeBreak(3.5), "time 3.5"),
    "time 3.5 s": (TimeBreak(3.5), "time 3.5"),
    "sample Colour": (ValueCondition("Colour", "is seen", "", ValueSource.SAMPLE), "sample Colour"),
    "sample Colour changes": (
        ValueCondition("Colour", "changes", "", ValueSource.SAMPLE),
        "sample Colour changes",
    ),
    "sample Colour >= -1.5": (
        ValueCondition("Colour", ">=", "-1.5", ValueSource.SAMPLE),
        "sample Colour >= -1.5",
    ),
    "print matches a|b c": (
        ValueCondition("", "matches", "a|b c", ValueSource.PRINT),
        "print matches a|b c",
    ),
    "stall": (StallBreak(), "stall"),
}


@for_rows("text, rule, common", [(t, *r) for t, r in RULES.items()])
def test_a_breakpoints_text_is_parsed_and_written_back_the_same(
    text: str, rule: BreakRule, common: str
) -> None:
    found = Breakpoint.parse(text, RUN)
    assert found == Breakpoint(rule, common)
    assert Breakpoint.parse(found.written(), RUN) == found
    off = Breakpoint.parse("# " + text, RUN)
    assert off.disabled
    assert Breakpoint.parse(off.written(), RUN) == off


WRONG = {
    "": "is empty",
    "#": "is empty",
    "0": "count from 1",
    "hello": "is not a breakpoint",
    "12 if": "is not a breakpoint",
    "12 if x >": "is not an expression",
    "12 if " + "(" * 500: "is not an expression",
    "left.purple < 3": "has no 'left.purple'",
    "middle.red < 3": "has no 'middle.red'",
    "ultrasonic < far": "'far' is not a number",
    "ultrasonic < nan": "not a finite number",
    "time -1": "not possible",
    "time": "is not a number",
    "print hello": "only be compared with `matches`",
    "print matches (": "not a regular expression",
    "sample 1x < 3": "a sample has a name",
    "sample": "a sample has a name",
}


@for_rows("text, why", WRONG.items())
def test_a_text_that_is_no_breakpoint_is_refused_with_what_is_allowed(text: str, why: str) -> None:
    with pytest.raises(ConfigError, match="break: ") as refused:
        Breakpoint.parse(text, RUN)
    assert why in refused.value.message
    assert refused.value.hint


def test_breakpoints_can_compare_every_column_of_the_robot() -> None:
    for column in list_columns(RUN):
        for name in (column.name, *column.also):
            assert Breakpoint.parse(f"{name} > 1.5", RUN).rule == ValueCondition(
                column.name, ">", "1.5"
            )
    assert Breakpoint.parse("middle.red > 1").rule == ValueCondition("middle.red", ">", "1")


def test_breakpoints_know_their_lines_and_can_be_moved() -> None:
    breaks = parse_breakpoints(["# 3", "3 if x", "# 5", "stall"])
    assert {line: one.text for line, one in break_lines(breaks).items()} == {3: "3 if x", 5: "5"}
    assert [one.find_line() for one in breaks] == [3, 3, 5, 0]
    assert [one.move(9).written() for one in breaks] == ["# 9", "9 if x", "# 9", "stall"]
