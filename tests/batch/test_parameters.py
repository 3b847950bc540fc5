"""The values of parameters, and the grid of their combinations."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tests.cases import for_rows
from tuisim.base.errors import ConfigError
from tuisim.batch.parameters import RandomDraw, SampleValues, build_grid, parse_seeds, parse_values
from tuisim.commands.batch_request import parse_set
from tuisim.engine.core.values import MAX_SEED


@for_rows(
    "text, expected",
    {
        "a list of numbers": ("0,20,50", (0, 20, 50)),
        "blanks, signs and exponents": (" 0 , -2.5,1e3", (0, -2.5, 1000.0)),
        "a range with its end": (
            "54:58:0.5",
            (54.0, 54.5, 55.0, 55.5, 56.0, 56.5, 57.0, 57.5, 58.0),
        ),
        "a range without rounding errors": ("0:0.3:0.1", (0.0, 0.1, 0.2, 0.3)),
        "a range in steps of one": ("1:4", (1, 2, 3, 4)),
        "a falling range": ("4:0:-2", (4, 2, 0)),
        "a range of one value": ("7:7", (7,)),
        "a span of whole numbers": ("3..6", (3, 4, 5, 6)),
        "ranges in a list": ("1,3..5,9:10:0.5", (1, 3, 4, 5, 9.0, 9.5, 10.0)),
        "words": ("Grey_bands,Lollipop", ("Grey_bands", "Lollipop")),
        "the path of a file": ("../maze.png", ("../maze.png",)),
        "words in quotes": ("'a,b.png',\"7\"", ("a,b.png", "7")),
        "truth values": ("true,off,ON", (True, False, True)),
        "random numbers": ("random(0, 50, 20)", SampleValues(RandomDraw.RANDOM, 0.0, 50.0, 20)),
        "a Latin hypercube": (
            "latin(54,58.5,10, seed=3)",
            SampleValues(RandomDraw.LATIN, 54.0, 58.5, 10, 3),
        ),
    },
)
def test_values_of_a_parameter_are_parsed(text: str, expected: object) -> None:
    assert repr(parse_values(text, "x")) == repr(expected)


@for_rows(
    "text, words",
    {
        "nothing": ("", "a value is missing"),
        "an empty value": ("1,,2", "a value is missing"),
        "a step of zero": ("54:58:0", "a step of 0 does not lead from 54 to 58"),
        "a step that leads away": ("58:54", "a step of 1 does not lead from 58 to 54"),
        "an end between two steps": ("0:1:0.3", "does not reach 1 .*0:0.9:0.3"),
        "too many values": ("0:1e9:1", "at most 1,000,000"),
        "no number of values": ("random(0, 50)", "random.0, 50, 20.*number of values"),
        "an empty interval": ("random(50, 0, 3)", "50 is not less than 0"),
        "no values": ("random(0, 1, 0)", "a whole number from 1"),
        "an unknown sample": ("rand(0, 1, 5)", "did you mean random"),
        "a sample in a list": ("1,random(0, 1, 5)", "stands alone"),
    },
)
def test_wrong_values_of_a_parameter_are_explained(text: str, words: str) -> None:
    with pytest.raises(ConfigError, match=rf"^x: .*{words}"):
        parse_values(text, "x")


@pytest.mark.parametrize("text", ["noise.motor", "=5", ""])
def test_a_varied_setting_without_a_name_or_values_is_refused(text: str) -> None:
    with pytest.raises(ConfigError, match=r"must be NAME=VALUES.*noise.motor=0,20,50"):
        parse_set(text)


@pytest.mark.parametrize(
    "text, expected",
    [
        ("0..3", (0, 1, 2, 3)),
        ("1,5,9", (1, 5, 9)),
        ("0..1,7", (0, 1, 7)),
        ("12", (12,)),
        (str(MAX_SEED), (MAX_SEED,)),
    ],
)
def test_lists_and_ranges_of_seeds_are_parsed(text: str, expected: tuple[int, ...]) -> None:
    assert parse_seeds(text) == expected


@pytest.mark.parametrize(
    "text, words",
    [
        ("-1", "whole number from 0"),
        ("0.5", "whole number"),
        ("a", "whole number"),
        ("1,2,1", "occurs twice"),
    ],
)
def test_wrong_seeds_are_explained(text: str, words: str) -> None:
    with pytest.raises(ConfigError, match=rf"^--seeds: .*{words}"):
        parse_seeds(text)


def test_the_last_parameter_of_a_grid_varies_fastest() -> None:
    grid = build_grid({"a": (1, 2), "b": ("x", "y", "z"), "seed": (0, 1)})
    assert (len(grid), grid.names) == (12, ("a", "b", "seed"))
    assert [tuple(point.values()) for point in grid][:4] == [
        (1, "x", 0),
        (1, "x", 1),
        (1, "y", 0),
        (1, "y", 1),
    ]


def test_random_parameter_values_lie_in_their_range_and_repeat_by_seed() -> None:
    sample = SampleValues(RandomDraw.RANDOM, 54, 58, 200)
    values = sample.values("a", whole=False)
    assert all(54 <= value <= 58 for value in values)
    assert values == sample.values("a", whole=False)
    assert not set(values) & set(sample.values("b", whole=False))
    assert not set(values) & set(
        SampleValues(RandomDraw.RANDOM, 54, 58, 200, seed=1).values("a", whole=False)
    )


def test_random_whole_numbers_of_a_parameter_include_both_ends() -> None:
    assert set(SampleValues(RandomDraw.RANDOM, 0, 5, 300).values("a", whole=True)) == {
        0,
        1,
        2,
        3,
        4,
        5,
    }


def test_a_latin_hypercube_has_one_value_in_each_part_of_each_parameter() -> None:
    latin = SampleValues(RandomDraw.LATIN, 0, 10, 10)
    grid = build_grid({"a": latin, "seed": (1, 2), "b": latin})
    assert (len(grid), grid.names) == (20, ("a", "b", "seed"))
    columns = list(zip(*(point.values() for point in grid if point["seed"] == 1), strict=True))
    assert [sorted(int(value) for value in column) for column in columns[:2]] == [[*range(10)]] * 2
    assert [int(value) for value in columns[0]] != [int(value) for value in columns[1]]
    assert any(one > other for one, other in pairwise(columns[0]))


def test_the_parameters_of_a_latin_hypercube_have_the_same_number_of_values() -> None:
    with pytest.raises(ConfigError, match=r"^b: .*same number of values and seed as a .*4, seed=0"):
        build_grid(
            {
                "a": SampleValues(RandomDraw.LATIN, 0, 1, 4),
                "b": SampleValues(RandomDraw.LATIN, 0, 1, 5),
            }
        )


def test_too_many_combinations_are_refused() -> None:
    with pytest.raises(ConfigError, match="4,000,000 combinations of a, b"):
        build_grid({"a": tuple(range(2000)), "b": tuple(range(2000))})
