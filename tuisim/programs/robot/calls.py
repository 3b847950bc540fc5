"""The arguments of calls in a program, the defaults of functions, and which calls lead to a line."""

from __future__ import annotations

import ast
import math
from collections.abc import Mapping, Sequence
from dataclasses import field

from tuisim.base.data_class import dataclass
from tuisim.programs.robot.scopes import FUNCTIONS, Function, Scope

Order = tuple[float, ...]
"""The lines that lead to a line, from the program's own text on: the smaller is reached first."""
_UNKNOWN: Order = (math.inf,)


@dataclass(slots=True)
class CallOrder:
    """The order in which a program reaches its lines for the first time.

    Args:
        calls: The known calls of each function.
    """

    calls: Mapping[Function, Sequence[Call]] = field(default_factory=dict)
    _leads: dict[Scope, Order] = field(default_factory=dict)

    def find_order(self, line: int, scope: Scope) -> Order:
        """Return a sort key for when a line runs first.

        The key is the highest if nothing in the text calls the line's function.

        Args:
            line: The line.
            scope: The scope that contains it.
        """
        return *self._find_lead(scope), line

    def _find_lead(self, scope: Scope) -> Order:
        if scope not in self._leads:
            # This ends the recursion: a function that only calls itself keeps this value.
            self._leads[scope] = _UNKNOWN
            self._leads[scope] = self._follow(scope)
        return self._leads[scope]

    def _follow(self, scope: Scope) -> Order:
        node = scope.node
        if isinstance(node, FUNCTIONS):
            calls = self.calls.get(node, ())
            return min(
                (self.find_order(call.node.lineno, call.scope) for call in calls), default=_UNKNOWN
            )
        if isinstance(node, ast.ClassDef) and scope.outer is not None:
            return self.find_order(node.lineno, scope.outer)
        # The 0 puts imported modules first, as they run before the program's own lines.
        return (0,) if scope.module.name else ()


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
