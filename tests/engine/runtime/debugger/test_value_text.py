"""Values of a program as short texts, and expressions about them."""

from __future__ import annotations

import builtins
from typing import Any

import numpy as np
import pytest

from tests.cases import for_rows
from tuisim.engine.runtime.debugger.value_text import (
    MAX_CHARACTERS,
    MAX_ITEMS,
    Renderer,
    cut,
    describe,
    evaluate,
    evaluate_truth,
    name_type,
)


class Text(str):
    """A text of its own kind."""


class SpeedPercent:
    """As in ev3dev2: it has words, and no representation."""

    def __init__(self, percent: int) -> None:
        self.percent = percent

    def __str__(self) -> str:
        return f"{self.percent}%"


class Plain:
    """Without a text of its own."""


TEXTS: dict[str, tuple[object, str]] = {
    "nothing": (None, "None"),
    "whole": (-12, "-12"),
    "long whole": (1 << 4000, "<whole number of 4001 bits>"),
    "text": ("a\n'b", '"a\\n\'b"'),
    "one": ((1,), "(1,)"),
    "empty": ([set(), frozenset(), {}, ()], "[set(), frozenset(), {}, ()]"),
    "frozen": (frozenset({1}), "frozenset({1})"),
    "pairs": ({"a": [1.5, True]}, "{'a': [1.5, True]}"),
    "deep": ([[[[1, 2]]]], "[[[[… 2 items]]]]"),
    "many": (list(range(100)), f"[{', '.join(map(str, range(MAX_ITEMS)))}, … 100 items]"),
    "array": (np.zeros((2, 3)), "array(shape=(2, 3), dtype=float64)"),
    "text of its own kind": (Text("x"), "'x'"),
    "words for print only": (SpeedPercent(30), "SpeedPercent(30%)"),
}


@for_rows("value, text", TEXTS)
def test_each_kind_of_value_is_rendered_as_text(value: object, text: str) -> None:
    assert Renderer(1.0).render(value) == text


def test_shown_values_leave_out_memory_addresses() -> None:
    assert Renderer(1.0).render(Plain()).endswith(".Plain object>")


def test_long_texts_of_values_are_cut() -> None:
    shown = Renderer(1.0).render("x" * 10_000)
    assert len(shown) == MAX_CHARACTERS and shown.endswith("…")
    assert cut("abc", 3) == "abc" and cut("abcd", 3) == "ab…"


def test_when_time_is_up_foreign_values_are_named_by_their_kind() -> None:
    assert Renderer(-1.0).render([Plain(), 3]) == "[<Plain, not shown: values take too long>, 3]"


def test_the_named_type_of_a_value_is_its_real_type() -> None:
    class Liar:
        __class__ = int  # type: ignore[assignment]

    assert name_type(Liar()) == "Liar"


def test_an_error_whose_text_raises_is_its_kind() -> None:
    class Mute(Exception):
        def __str__(self) -> str:
            raise ValueError

    assert (describe(Mute()), describe(KeyError("a"))) == ("Mute", "KeyError: 'a'")


@pytest.mark.parametrize(
    "text, found",
    [("a + 1", ("4", "")), (" a ", ("3", "")), ("b", ("", "NameError: name 'b' is not defined"))],
    ids=["value", "spaces", "error"],
)
def test_a_watched_expression_is_shown_as_its_value_or_error(
    text: str, found: tuple[str, str]
) -> None:
    assert evaluate(Renderer(1.0), text, {"a": 3}, builtins) == found


@pytest.mark.parametrize(
    "text, answer",
    [
        ("a > 2", ".is true"),
        ("a > 3", "."),
        ("b", "."),
        ("a.b", ".cannot be evaluated: AttributeError: "),
    ],
)
def test_a_condition_with_a_name_that_is_not_there_yet_is_not_true(text: str, answer: str) -> None:
    names: dict[str, Any] = {"a": 3}
    assert evaluate_truth(text, names, builtins).startswith(answer)
    assert evaluate_truth(text, names, builtins) == answer or answer.endswith(": ")
