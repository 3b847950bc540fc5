"""The arguments of a call in a program, and the defaults of a function."""

from __future__ import annotations

import ast

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
    """Return the expression that a call gives for a parameter; None if it gives none, or only by `*`."""
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
    """Return the default of a parameter; None if it has none."""
    arguments = function.args
    usual = [*arguments.posonlyargs, *arguments.args]
    pairs = [
        *zip(usual[len(usual) - len(arguments.defaults) :], arguments.defaults, strict=True),
        *zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True),
    ]
    return next((default for argument, default in pairs if argument.arg == name), None)
