"""Conditions on values over time: `left_red_pc < 10`, `left_color changes`, `sample Colour > 5`, `print matches black`.

Breakpoints, events, filters, goals and the command to go to an instant use them: they are parsed and evaluated here.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from enum import StrEnum
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.engine.core.columns import COLOR_NAMES


class Operator(StrEnum):
    """The operator of a condition. Comparisons have the name of their function in numpy and pyarrow."""

    LESS = "<"
    LESS_EQUAL = "<="
    GREATER = ">"
    GREATER_EQUAL = ">="
    EQUAL = "=="
    NOT_EQUAL = "!="
    CONTAINS = "~"
    """Only for texts: whether they contain the value, in capitals or small letters."""
    CHANGES = "changes"
    MATCHES = "matches"
    """Only for printed lines: whether a regular expression is found in them."""
    SEEN = "is seen"
    """Only for samples: whether one was printed, with any value."""

    @property
    def short(self) -> str:
        """The shortest spelling of the operator, such as `>=`."""
        return next(
            (spelling for spelling, operator in _SPELLINGS.items() if operator is self), self.value
        )


COMPARE: Mapping[str, Callable[[Any, Any], Any]] = {
    Operator.LESS: operator.lt,
    Operator.LESS_EQUAL: operator.le,
    Operator.GREATER: operator.gt,
    Operator.GREATER_EQUAL: operator.ge,
    Operator.EQUAL: operator.eq,
    Operator.NOT_EQUAL: operator.ne,
}
"""Functions of the operators for numbers."""

_SPELLINGS: Mapping[str, Operator] = {"=": Operator.EQUAL}
"""Operators by other spellings than their own."""
_SIGNS = "|".join(
    map(re.escape, sorted((*COMPARE, Operator.CONTAINS, *_SPELLINGS), key=len, reverse=True))
)

NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
"""Regular expression of a number; a text of a million digits fits it in one way only."""


class ValueSource(StrEnum):
    """Where the value that a condition tests comes from: a column, a sample or a printed line."""

    COLUMN = ""
    """A column of a recording or of a log."""
    SAMPLE = "sample"
    """The samples that the program prints."""
    PRINT = "print"
    """The lines that the program prints."""


@dataclass(frozen=True, slots=True)
class ValueCondition:
    """A condition on a column, a sample or a printed line, in the spelling in which a user has typed it."""

    name: str
    """The column, or the variable of a sample; empty for samples of any variable."""
    sign: str
    """The operator as typed."""
    value: str = ""
    source: ValueSource = ValueSource.COLUMN

    @property
    def operator(self) -> Operator:
        """The operator of the condition; its spelling in the text makes no difference."""
        return _SPELLINGS.get(self.sign) or Operator(self.sign)

    @property
    def is_momentary(self) -> bool:
        """Whether the condition is only true at single instants, and never stays true."""
        return self.operator in (Operator.CHANGES, Operator.MATCHES, Operator.SEEN)

    @property
    def number(self) -> float:
        """The value to compare with, as a number; the name of a colour stands for its code.

        Raises:
            ValueError: the value is not a number.
        """
        is_name = is_color(self.name) and self.value in COLOR_NAMES
        return float(COLOR_NAMES.index(self.value)) if is_name else parse_finite_number(self.value)

    def test(self) -> Callable[[Any, Any], Any]:
        """Return a function that tests the condition.

        The function takes a value and the value before it, NaN for the first. It returns whether the condition is true.
        The values may also be arrays; then the result is an array.

        Raises:
            ValueError: the value to compare with is not a number.
        """
        if self.operator is Operator.CHANGES:
            return lambda value, before: (before == before) & (value != before)
        if self.is_momentary:
            return lambda value, _: value == value
        compare = COMPARE[self.operator]
        number = self.number
        return lambda value, _: compare(value, number)

    def format_condition(self, name: str) -> ValueCondition:
        """Return the same condition with the name `name`, and with operator and value in their usual spelling.

        Raises:
            ValueError: the value to compare with is not a number.
        """
        named = replace(self, name=name, sign=self.operator.value)
        if self.is_momentary:
            return named
        common = replace(named, value=format_value(named.number, name, 12))
        return common if common.number == named.number else replace(named, value=repr(named.number))

    def __str__(self) -> str:
        sign = "" if self.sign == Operator.SEEN else self.sign
        return " ".join(filter(None, (self.source, self.name, sign, self.value)))


class Edge:
    """A condition on a value over time, and whether it was true for the last value."""

    __slots__ = ("_before", "_held", "_is_momentary", "_test")

    def __init__(self, condition: ValueCondition) -> None:
        self._test = condition.test()
        self._is_momentary = condition.is_momentary
        self._before = math.nan
        self._held = False

    def update(self, value: float) -> bool:
        """Process the next value; return whether the condition becomes true."""
        held = bool(self._test(value, self._before))
        was_held = self._held
        self._held = held
        self._before = value
        return held and (self._is_momentary or not was_held)


def parse_condition(text: str, name: str = r".+?", value: str = r"\S+") -> ValueCondition | None:
    """Return the condition `NAME OP VALUE` or `NAME changes` in a text; None if the text is not such a condition.

    `name` and `value` are regular expressions that the name and the value must match.
    """
    subject, _, last = text.strip().rpartition(" ")
    if last == Operator.CHANGES and subject:
        return ValueCondition(subject.strip(), Operator.CHANGES)
    # If a text has several operators, the first one that is followed by nothing but a value is the operator.
    match = re.fullmatch(
        rf"\s*(?P<name>{name})(?<![<>=!~])\s*(?P<sign>{_SIGNS})\s*(?P<value>{value})\s*", text
    )
    return ValueCondition(match["name"], match["sign"], match["value"]) if match else None


def parse_run_condition(text: str) -> ValueCondition | None:
    """Return the condition on a run in a text; None if the text is not such a condition.

    A condition on a column is as for `parse_condition`, but without the operator `~`. Other conditions are `sample
    NAME`, `sample NAME OP VALUE`, `sample NAME changes` and `print matches REGEX`.
    """
    word, _, rest = text.strip().partition(" ")
    rest = rest.strip()
    if word == ValueSource.PRINT:
        verb, _, pattern = rest.partition(" ")
        is_whole = verb == Operator.MATCHES and pattern.strip()
        return (
            ValueCondition("", Operator.MATCHES, pattern.strip(), ValueSource.PRINT)
            if is_whole
            else None
        )
    if word == ValueSource.SAMPLE:
        condition = parse_condition(rest, name=r"\w*") or ValueCondition(rest, Operator.SEEN)
        is_one = not condition.name or condition.name.isidentifier()
        return replace(condition, source=ValueSource.SAMPLE) if is_one else None
    named = parse_condition(text)
    return None if named is None or named.operator is Operator.CONTAINS else named


def list_operators(operators: Iterable[str] = COMPARE) -> str:
    """Return operators as one text for a hint, such as `< <= > >=`, each in its shortest spelling."""
    return " ".join(Operator(operator).short for operator in operators)


def describe_comparison(operators: Iterable[str] = COMPARE) -> str:
    """Return a hint that says how to write a comparison, such as `NAME OP VALUE, OP one of < <= > >= = !=`."""
    return f"NAME OP VALUE, OP one of {list_operators(operators)}"


def is_color(column: str) -> bool:
    """Return whether the values of a column are codes of colours, which have names."""
    return column.endswith(("_color", ".color"))


def format_value(value: float, column: str, digits: int = 6) -> str:
    """Return a value of a column as text: the name of a colour, or a number with up to `digits` significant digits."""
    if is_color(column) and value in range(len(COLOR_NAMES)):
        return COLOR_NAMES[int(value)]
    return f"{value:.{digits}g}"


def parse_finite_number(text: str) -> float:
    """Return the number in a text.

    Raises:
        ValueError: the text is not a finite number.
    """
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"{text!r} is not a number") from None
    if not math.isfinite(number):
        raise ValueError(f"{text!r} is not a finite number")
    return number
