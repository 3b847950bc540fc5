"""The structure of a program's text: how many loops, functions, lines and so on it has."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from functools import partial

_Function = ast.FunctionDef | ast.AsyncFunctionDef
_BLOCKS = (ast.For, ast.While, ast.If, ast.With, ast.Try, _Function, ast.ClassDef)


def _list_nodes(tree: ast.Module, *kinds: type[ast.AST]) -> list[ast.AST]:
    return [node for node in ast.walk(tree) if isinstance(node, kinds) and not _is_dead(node)]


def _is_dead(node: ast.AST) -> bool:
    """Return whether a loop or a branch does nothing: its body is empty, or its condition is never true."""
    if (
        isinstance(node, ast.While | ast.If)
        and isinstance(node.test, ast.Constant)
        and not node.test.value
    ):
        return True
    # A `while` with an empty body is not dead: it waits.
    return isinstance(node, ast.For | ast.If | _Function) and all(
        _is_idle(statement) for statement in node.body
    )


def _is_idle(statement: ast.stmt) -> bool:
    is_text = isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
    return is_text or isinstance(statement, ast.Pass | ast.Continue | ast.Break)


def _count(*kinds: type[ast.AST]) -> Callable[[ast.Module], int]:
    return partial(lambda tree, wanted: len(_list_nodes(tree, *wanted)), wanted=kinds)


def _count_functions(tree: ast.Module) -> int:
    """Return how many functions the program defines and also uses."""
    defined = _list_nodes(tree, _Function)  # type: ignore[arg-type]
    named = [
        node.id if isinstance(node, ast.Name) else node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Name | ast.Attribute)
    ]
    return len(
        {node.name for node in defined if isinstance(node, _Function) and node.name in named}
    )


def _count_lines(tree: ast.Module) -> int:
    """Return how many lines have code; comments and docstrings do not count."""
    statements = (
        node for node in ast.walk(tree) if isinstance(node, ast.stmt) and not _is_idle(node)
    )
    return len({line for node in statements for line in _list_span(node)})


def _list_span(statement: ast.stmt) -> Iterator[int]:
    """Yield the lines of a statement; of a block only the first."""
    is_block = isinstance(statement, _BLOCKS)
    yield from range(
        statement.lineno, statement.lineno + 1 if is_block else (statement.end_lineno or 0) + 1
    )


def _measure_depth(node: ast.AST) -> int:
    """Return how deep blocks are nested."""
    inner = max(map(_measure_depth, ast.iter_child_nodes(node)), default=0)
    return inner + isinstance(node, _BLOCKS)


STRUCTURES: Mapping[str, Callable[[ast.Module], int]] = {
    "loops": _count(ast.For, ast.While),
    "for": _count(ast.For),
    "while": _count(ast.While),
    "if": _count(ast.If),
    "functions": _count_functions,
    "classes": _count(ast.ClassDef),
    "try": _count(ast.Try),
    "lines": _count_lines,
    "depth": _measure_depth,
}
"""What can be counted in a program's text, by name."""
