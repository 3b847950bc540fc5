"""Conditions on values over time: `left_red_pc < 10`, `left_color changes`, `sample Colour > 5`, `print matches black`.

Breakpoints, go to, events, filters and goals read them here, and ask here whether they are true.
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
    """What a condition asks of a value. Comparisons have the name of their function in numpy and pyarrow."""

    LESS = "<"
    LESS_EQUAL = "<="
    GREATER = ">"
    GREATER_EQUAL = ">="
    EQUAL = "=="
    NOT_EQUAL = "!="
    CONTAINS = "~"
    """Only for texts: they contain the value, in any case of letters."""
    CHANGES = "changes"
    MATCHES = "matches"
    """Only for printed lines: a regular expression is found in them."""
    SEEN = "is seen"
    """Only for samples: one was printed, with any value."""

    @property
    def short(self) -> str:
        """The shortest spelling."""
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
"""Other spellings."""
_SIGNS = "|".join(
    map(re.escape, sorted((*COMPARE, Operator.CONTAINS, *_SPELLINGS), key=len, reverse=True))
)

NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
"""Regular expression of a number; a text of a million digits fits it in one way only."""


class ValueSource(StrEnum):
    """Where a condition takes its values from."""

    COLUMN = ""
    """A column of a recording or of a log."""
    SAMPLE = "sample"
    """The samples that the program prints."""
    PRINT = "print"
    """The lines that it prints."""


@dataclass(frozen=True, slots=True)
class ValueCondition:
    """A condition as typed."""

    name: str
    """The column or variable; of samples empty for any."""
    sign: str
    """The operator as typed."""
    value: str = ""
    source: ValueSource = ValueSource.COLUMN

    @property
    def operator(self) -> Operator:
        """The operator, whatever its spelling."""
        return _SPELLINGS.get(self.sign) or Operator(self.sign)

    @property
    def is_momentary(self) -> bool:
        """Whether it is true at single instants: it does not stay true."""
        return self.operator in (Operator.CHANGES, Operator.MATCHES, Operator.SEEN)

    @property
    def number(self) -> float:
        """The value as a number; a colour has a name.

        Raises:
            ValueError: it is none.
        """
        is_name = is_color(self.name) and self.value in COLOR_NAMES
        return float(COLOR_NAMES.index(self.value)) if is_name else parse_finite_number(self.value)

    def test(self) -> Callable[[Any, Any], Any]:
        """Return the function that tells whether it is true of a value, or of each value of an array.

        The function takes the value, and the value before it: NaN for the first.

        Raises:
            ValueError: the value to compare with is no number.
        """
        if self.operator is Operator.CHANGES:
            return lambda value, before: (before == before) & (value != before)
        if self.is_momentary:
            return lambda value, _: value == value
        compare = COMPARE[self.operator]
        number = self.number
        return lambda value, _: compare(value, number)

    def format_condition(self, name: str) -> ValueCondition:
        """Return the condition as it is written of a column with this name.

        Raises:
            ValueError: the value to compare with is no number.
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
    """Follows a value: tells when a condition becomes true of it, not while it stays true."""

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
    """Return the condition `NAME OP VALUE` or `NAME changes` that a text is; None if it is none.

    `name` and `value` are regular expressions of what is allowed.
    """
    subject, _, last = text.strip().rpartition(" ")
    if last == Operator.CHANGES and subject:
        return ValueCondition(subject.strip(), Operator.CHANGES)
    # Of several operators the first one counts after which everything is a value.
    match = re.fullmatch(
        rf"\s*(?P<name>{name})(?<![<>=!~])\s*(?P<sign>{_SIGNS})\s*(?P<value>{value})\s*", text
    )
    return ValueCondition(match["name"], match["sign"], match["value"]) if match else None


def parse_run_condition(text: str) -> ValueCondition | None:
    """Return the condition on a run that a text is, None if it is none.

    On a column as `parse_condition`, except `~`; `sample NAME`, `sample NAME OP VALUE`, `sample NAME changes`;
    `print matches REGEX`.
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
    """Return operators as they are listed in hints, each in its shortest spelling."""
    return " ".join(Operator(operator).short for operator in operators)


def describe_comparison(operators: Iterable[str] = COMPARE) -> str:
    """Return the form of a comparison, for the hint of an error."""
    return f"NAME OP VALUE, OP one of {list_operators(operators)}"


def is_color(column: str) -> bool:
    """Return whether the values of a column are codes of colours, which have names."""
    return column.endswith(("_color", ".color"))


def format_value(value: float, column: str, digits: int = 6) -> str:
    """Return a value of a column as it is written: a colour by its name."""
    if is_color(column) and value in range(len(COLOR_NAMES)):
        return COLOR_NAMES[int(value)]
    return f"{value:.{digits}g}"


def parse_finite_number(text: str) -> float:
    """Return a number.

    Raises:
        ValueError: it is not a finite number.
    """
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"{text!r} is not a number") from None
    if not math.isfinite(number):
        raise ValueError(f"{text!r} is not a finite number")
    return number
