"""Syntax trees: code that runs while garbage is collected does not disturb them."""

from __future__ import annotations

import ast
import gc
from collections.abc import Callable

import pytest

from tuisim.base.syntax_tree import parse_expression, parse_module

TEXT = "\n".join(
    f"def f{number}(x):\n    return [x * {number}, (x, {{'a': x}})]" for number in range(60)
)


def _parse_deep(depth: int, parse: Callable[[], object]) -> object:
    return _parse_deep(depth - 1, parse) if depth else parse()


@pytest.mark.parametrize(
    "parse",
    [lambda: parse_module(TEXT), lambda: parse_expression(f"[{'(x, [y]), ' * 500}]")],
    ids=["module", "expression"],
)
def test_parsing_survives_a_garbage_collection_that_parses_too(parse: Callable[[], object]) -> None:
    def parse_elsewhere(phase: str, info: dict[str, int]) -> None:
        gc.callbacks.remove(parse_elsewhere)
        _parse_deep(10, lambda: ast.parse("1 + 1"))
        gc.callbacks.append(parse_elsewhere)

    thresholds = gc.get_threshold()
    gc.callbacks.append(parse_elsewhere)
    gc.set_threshold(20, 10, 10)
    try:
        parse()
    finally:
        gc.set_threshold(*thresholds)
        gc.callbacks.remove(parse_elsewhere)
    assert gc.isenabled()
