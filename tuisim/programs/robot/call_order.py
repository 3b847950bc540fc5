"""What a program does first: the lines of the calls that lead to a line."""

from __future__ import annotations

import ast
import math
from collections.abc import Mapping, Sequence
from dataclasses import field

from tuisim.base.data_class import dataclass
from tuisim.programs.robot.calls import Call
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
        """Return a sort key for when a line is reached; it is the highest if nothing in the text calls its function."""
        return *self._find_lead(scope), line

    def _find_lead(self, scope: Scope) -> Order:
        if scope not in self._leads:
            # Ends recursion: a function that only calls itself keeps this.
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
        # Modules that it imports run first.
        return (0,) if scope.module.name else ()
