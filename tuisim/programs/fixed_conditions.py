"""Conditions in a program that are never or always true, such as `x < 85 and x > 90`, and branches never reached."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, islice, pairwise, product
from math import prod

from tuisim.base.data_class import dataclass
from tuisim.engine.core.conditions import COMPARE
from tuisim.programs.comparisons import find_constant, find_values, split_comparison
from tuisim.programs.pure_expressions import has_effect, is_reading
from tuisim.programs.questions import Word

_MAX_NODES = 400
"""A larger condition is not examined."""
_MAX_SAMPLES = 500
_MAX_PARTS = 30
"""Further parts of a condition, and further branches, are not examined in pairs."""
_MAX_WORDS = 100
"""Longer conditions are not quoted."""


@dataclass(frozen=True, slots=True)
class _Limit:
    """A comparison of a value with a constant, such as `light < 20`."""

    value: str
    """The compared expression, as text."""
    sign: str
    word: Word

    def is_met(self, sample: object) -> bool:
        return bool(COMPARE[self.sign](sample, self.word))

    def can_compare(self, sample: object) -> bool:
        return self.sign in ("==", "!=") or isinstance(sample, int | float)


def list_fixed_conditions(
    tree: ast.Module, constants: Mapping[str, Word]
) -> Iterator[tuple[int, str]]:
    """Yield the lines with a condition that is always or never true, or an `elif` that is never reached.

    Each line comes with a description. Of each kind of mistake, only the first line is yielded.

    Args:
        tree: The program.
        constants: Values of names in the program; see `list_constants`.
    """
    nodes = [*ast.walk(tree)]
    for lines in (
        _list_lone_words(nodes),
        _list_lone_names(tree),
        _list_fixed(nodes, constants),
        _list_unreached(nodes, constants),
    ):
        if first := min(lines, default=None):
            yield first


def _list_fixed(
    nodes: Sequence[ast.AST], constants: Mapping[str, Word]
) -> Iterator[tuple[int, str]]:
    inner = set[ast.AST]()
    for node in nodes:
        match node:
            case ast.BoolOp() | ast.Compare(ops=[_, _, *_]) if node not in inner:
                value = find_value(node, constants)
                if value is not None:
                    inner.update(ast.walk(node))
                    yield node.lineno, _describe_fixed(node, value, constants)


def find_value(test: ast.expr, constants: Mapping[str, Word]) -> bool | None:
    """Return True for a condition that is always true, such as `x < 85 or x > 75`; False for one that is never true.

    The result is None if the condition is sometimes true, or if this is not known. At least one value in the condition
    must be compared with two constants. Nothing is assumed of the parts without a constant: they may be true or false.

    Args:
        test: The condition.
        constants: Values of names in the program; see `list_constants`.
    """
    nodes = [*islice(ast.walk(test), _MAX_NODES + 1)]
    if len(nodes) > _MAX_NODES:
        return None
    limits = {
        node: [_read_limit(*pair, constants) for pair in _split_chain(node)]
        for node in nodes
        if isinstance(node, ast.Compare)
    }
    words: dict[str, list[Word]] = defaultdict(list)
    for limit in (limit for each in limits.values() for limit in each if limit):
        words[limit.value].append(limit.word)
    samples = {value: _list_samples(each) for value, each in words.items() if len(each) > 1}
    if not samples or prod(map(len, samples.values())) > _MAX_SAMPLES or has_effect(test):
        return None
    values = {
        _evaluate(test, dict(zip(samples, each, strict=True)), limits)
        for each in product(*samples.values())
    }
    return values.pop() if len(values) == 1 else None


def _split_chain(test: ast.Compare) -> Iterator[tuple[ast.expr, ast.cmpop, ast.expr]]:
    """Yield the single comparisons of a chain such as `a < b < c`."""
    for (left, right), operator in zip(
        pairwise([test.left, *test.comparators]), test.ops, strict=True
    ):
        yield left, operator, right


def _read_limit(
    left: ast.expr, operator: ast.cmpop, right: ast.expr, constants: Mapping[str, Word]
) -> _Limit | None:
    """Return a comparison of a reading or variable with a constant; None for other comparisons."""
    parts = split_comparison(left, operator, right, constants)
    if parts is None:
        return None
    value, sign, word = parts
    is_ordered = isinstance(word, int | float) or sign in ("==", "!=")
    is_variable = find_constant(value, constants) is None
    if not (is_ordered and is_variable and is_reading(value)):
        return None
    return _Limit(ast.unparse(value), sign, word)


def _list_samples(words: Sequence[Word]) -> list[object]:
    """Return values with which to try all comparisons of a value with some constants.

    They are the constants themselves, numbers between and beyond them, and, for texts, a value that equals none of
    them.
    """
    numbers = sorted({word for word in words if not isinstance(word, str)})
    texts = {word for word in words if isinstance(word, str)}
    if not numbers:
        return [*texts, object()]
    between = [(low + high) / 2 for low, high in pairwise(numbers)]
    return [*numbers, *between, numbers[0] - 1, numbers[-1] + 1, *texts]


def _evaluate(
    test: ast.expr,
    samples: Mapping[str, object],
    limits: Mapping[ast.Compare, Sequence[_Limit | None]],
) -> bool | None:
    """Return whether a condition is true for given values; None if it also depends on a value that is not given.

    Args:
        test: The condition.
        samples: The given values, by the text of the compared expression, such as `light`.
        limits: The comparisons with constants in the condition, by their syntax node; None for other comparisons.
    """
    values: list[bool | None]
    match test:
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            value = _evaluate(operand, samples, limits)
            return None if value is None else not value
        case ast.BoolOp(values=parts):
            values = [_evaluate(part, samples, limits) for part in parts]
        case ast.Compare():
            values = [
                limit.is_met(samples[limit.value])
                if limit and limit.value in samples and limit.can_compare(samples[limit.value])
                else None
                for limit in limits[test]
            ]
        case _:
            return None
    deciding = isinstance(test, ast.BoolOp) and isinstance(test.op, ast.Or)
    if deciding in values:
        return deciding
    return None if None in values else not deciding


def _describe_fixed(test: ast.expr, value: bool, constants: Mapping[str, Word]) -> str:
    """Return in words that a condition is always or never true, and what was probably meant."""
    match test:
        case ast.UnaryOp(operand=operand):
            return _describe_fixed(operand, not value, constants)
        case ast.BoolOp(op=op, values=parts):
            for part in parts[:_MAX_PARTS]:
                if find_value(part, constants) is value:
                    return _describe_fixed(part, value, constants)
            for pair in combinations(parts[:_MAX_PARTS], 2):
                both = ast.BoolOp(op, [*pair])
                if len(parts) > len(pair) and find_value(both, constants) is value:
                    return _describe_fixed(both, value, constants)
    return f"{_quote(test)} is {'always' if value else 'never'} true{_name_cure(test, constants)}"


def _name_cure(test: ast.expr, constants: Mapping[str, Word]) -> str:
    """Return as text what was probably meant by a condition that is always the same; empty if that is not known."""
    span = _name_span(test, constants)
    match test:
        case ast.Compare() if span:
            return f": write {span}"
        case ast.BoolOp(op=op, values=parts):
            is_and = isinstance(op, ast.And)
            other = ast.BoolOp(ast.Or() if is_and else ast.And(), parts)
            if find_value(other, constants) is not None:
                return ""
            if is_and and span:
                return f": for a value between them write {span}, for one outside or instead of and"
            return f": write {'or' if is_and else 'and'} instead of {'and' if is_and else 'or'}"
    return ""


def _name_span(test: ast.expr, constants: Mapping[str, Word]) -> str:
    """Return the condition that was probably meant: that a value is between two limits, such as `75 < x < 85`.

    The result is empty if the given condition does not compare one value with a lower and an upper limit.
    """
    pairs = [
        pair
        for part in (test.values if isinstance(test, ast.BoolOp) else [test])
        if isinstance(part, ast.Compare)
        for pair in _split_chain(part)
    ]
    limits = [limit for pair in pairs if (limit := _read_limit(*pair, constants))]
    low, *high = sorted(limit.word for limit in limits if not isinstance(limit.word, str)) or [0]
    is_span = len(limits) == len(pairs) == 2 and len({limit.value for limit in limits}) == 1
    if is_span and high and {limit.sign[0] for limit in limits} == {"<", ">"}:
        return f"{low:g} < {limits[0].value} < {high[0]:g}"
    return ""


def _quote(test: ast.expr) -> str:
    words = ast.unparse(test)
    return words if len(words) <= _MAX_WORDS else "this condition"


def _list_lone_words(nodes: Sequence[ast.AST]) -> Iterator[tuple[int, str]]:
    """Yield the lines with a constant beside a comparison, such as `color == "red" or "blue"`.

    Each line comes with a description.
    """
    for node in nodes:
        match node:
            case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test):
                yield from _list_lone(test)
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq()], comparators=[right]):
                for side, other in ((left, right), (right, left)):
                    match side:
                        case ast.BoolOp(op=ast.Or(), values=[first, *_] as words) if all(
                            map(_get_kind, words)
                        ) and is_reading(other):
                            sign = "in" if isinstance(node.ops[0], ast.Eq) else "not in"
                            choice = ", ".join(map(ast.unparse, words))
                            yield (
                                node.lineno,
                                f"{ast.unparse(side)} is only {ast.unparse(first)}: "
                                f"write {ast.unparse(other)} {sign} ({choice})",
                            )


def _list_lone(test: ast.expr) -> Iterator[tuple[int, str]]:
    match test:
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            yield from _list_lone(operand)
        case ast.BoolOp(op=op, values=parts):
            for part in parts:
                yield from _list_lone(part)
            word = next((part for part in parts if _get_kind(part)), None)
            for part in parts:
                if word is not None and (question := _ask_about(word, part)):
                    name = "or" if isinstance(op, ast.Or) else "and"
                    always = "so this is always true" if name == "or" else "and changes nothing"
                    yield (
                        word.lineno,
                        f"{ast.unparse(word)} alone is true, {always}: write {name} {question}",
                    )


_NUMBERS = re.compile(r"reflect|distance|angle|ambient|heading")
_SENSORS = ("colorLeft", "colorRight", "ultrasonic", "gyro")


def _list_lone_names(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield the lines in which a sensor or a reading stands alone beside a comparison, such as `left and right < 9`.

    Each line comes with a description, which says what to write: here `left < 9`.
    """
    for node in ast.walk(tree):
        match node:
            case ast.BoolOp(values=[ast.Name(id=name), *parts]) if source := _find_source(
                name, tree
            ):
                for part in parts:
                    match part:
                        case ast.Compare(
                            left=ast.Name(id=other) | ast.Attribute(value=ast.Name(id=other))
                        ) if other != name and _find_source(other, tree) == source:
                            question = re.sub(rf"\b{other}\b", name, ast.unparse(part), count=1)
                            text = (
                                f"{name} alone is no comparison, and mostly true: write {question}"
                            )
                            yield node.lineno, text


def _find_source(name: str, tree: ast.Module) -> str:
    """Return what a variable always holds, by its assignments.

    The text is `Sensor` for a sensor, or the name of the method or property from which a number is read, such as
    `distance`. It is empty for a variable that may hold anything else.
    """
    if any(isinstance(node, ast.arg) and node.arg == name for node in ast.walk(tree)):
        return ""
    words = {_name_source(value) for _, value in find_values(name, tree)}
    if not words and name in _SENSORS:
        return "Sensor"
    return words.pop() if len(words) == 1 else ""


def _name_source(value: ast.expr) -> str:
    """Return `Sensor` for an expression that creates a sensor, or the method or property that it reads; else empty."""
    match value:
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name)) if name.endswith("Sensor"):
            return "Sensor"
        case ast.Call(func=ast.Attribute(attr=name)) | ast.Attribute(attr=name):
            return name if _NUMBERS.search(name) else ""
    return ""


def _get_kind(node: ast.expr) -> str:
    """Return the kind of a constant with which programs compare readings.

    This is `text`, `number`, or the part of a name such as `Color.RED` before the last dot. The result is empty for all
    other expressions. It is also empty for 0 and 1, which often mean no and yes, as True and False do.
    """
    match node:
        case ast.Constant(value=str() as text) if text:
            return "text"
        case ast.Constant(value=int() | float() as number) if number not in (0, 1):
            return "number"
        case ast.Attribute(value=value, attr=attr) if attr.isupper():
            return ast.unparse(value)
    return ""


def _ask_about(word: ast.expr, part: ast.expr) -> str:
    """Return the comparison that was probably meant by a constant that stands alone beside another comparison.

    For `color == "red" or "blue"`, this is `color == "blue"`. The result is empty if `part` is not a comparison with a
    constant of the same kind.

    Args:
        word: The constant that stands alone, such as `"blue"`.
        part: What stands beside it, such as `color == "red"`.
    """
    match part:
        case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() as operator], comparators=[right]):
            if _get_kind(left) == _get_kind(word):
                left, right = right, left
            if _get_kind(right) == _get_kind(word) and not _get_kind(left):
                return ast.unparse(ast.Compare(left, [operator], [word]))
    return ""


def _list_unreached(
    nodes: Sequence[ast.AST], constants: Mapping[str, Word]
) -> Iterator[tuple[int, str]]:
    """Yield the lines with an `elif` that never runs, each with a description.

    It never runs because whenever its condition is true, an earlier condition of the same `if` is true as well.
    """
    chained = {branch for node in nodes for branch in _list_elifs(node)}
    for node in nodes:
        if isinstance(node, ast.If) and node not in chained:
            branches = [node]
            for branch in branches:
                branches += _list_elifs(branch)[: _MAX_PARTS - len(branches)]
            tests = [branch.test for branch in branches]
            for first, later in combinations(tests, 2):
                both = ast.BoolOp(ast.And(), [ast.UnaryOp(ast.Not(), first), later])
                if find_value(later, constants) is None and find_value(both, constants) is False:
                    yield later.lineno, _describe_unreached(first, later)


def _list_elifs(node: ast.AST) -> list[ast.If]:
    """Return a list of the `elif` that comes directly after an `if` or `elif`; empty if there is none."""
    match node:
        case ast.If(orelse=[ast.If() as branch]):
            return [branch]
    return []


def _describe_unreached(first: ast.expr, later: ast.expr) -> str:
    if ast.dump(first) == ast.dump(later):
        return f"this is never reached: line {first.lineno} asks the same"
    return (
        f"this is never reached: if {_quote(later)}, then also {_quote(first)} (line {first.lineno}); "
        "ask the narrower question first"
    )
