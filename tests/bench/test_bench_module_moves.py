"""Calls and changes of module are counted, but for what an import executes."""

from __future__ import annotations

from collections.abc import Callable

from tests.bench.module_moves import MoveCounter, Walk
from tests.bench.test_bench_frame_modules import INNER, SAME, function_of


def walk_through(function: Callable[[], object]) -> Walk:
    """Count what a function does."""
    counter = MoveCounter()
    counter.start()
    function()
    return counter.stop()


def test_counted_calls_include_those_within_a_module() -> None:
    walk = walk_through(SAME)
    assert walk == Walk(3, {"tuisim.app.app": 1, "tuisim.engine.core.geometry": 1})
    assert walk.moves == 2


def test_counted_calls_leave_out_what_an_import_executes() -> None:
    body = compile("INNER()\n", "module.py", "exec")
    importing = function_of("importlib", lambda: exec(body, {"INNER": INNER}))
    assert walk_through(importing) == Walk(0, {})
    assert walk_through(INNER).calls == 1
