"""Syntax trees of Python texts, for any thread.

Python 3.11 counts the depth of a tree that it builds in one place for all. Garbage that is collected meanwhile may run
code, or let a thread go on, that builds another tree: the first one then ends with a `SystemError`. Here nothing is
collected while a tree is built.
"""

from __future__ import annotations

import ast
import gc
from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock

_lock = RLock()
NOT_PYTHON = (SyntaxError, ValueError, RecursionError, MemoryError)
"""The errors of a text that is not Python."""


@contextmanager
def _collect_later() -> Iterator[None]:
    # Without the lock, a thread could restore a setting of the garbage collector that another one has made.
    with _lock:
        collects = gc.isenabled()
        gc.disable()
        try:
            yield
        finally:
            if collects:
                gc.enable()


def parse_module(text: str) -> ast.Module:
    """Return the syntax tree of a module.

    Raises:
        One of `NOT_PYTHON`: the text is not Python.
    """
    with _collect_later():
        return ast.parse(text)


def parse_expression(text: str) -> ast.Expression:
    """Return the syntax tree of an expression.

    Raises:
        One of `NOT_PYTHON`: the text is not an expression of Python.
    """
    with _collect_later():
        return ast.parse(text, mode="eval")
