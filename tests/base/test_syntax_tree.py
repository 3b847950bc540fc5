"""Syntax trees: threads that parse at the same time do not disturb each other."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import pytest

from tuisim.base.syntax_tree import compile_module, parse_expression, parse_module

TEXT = "\n".join(
    f"def f{number}(x):\n    return [x * {number}, (x, {{'a': x}})]" for number in range(60)
)


def _parse_deep(depth: int, parse: Callable[[], object]) -> object:
    return _parse_deep(depth - 1, parse) if depth else parse()


@pytest.mark.parametrize(
    "parse",
    [
        lambda: parse_module(TEXT),
        lambda: parse_expression(f"[{'(x, [y]), ' * 500}]"),
        lambda: compile_module(parse_module(TEXT), "robot.py"),
    ],
    ids=["module", "expression", "code"],
)
def test_threads_parse_at_the_same_time(parse: Callable[[], object]) -> None:
    # A collection of garbage lets another thread go on.
    def let_others_go_on(phase: str, info: dict[str, int]) -> None:
        time.sleep(0)

    thresholds = gc.get_threshold()
    gc.callbacks.append(let_others_go_on)
    gc.set_threshold(20, 10, 10)
    try:
        with ThreadPoolExecutor(4) as pool:
            list(pool.map(lambda number: _parse_deep(10 * (number % 4), parse), range(40)))
    finally:
        gc.set_threshold(*thresholds)
        gc.callbacks.remove(let_others_go_on)
