"""Comparisons in the text of programs."""

from __future__ import annotations

import ast

import pytest

from tests.cases import cases
from tuisim.programs.comparisons import list_constants, read_comparison


@cases(
    "test, comparison",
    {
        "a constant": ("x.light < 20", ("x.light", "<", 20)),
        "on the left": ("20 >= x.light", ("x.light", "<=", 20)),
        "a sum": ("x.light - 5 < N * 2", ("x.light", "<", 45)),
        "a colour": ("x.color == Color.RED", ("x.color", "==", "RED")),
    },
)
def test_a_comparison_is_read_as_value_operator_and_constant(
    test: str, comparison: tuple[str, str, object]
) -> None:
    node = ast.parse(test, mode="eval").body
    parts = read_comparison(node, {"N": 20}, is_break=True)
    assert parts is not None
    assert (ast.unparse(parts[0]), *parts[1:]) == comparison


@pytest.mark.parametrize("test", ["x.light", "x.light < y.light", "0 < x.light < 9", "x in y"])
def test_a_test_without_a_single_constant_is_no_comparison(test: str) -> None:
    assert read_comparison(ast.parse(test, mode="eval").body, {}, is_break=False) is None


def test_names_that_are_assigned_once_are_constants() -> None:
    text = "a = 5\nb = a * 2\nc = 1\nc = 2\ndef go(n): pass\ngo(3)\ngo(3)\n"
    assert list_constants(ast.parse(text)) == {"a": 5, "b": 10, "n": 3}
