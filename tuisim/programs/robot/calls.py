"""The arguments of calls in a program, and the defaults of its functions."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from tuisim.base.data_class import dataclass
from tuisim.programs.robot.scopes import Function, Scope


@dataclass(frozen=True, slots=True)
class Call:
    """A call of a function or class of the program, or of a class of the library."""

    node: ast.Call
    scope: Scope
    is_bound: bool = False
    """Whether the first parameter, such as `self`, is not among the arguments."""


def find_argument_node(call: Call, name: str, position: int | None) -> ast.expr | None:
    """Return the expression that a call passes for a parameter; None if it passes none, or only by `*` or `**`.

    Args:
        call: The call.
        name: The name of the parameter.
        position: Its index among the positional parameters; None if it is keyword-only.
    """
    for keyword in call.node.keywords:
        if keyword.arg == name:
            return keyword.value
    args = call.node.args
    if (
        position is None
        or position < 0
        or any(isinstance(argument, ast.Starred) for argument in args[: position + 1])
    ):
        return None
    return args[position] if position < len(args) else None


def find_default(function: Function, name: str) -> ast.expr | None:
    """Return the default value of a function's parameter as an expression; None if it has none."""
    arguments = function.args
    usual = [*arguments.posonlyargs, *arguments.args]
    pairs = [
        *zip(usual[len(usual) - len(arguments.defaults) :], arguments.defaults, strict=True),
        *zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True),
    ]
    return next((default for argument, default in pairs if argument.arg == name), None)


def is_negated(nodes: Sequence[ast.expr]) -> bool:
    """Return whether at least one of the given arguments begins with a minus sign."""
    return any(isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) for node in nodes)
