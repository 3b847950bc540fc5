"""Kinds of values: what each takes from files, options and Python, and how it tells what is wrong."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.cases import for_rows
from tuisim.base.errors import ConfigError
from tuisim.engine.core.drift_spec import DriftSpec
from tuisim.engine.core.values import (
    Choice,
    Choices,
    Color,
    Flag,
    NamedNumber,
    NamedPart,
    Number,
    Numbers,
    Seed,
    Text,
    Value,
    Whole,
    WrongValue,
    format_number,
    quote,
)
from tuisim.settings.options import parse

KINDS: dict[str, Value] = {
    "flag": Flag(),
    "number": Number(0.5, 2),
    "whole": Whole(0, 9),
    "seed": Seed(0, 9),
    "named": NamedNumber(1, 9, {"light": 3.0}),
    "numbers": Numbers(-9, 9, 2),
    "text": Text(most=5),
    "choice": Choice((1, "b", ""), what="letter"),
    "choices": Choices(("a", "b"), what="letter"),
    "color": Color(),
    "part": NamedPart(DriftSpec),
}
TYPICAL = DriftSpec(0.5, 1.0, 1.0, 1.0, 3.0, 0.05, 2.0, 14.0, 100.0, 10.0, 5.0)


@for_rows(
    "kind, data, found",
    [
        ("flag", True, True),
        ("number", 1, 1.0),
        ("whole", 9, 9),
        ("named", "light", 3.0),
        ("named", 4, 4.0),
        ("numbers", [1, -2.5], (1.0, -2.5)),
        ("text", "a b", "a b"),
        ("choice", 1, 1),
        ("choices", ["b", "a"], ("b", "a")),
        ("color", "Teal", "teal"),
        ("color", "#FFaa00", "#ffaa00"),
        ("part", "typical", TYPICAL),
        ("part", {"slip_pc": "typical", "gyro_dps": 2}, DriftSpec(slip_pc=1.0, gyro_dps=2.0)),
    ],
)
def test_parse_data_reads_each_kind_of_value_from_a_file(
    kind: str, data: object, found: object
) -> None:
    value = KINDS[kind].parse_data(data)
    assert (value, type(value)) == (found, type(found))


@for_rows(
    "kind, data, said",
    [
        ("flag", 1, "must be true or false, got 1"),
        ("number", float("nan"), "must be a number from 0.5 to 2, got nan"),
        ("number", True, "must be a number from 0.5 to 2, got true"),
        ("number", "1", "must be a number from 0.5 to 2, got '1'"),
        ("number", 10**400, "must be a number from 0.5 to 2, got 1000"),
        ("whole", 2.0, "must be a whole number from 0 to 9, got 2.0"),
        ("seed", 10, "must be a whole number from 0 to 9, got 10"),
        ("named", "heavy", "must be light, or a number from 1 to 9, got 'heavy'"),
        ("numbers", [], "must be 1 to 2 numbers from -9 to 9, got 0"),
        ("numbers", 3, "must be a list, got 3"),
        ("text", "a\nb", "must be one line of 1 to 5 characters, got 'a\\nb'"),
        ("text", "abcdef", "must be one line of 1 to 5 characters, got 'abcdef'"),
        ("choice", 1.0, "no such letter 1.0"),
        ("choice", True, "no such letter true"),
        ("choices", "a", "must be a list, got 'a'"),
        ("color", "reed", "no such colour 'reed'"),
        ("part", 3, "must be none or typical, then values such as wheel_pc=1, got 3"),
        ("part", {"gyro": 1}, "no such key"),
        ("part", {"gyro_dps": True}, "must be typical, or a number from 0 to 20, got true"),
    ],
)
def test_parse_data_refuses_wrong_values_with_what_is_allowed(
    kind: str, data: object, said: str
) -> None:
    with pytest.raises(WrongValue) as caught:
        KINDS[kind].parse_data(data)
    assert caught.value.message.startswith(said)


def test_a_wrong_value_in_a_list_is_named_by_its_place() -> None:
    for kind, data in (("numbers", [1, 10]), ("choices", ["a", "c"])):
        with pytest.raises(WrongValue) as caught:
            KINDS[kind].parse_data(data)
        assert caught.value.part == "[2]"


@for_rows(
    "kind, text, found, again",
    [
        ("flag", "on", True, "on"),
        ("number", "1.5", 1.5, "1.5"),
        ("whole", "7", 7, "7"),
        ("named", "Light", 3.0, "light"),
        ("named", "2", 2.0, "2"),
        ("numbers", "1, -2", (1.0, -2.0), "1 -2"),
        ("text", "ab", "ab", "ab"),
        ("color", "Red", "red", "red"),
        ("part", "none", DriftSpec(), "none"),
        ("part", "typical", TYPICAL, "typical"),
        (
            "part",
            "none, gyro_dps=2 slip_pc=typical",
            DriftSpec(slip_pc=1.0, gyro_dps=2.0),
            "slip_pc=1 gyro_dps=2",
        ),
        ("part", "typical gyro_dps=0", replace(TYPICAL, gyro_dps=0.0), "typical gyro_dps=0"),
    ],
)
def test_each_kind_of_value_is_read_from_text_and_formatted_back(
    kind: str, text: str, found: object, again: str
) -> None:
    value = parse(KINDS[kind], text, "-v")
    assert value == found
    assert KINDS[kind].format_text(value) == again
    assert parse(KINDS[kind], again, "-v") == value


@for_rows(
    "kind, text, said",
    [
        ("flag", "yes", "-v: no such value 'yes' (one of on, off)"),
        ("number", "3", "-v: must be a number from 0.5 to 2, got '3'"),
        ("whole", "1.0", "-v: must be a whole number from 0 to 9, got '1.0'"),
        ("numbers", "1 up", "-v: must be 1 to 2 numbers from -9 to 9, got '1 up'"),
        ("choice", "c", "-v: no such letter 'c' (one of 1, b)"),
        ("color", "reed", "-v: no such colour 'reed' (did you mean red"),
        (
            "part",
            "much",
            "-v: no such value 'much' (none or typical, then values such as wheel_pc=1)",
        ),
        ("part", "slip_pc=1 typical", "-v: no such value 'typical' (none or typical, then"),
        ("part", "gyro=1", "-v gyro: no such key (did you mean gyro_dps?)"),
        ("part", "gyro_dps=x", "-v gyro_dps: must be typical, or a number from 0 to 20, got 'x'"),
    ],
)
def test_a_wrong_text_of_an_option_is_told_as_it_was_typed(kind: str, text: str, said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        parse(KINDS[kind], text, "-v")
    assert str(caught.value).startswith(said)


def test_a_seed_beyond_the_options_limit_is_valid_in_a_stored_run() -> None:
    KINDS["seed"].check(10)
    with pytest.raises(WrongValue):
        KINDS["seed"].check(1.5)


def test_numbers_and_long_texts_are_shown_short() -> None:
    assert [format_number(value) for value in (0.1 + 0.2, -0.0, 1e9, 2.50)] == [
        "0.3",
        "0",
        "1e+09",
        "2.5",
    ]
    assert len(quote("a" * 999)) < 70
    assert quote(False) == "false"
