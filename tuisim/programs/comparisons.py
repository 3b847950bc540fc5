"""Comparisons in a program: the value, the operator and the constant, also if the value is a change."""

from __future__ import annotations

import ast
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from functools import lru_cache

from tuisim.programs.questions import Word
from tuisim.programs.robot.source import OPERATORS, SIGNS, TURNED

_OPPOSITE = {">=": "<", ">": "<=", "<=": ">", "<": ">=", "!=": "==", "==": "!="}
"""For the operator of a `while` condition, the one with which the loop ends."""


def read_comparison(
    test: ast.expr, constants: Mapping[str, Word], *, is_break: bool
) -> tuple[ast.expr, str, Word] | None:
    """Return the parts of a comparison that ends a loop: the compared expression, the operator, and the constant.

    The result is None if the test is not a comparison of one expression with a constant.

    Args:
        test: The test.
        constants: Values of names in the program; see `list_constants`.
        is_break: True if the loop ends when the test is true, as in `if test: break`. False if it ends when the test is
            false, as in `while test`; the returned operator is then the opposite one, which is true at the end.
    """
    match test:
        case ast.Compare(left=left, ops=[operator], comparators=[right]):
            parts = split_comparison(left, operator, right, constants)
        case _:
            return None
    if parts is None:
        return None
    value, sign, limit = parts
    ending = sign if is_break else _OPPOSITE.get(sign, "")
    return _split_sum(value, ending, limit, constants) if ending else None


def split_comparison(
    left: ast.expr, operator: ast.cmpop, right: ast.expr, constants: Mapping[str, Word]
) -> tuple[ast.expr, str, Word] | None:
    """Return the parts of a comparison with a constant: the compared expression, the operator, and the constant.

    If the constant stands on the left, the operator is turned: `20 < light` gives `light`, `>` and 20. The result is
    None for other comparisons.

    Args:
        left, right: The two sides.
        operator: The operator between them.
        constants: Values of names in the program; see `list_constants`.
    """
    sign = SIGNS.get(type(operator), "")
    limit = find_constant(right, constants)
    if limit is None:
        left, limit, sign = right, find_constant(left, constants), TURNED.get(sign, sign)
    return None if limit is None or not sign else (left, sign, limit)


def _split_sum(
    value: ast.expr, ending: str, limit: Word, constants: Mapping[str, Word]
) -> tuple[ast.expr, str, Word]:
    """Return a comparison with the numbers moved to its limit: `light + 5 > 30` becomes `light > 25`.

    Args:
        value: The compared expression.
        ending: The operator.
        limit: The constant.
        constants: Values of names in the program.

    Returns:
        The expression without these numbers, the operator, and the new limit.
    """
    while isinstance(limit, int | float):
        match value:
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
                sign = 1 if isinstance(op, ast.Add) else -1
                number = find_constant(right, constants)
                if number is None and sign > 0:
                    left, number = right, find_constant(left, constants)
                if not isinstance(number, int | float):
                    break
                value, limit = left, limit - sign * number
            case _:
                break
    return value, ending, limit


def build_difference(test: ast.expr) -> ast.expr:
    """Return a comparison of two values as one with 0: `a > b` becomes `a - b > 0`; other tests unchanged."""
    match test:
        case ast.Compare(left=left, ops=[_], comparators=[right]):
            change = ast.copy_location(ast.BinOp(left, ast.Sub(), right), left)
            return ast.copy_location(ast.Compare(change, test.ops, [ast.Constant(0)]), test)
    return test


def split_start(
    value: ast.expr, ending: str, limit: Word, tree: ast.Module, words: Mapping[str, Word]
) -> tuple[ast.expr, str, Word, int]:
    """Return a comparison without the earlier reading that is subtracted in it.

    For example, `gyro.angle - start > 90` becomes `gyro.angle > 90` if `start` was set to an earlier reading.

    Args:
        value: The compared expression, such as `gyro.angle - start`.
        ending: The operator.
        limit: The constant.
        tree: The program.
        words: The values of names in the program that are read as constants.

    Returns:
        The expression without the earlier reading, the operator, the limit, and the line that took the earlier reading.
        If no reading is subtracted, the comparison is unchanged, and the line is 0.
    """
    match value:
        case ast.BinOp(left=left, op=ast.Sub(), right=right) if not isinstance(limit, str):
            if not find_attribute(right) and (start := _find_start(right, tree, words)):
                return left, ending, limit + start[1], start[0]
            if not find_attribute(left) and (start := _find_start(left, tree, words)):
                return right, TURNED.get(ending, ending), start[1] - limit, start[0]
    return value, ending, limit, 0


def _find_start(
    node: ast.expr, tree: ast.Module, words: Mapping[str, Word]
) -> tuple[int, float] | None:
    """Return the line that took the reading in an expression such as `start + 5`, and the number added to it, here 5.

    Only a reading, or a reading plus or minus a number, counts; for other expressions, the result is None.
    """
    match node:
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
            start, number = _find_start(left, tree, words), find_constant(right, words)
            if start and isinstance(number, int | float):
                return start[0], start[1] + (number if isinstance(op, ast.Add) else -number)
        case ast.Name(id=name):
            match find_values(name, tree):
                case [(line, value)] if line < node.lineno:
                    return _find_start(value, tree, words)
        case _ if find_attribute(node):
            return node.lineno, 0
    return None


def list_constants(tree: ast.Module) -> dict[str, Word]:
    """Return the texts and numbers that names in a program always have, by name.

    These are names that are assigned once, and parameters that have the same value in all calls.
    """
    nodes = [*ast.walk(tree)]
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef)]
    times_set = Counter(
        [
            *(node.id for node in nodes if isinstance(node, ast.Name) and is_set(node)),
            *(node.arg for node in nodes if isinstance(node, ast.arg)),
        ]
    )
    constants: dict[str, Word] = {}

    def add(name: str, values: Iterable[ast.expr]) -> None:
        words = {find_constant(value, constants) for value in values}
        if times_set[name] == 1 and len(words) == 1 and (word := words.pop()) is not None:
            constants[name] = word

    for node in nodes:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                add(name, [value])
    calls_by_name: dict[str, list[list[ast.expr]]] = defaultdict(list)
    for node in nodes:
        match node:
            case ast.Call(func=ast.Name(id=name), args=values):
                calls_by_name[name].append(values)
    for function in functions:
        calls = calls_by_name[function.name]
        for index, parameter in enumerate(function.args.args):
            if all(len(values) > index for values in calls):
                add(parameter.arg, [values[index] for values in calls])
    return constants


def is_set(node: ast.Name | ast.Attribute) -> bool:
    """Return whether a node of the syntax tree assigns or deletes a name or attribute, and does not read it."""
    return not isinstance(node.ctx, ast.Load)


def find_constant(node: ast.expr, constants: Mapping[str, Word]) -> Word | None:
    """Return the text or number of a constant expression, or a name in capitals such as `RED`; None for others."""
    match node:
        case ast.Name(id=name):
            return constants.get(name)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATORS:
            match find_constant(left, constants), find_constant(right, constants):
                case (int() | float() as number, int() | float() as other) if other:
                    return OPERATORS[type(op)](number, other)
            return None
        case ast.Constant(value=str() | int() | float() as value) if not isinstance(value, bool):
            return value
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as value)):
            return -value
        case ast.Attribute(attr=attr) if attr.isupper():
            return attr
    return None


def find_attribute(node: ast.expr) -> str:
    """Return the name of the attribute that an expression reads, or of the method that it calls.

    For example, this is `angle` for `gyro.angle` and for `gyro.angle()`. A method counts only if it is called without
    an argument, or with the argument 0. The result is empty for other expressions.
    """
    match node:
        case (
            ast.Attribute(attr=attr)
            | ast.Call(func=ast.Attribute(attr=attr), args=[] | [ast.Constant(value=0)])
        ):
            return attr
    return ""


def find_values(name: str, tree: ast.Module) -> list[tuple[int, ast.expr]]:
    """Return the lines that assign a variable, each with the expression that it assigns.

    If the line shows no such expression, as `for x in …` does not for `x`, the syntax node of the name is returned in
    its place. The list is empty if a `global` or `nonlocal` statement names the variable, since the order of its
    assignments is then not known.
    """
    values = _map_values(tree).get(name, [])
    known = {line for line, value in values if not isinstance(value, ast.Name)}
    return [
        (line, value)
        for line, value in sorted(values, key=lambda each: each[0])
        if not (line in known and isinstance(value, ast.Name))
    ]


@lru_cache(maxsize=1)
def _map_values(tree: ast.Module) -> dict[str, list[tuple[int, ast.expr]]]:
    """Return by name, for each variable, the lines that assign it, each with a syntax node.

    For an assignment such as `x = 5`, the line occurs twice: with the expression `5`, and with the node of the name
    `x`. Variables that are named in a `global` or `nonlocal` statement are left out.
    """
    shared = set[str]()
    values: dict[str, list[tuple[int, ast.expr]]] = defaultdict(list)
    for node in ast.walk(tree):
        match node:
            case ast.Global(names=names) | ast.Nonlocal(names=names):
                shared.update(names)
            case ast.Name(id=name, ctx=ast.Store()):
                values[name].append((node.lineno, node))
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                values[name].append((node.lineno, value))
    return {name: places for name, places in values.items() if name not in shared}
