"""The arguments of a call in a program."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Sequence
from typing import Protocol

from tuisim.base.data_class import dataclass
from tuisim.programs.robot.scopes import Scope
from tuisim.programs.robot.values import SourceCollection, Value


@dataclass(frozen=True, slots=True)
class Call:
    """A call of a function or class of the program, or of a class of the library."""

    node: ast.Call
    scope: Scope
    is_bound: bool = False
    """Whether the first parameter, such as `self`, is not among the arguments."""


class Evaluator(Protocol):
    """What tells the values of expressions."""

    def values(self, node: ast.expr, scope: Scope, /) -> Sequence[Value]: ...

    def looked_up(self, table: SourceCollection, wanted: Sequence[Value], /) -> Iterable[Value]: ...


def argument_node(call: Call, name: str, at: int | None) -> ast.expr | None:
    """Return the expression that a call gives for a parameter; None if it gives none by itself."""
    for keyword in call.node.keywords:
        if keyword.arg == name:
            return keyword.value
    args = call.node.args
    if (
        at is None
        or at < 0
        or any(isinstance(argument, ast.Starred) for argument in args[: at + 1])
    ):
        return None
    return args[at] if at < len(args) else None


def argument_of(
    call: Call, name: str, at: int | None, evaluator: Evaluator
) -> Sequence[Value] | None:
    """Return what a call gives for a parameter, also as `*…` and `**…`; None if nothing, empty if unknown."""
    if (node := argument_node(call, name, at)) is not None:
        return evaluator.values(node, call.scope)
    for keyword in call.node.keywords:
        if keyword.arg is None:
            for table in evaluator.values(keyword.value, call.scope):
                if isinstance(table, SourceCollection) and (
                    found := list(evaluator.looked_up(table, [name]))
                ):
                    return found
    for before, starred in enumerate(call.node.args):
        if isinstance(starred, ast.Starred) and at is not None and at >= before:
            for table in evaluator.values(starred.value, call.scope):
                if isinstance(table, SourceCollection) and not table.keys:
                    return list(evaluator.looked_up(table, [at - before]))
            return ()
    return None
