"""Comparisons such as `Colour < 50`, as in breakpoints, go-to, filters, events and expressions."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any


class Operator(StrEnum):
    """A comparison operator, with the name of its function in numpy and pyarrow."""

    LESS = "<"
    LESS_EQUAL = "<="
    GREATER = ">"
    GREATER_EQUAL = ">="
    EQUAL = "=="
    NOT_EQUAL = "!="
    CONTAINS = "~"
    """Only for texts: they contain the value, in any case of letters."""

    @property
    def short(self) -> str:
        """The shortest spelling."""
        return next((spelling for spelling, one in _SPELLINGS.items() if one is self), self.value)


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
_SIGNS = "|".join(map(re.escape, sorted((*Operator, *_SPELLINGS), key=len, reverse=True)))

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
"""Regular expression of a number."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """A comparison as typed."""

    name: str
    sign: str
    """The operator as typed."""
    value: str

    @property
    def operator(self) -> Operator:
        """The operator, whatever its spelling."""
        return _SPELLINGS.get(self.sign) or Operator(self.sign)

    def __str__(self) -> str:
        return f"{self.name} {self.sign} {self.value}"


def comparison_in(text: str, name: str = r".+?", value: str = r"\S+") -> Comparison | None:
    """Return the comparison `NAME OP VALUE` that a text is; None if it is none.

    `name` and `value` are regular expressions of what is allowed.
    """
    # Of several operators the first one counts after which everything is a value.
    found = re.fullmatch(rf"\s*(?P<name>{name})(?<![<>=!~])\s*(?P<sign>{_SIGNS})\s*(?P<value>{value})\s*", text)
    return Comparison(found["name"], found["sign"], found["value"]) if found else None


def spelled(operators: Iterable[str] = COMPARE) -> str:
    """Return operators as they are listed in hints, each in its shortest spelling."""
    return " ".join(Operator(one).short for one in operators)


def comparison_form(operators: Iterable[str] = COMPARE) -> str:
    """Return the form of a comparison, for the hint of an error."""
    return f"NAME OP VALUE, OP one of {spelled(operators)}"


def finite_number(text: str) -> float:
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
