"""A small language over columns: arithmetic, comparisons and a few functions, such as `(left + right) / 2`.

An expression is parsed by Python's own parser and evaluated node by node. Only what is in the
tables below is allowed, so that an expression can access nothing but its columns.
"""

from __future__ import annotations

import ast
import math
import operator
import re
import sys
from collections.abc import Callable, Mapping
from functools import reduce
from itertools import pairwise
from typing import Any

import numpy as np

from tuisim.base.errors import LogError, among
from tuisim.base.syntax_tree import parse_expression
from tuisim.engine.core.conditions import COMPARE, Operator, list_operators
from tuisim.engine.runs.arrays import FloatArray

MAX_CHARS = 1000
ALLOWED = (
    f"numbers, columns, + - * / // % ** {list_operators()} and or not, a if b else c, and functions"
)

_BINARY: Mapping[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: np.divide,
    ast.FloorDiv: np.floor_divide,
    ast.Mod: np.mod,
    ast.Pow: np.float_power,
}
_UNARY: Mapping[type[ast.AST], Callable[[Any], Any]] = {
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Not: np.logical_not,
}
_OPERATORS: Mapping[type[ast.AST], Operator] = {
    ast.Lt: Operator.LESS,
    ast.LtE: Operator.LESS_EQUAL,
    ast.Gt: Operator.GREATER,
    ast.GtE: Operator.GREATER_EQUAL,
    ast.Eq: Operator.EQUAL,
    ast.NotEq: Operator.NOT_EQUAL,
}
_QUOTED = re.compile("`([^`]*)`")
_SINGLE_EQUAL = re.compile("(?<![<>=!:])=(?!=)")
"""Matches a single `=`, which an expression may have in place of `==`."""


def _shift(values: FloatArray) -> FloatArray:
    return np.concatenate(([np.nan], values[:-1])) if np.ndim(values) else values


Functions = Mapping[str, tuple[int, Callable[..., Any], str]]
"""Functions for expressions, by name: the number of arguments, the function that computes values, and a description."""

FUNCTIONS: Functions = {
    "abs": (1, np.abs, "absolute value"),
    "sqrt": (1, np.sqrt, "square root"),
    "exp": (1, np.exp, "e to this power"),
    "log": (1, np.log, "natural logarithm"),
    "sin": (1, lambda x: np.sin(np.radians(x)), "sine of degrees"),
    "cos": (1, lambda x: np.cos(np.radians(x)), "cosine of degrees"),
    "atan2": (2, lambda y, x: np.degrees(np.arctan2(y, x)), "angle in degrees"),
    "hypot": (2, np.hypot, "hypotenuse of a right triangle"),
    "round": (1, np.round, "nearest whole number"),
    "floor": (1, np.floor, "next whole number below"),
    "sign": (1, np.sign, "-1, 0 or 1"),
    "min": (2, np.minimum, "the smaller of two"),
    "max": (2, np.maximum, "the larger of two"),
    "clip": (3, np.clip, "limited to a range"),
    "where": (3, np.where, "the second if the first is true, else the third"),
    "shift": (1, _shift, "value of the previous row"),
    "diff": (1, lambda x: x - _shift(x), "change since the previous row"),
}
"""The functions that every expression can use."""

CONSTANTS: Mapping[str, float] = {"pi": np.pi}


def evaluate(
    text: str, columns: Mapping[str, FloatArray], functions: Functions = FUNCTIONS
) -> FloatArray:
    """Return the value of an expression in each row.

    Args:
        text: The expression; a column name that is not a Python identifier is written in backticks.
        columns: Arrays of one length by name.
        functions: The functions that it may call, by name.

    Returns:
        Shape (n,); conditions are 1 where they are true and 0 elsewhere.

    Raises:
        LogError: the expression is invalid, or names an unknown column or function.
    """
    parsed = _read(text)
    length = len(next(iter(columns.values()))) if columns else 0
    # A division by zero gives inf or NaN.
    with np.errstate(all="ignore"):
        value = _Evaluation(columns, text, functions).value(parsed.body)
    return np.broadcast_to(np.asarray(value, np.float64), (length,)).copy()


def find_names(text: str) -> list[str]:
    """Return the names of the columns in an expression, in order of first appearance.

    Raises:
        LogError: the expression cannot be parsed.
    """
    parsed = _read(text)
    called = {id(node.func) for node in ast.walk(parsed) if isinstance(node, ast.Call)}
    nodes = [
        node for node in ast.walk(parsed) if isinstance(node, ast.Name) and id(node) not in called
    ]
    nodes.sort(key=lambda node: (node.lineno, node.col_offset))
    return [name for name in dict.fromkeys(node.id for node in nodes) if name not in CONSTANTS]


def _read(text: str) -> ast.Expression:
    """Return a parsed expression, in which names may be any text that was in backticks."""
    if len(text) > MAX_CHARS:
        raise LogError(f"the expression has {len(text)} characters", f"at most {MAX_CHARS}")
    names: dict[str, str] = {}
    for name in _QUOTED.findall(text):
        names[f"column_{len(names)}_"] = name
    stand_ins = iter(names)
    source = _QUOTED.sub(lambda _: next(stand_ins), text)
    if "`" in source:
        raise LogError(f"a backtick is not closed in {text!r}")
    parsed = _parse(source, text)
    for node in ast.walk(parsed):
        if isinstance(node, ast.Name):
            node.id = names.get(node.id, node.id)
    return parsed


def _parse(source: str, text: str) -> ast.Expression:
    try:
        return parse_expression(_SINGLE_EQUAL.sub("==", source.strip()))
    except SyntaxError as error:
        offset = error.offset or 0
        where = (
            f" at character {offset - len(_SINGLE_EQUAL.findall(source.strip()[:offset]))}"
            if offset
            else ""
        )
        message = f"cannot read the expression {text!r}{where}: {error.msg}"
        raise LogError(message, f"allowed are {ALLOWED}") from error
    # A null character raises ValueError; nesting too deep for the parser raises the others.
    except (ValueError, RecursionError, MemoryError) as error:
        raise LogError(f"cannot read the expression {text[:60]!r}") from error


class _Evaluation:
    """Evaluates one expression for all rows of a log.

    Args:
        columns: The values of each column, by name.
        text: The expression, for errors.
        functions: The functions that it may call, by name.
    """

    def __init__(self, columns: Mapping[str, FloatArray], text: str, functions: Functions) -> None:
        self._columns = columns
        self._text = text
        self._functions = functions

    def value(self, node: ast.expr) -> Any:
        """Return the value of a node of the expression: an array or a number.

        Raises:
            LogError: the node is not allowed in expressions.
        """
        match node:
            case ast.Constant(value=bool() | int() | float() as number):
                # An integer may be larger than the largest float.
                return float(number) if number <= sys.float_info.max else math.inf
            case ast.Name(id=name):
                return self._read_name(name)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
                return _BINARY[type(op)](self.value(left), self.value(right))
            case ast.UnaryOp(op=op, operand=operand) if type(op) in _UNARY:
                return _UNARY[type(op)](self.value(operand))
            case ast.BoolOp(op=op, values=parts):
                join = np.logical_and if isinstance(op, ast.And) else np.logical_or
                return reduce(join, map(self.value, parts))
            case ast.Compare(left=left, ops=ops, comparators=others) if all(
                type(op) in _OPERATORS for op in ops
            ):
                return self._compare([left, *others], ops)
            case ast.IfExp(test=test, body=body, orelse=other):
                return np.where(self.value(test), self.value(body), self.value(other))
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
                return self._call(name, arguments)
        raise LogError(
            f"{ast.unparse(node)!r} is not allowed in {self._text!r}", f"allowed are {ALLOWED}"
        )

    def _compare(self, parts: list[ast.expr], ops: list[ast.cmpop]) -> Any:
        values = [self.value(part) for part in parts]
        truths = (
            COMPARE[_OPERATORS[type(op)]](*pair)
            for op, pair in zip(ops, pairwise(values), strict=True)
        )
        return reduce(np.logical_and, truths, True)

    def _read_name(self, name: str) -> Any:
        if name in self._columns:
            return np.asarray(self._columns[name], np.float64)
        if name in CONSTANTS:
            return CONSTANTS[name]
        raise LogError(f"no column {name!r}", among(name, self._columns))

    def _call(self, name: str, arguments: list[ast.expr]) -> Any:
        if name not in self._functions:
            raise LogError(f"no function {name!r}", among(name, self._functions))
        count, function, _ = self._functions[name]
        if len(arguments) != count:
            raise LogError(
                f"{name} takes {count} {'value' if count == 1 else 'values'}, got {len(arguments)}"
            )
        return function(*(self.value(argument) for argument in arguments))
