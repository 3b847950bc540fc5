"""Expressions of columns: what they are, and what is refused."""

from __future__ import annotations

import math

import pytest
from numpy.testing import assert_allclose

from tests.cases import for_rows
from tests.logs.test_signals import NAN, column
from tuisim.base.errors import LogError
from tuisim.logs.expressions import FUNCTIONS, MAX_CHARS, evaluate

COLUMNS = {"left": column(1, 2, 3), "right": column(4, 0, 6), "odd name": column(7, 8, 9)}


VALUES = {
    "(left + right) / 2": [2.5, 1, 4.5],
    "left - -right * 2 ** 2": [17, 2, 27],
    "left < right": [1, 0, 1],
    "1 < left <= 2": [0, 1, 0],
    "left > 1 and not right > 5": [0, 1, 0],
    "left == 1 or right == 6": [1, 0, 1],
    "`odd name` % 4": [3, 0, 1],
    "left if right else -1": [1, -1, 3],
    "7 // left": [7, 3, 2],
    "right / (left - 2)": [-4, NAN, 6],
    "1 / right": [0.25, math.inf, 1 / 6],
    "diff(left)": [NAN, 1, 1],
    "shift(right)": [NAN, 4, 0],
    "clip(right, 1, 5)": [4, 1, 5],
    "where(left > 2, 10, left)": [1, 2, 10],
    "sqrt(left * left) + abs(-1)": [2, 3, 4],
    "hypot(3, 4) + round(0.6) + floor(0.6) + sign(-3)": [5, 5, 5],
    "min(left, 2) + max(right, 1)": [5, 3, 8],
    "sin(90) + cos(0) + exp(0) + log(1) + atan2(1, 1)": [48, 48, 48],
    "2 * pi": [2 * math.pi] * 3,
    "9" * 400: [math.inf] * 3,
}


@for_rows("text, expected", VALUES.items())
def test_each_expression_computes_the_expected_values(text: str, expected: list[float]) -> None:
    assert_allclose(evaluate(text, COLUMNS), expected)


def test_every_function_of_expressions_has_a_test_case() -> None:
    assert all(any(f"{name}(" in text for text in VALUES) for name in FUNCTIONS)


REFUSED = {
    "a call of something else": "open('x')",
    "an attribute": "left.__class__",
    "an index": "left[0]",
    "a text": "'a' * 1000",
    "a lambda": "(lambda: 1)()",
    "a list": "[x for x in left]",
    "a statement": "import os",
    "no column": "lft + 1",
    "no function": "eval(left)",
    "too few values": "clip(left)",
    "a name for a value": "abs(x=left)",
    "nothing": "",
    "an open bracket": "(left",
    "an open backtick": "`odd name + 1",
    "too deep": "(" * 400 + "1" + ")" * 400,
    "too long": "1+" * 1000 + "1",
    "a null character": "left\0",
    "a complex number": "left * 2j",
    "an assignment": "(left := 1)",
    "f-string": "f'{left}'",
}


def test_an_expression_beyond_the_longest_allowed_is_refused() -> None:
    text = f"{'left':{MAX_CHARS}}"
    assert [*evaluate(text, COLUMNS)] == [1, 2, 3]
    with pytest.raises(LogError, match=f"{MAX_CHARS + 1} characters"):
        evaluate(f"{text} ", COLUMNS)


@for_rows("text", REFUSED)
def test_a_wrong_expression_is_refused(text: str) -> None:
    with pytest.raises(LogError):
        evaluate(text, COLUMNS)
