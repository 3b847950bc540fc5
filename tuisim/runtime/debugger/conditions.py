"""Breakpoint conditions: evaluated in place if no code of the program can run, otherwise in a copy of the process."""

from __future__ import annotations

import ast
import types
from collections.abc import Callable, Mapping
from typing import Any

from tuisim.runtime.debugger.value_text import evaluate_truth

_SCALARS = (bool, int, float, str, types.NoneType)
_PLAIN_NODES = (
    ast.Expression, ast.BoolOp, ast.And, ast.Or, ast.UnaryOp, ast.Not, ast.USub, ast.UAdd, ast.BinOp, ast.Add, ast.Sub,
    ast.Div, ast.FloorDiv, ast.Mod, ast.Compare, ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Is, ast.IsNot,
    ast.Name, ast.Load, ast.Constant,
)  # fmt: skip

Apart = Callable[[Callable[[], bytes]], bytes | None]


class Condition:
    """The condition of one breakpoint.

    Args:
        text: A syntactically valid expression.
    """

    def __init__(self, text: str) -> None:
        self._text = text
        tree = ast.parse(text, mode="eval")
        nodes = list(ast.walk(tree))
        self._code = compile(tree, "<break>", "eval", dont_inherit=True)
        self._names = tuple({node.id for node in nodes if isinstance(node, ast.Name)})
        # On strings, % and + produce at most the combined length of their operands; * and ** could produce far more.
        self._plain = all(isinstance(node, _PLAIN_NODES) for node in nodes)

    def holds(self, frame: types.FrameType, apart: Apart) -> str:
        """Return why the run has to pause; empty if it does not.

        Args:
            frame: Where the expression is evaluated.
            apart: Calls a function in a copy of the process.
        """
        names: Mapping[str, Any] = frame.f_locals
        if self._plain and type(names) is dict:
            values = {name: names.get(name, frame.f_globals.get(name, self)) for name in self._names}
            values = {name: value for name, value in values.items() if value is not self or name in frame.f_builtins}
            if all(type(value) in _SCALARS for value in values.values()):
                return self._at_once(values)
        answer = apart(
            lambda: evaluate_truth(self._text, {**frame.f_globals, **names}, frame.f_builtins).encode(
                "utf-8", "backslashreplace"
            )
        )
        return "takes too long" if answer is None else answer.decode()[1:]

    def _at_once(self, values: dict[str, Any]) -> str:
        try:
            return "is true" if eval(self._code, {"__builtins__": {}}, values) else ""
        except NameError:
            # Names that do not exist yet make the condition false.
            return ""
        except Exception as error:  # an expression can fail in any way; worth pausing for
            return f"cannot be evaluated: {type(error).__name__}: {error}"
