"""Syntax trees of Python texts, for any thread.

Python 3.11 counts the depth of a tree that it builds in one place for all threads. If a second thread parses while the
first one collects garbage, the first one ends with a `SystemError`: here, one waits for the other.
"""

from __future__ import annotations

import ast
from threading import RLock
from types import CodeType

_lock = RLock()


def parse_module(text: str) -> ast.Module:
    """Return the tree of a module.

    Raises:
        SyntaxError, ValueError, RecursionError, MemoryError: it is not Python.
    """
    with _lock:
        return ast.parse(text)


def parse_expression(text: str) -> ast.Expression:
    """Return the tree of an expression; errors as of `parse_module`."""
    with _lock:
        return ast.parse(text, mode="eval")


def compile_module(tree: ast.Module, name: str) -> CodeType:
    """Return the code of a module; errors as of `parse_module`."""
    with _lock:
        code: CodeType = compile(tree, name, "exec", dont_inherit=True)
        return code
