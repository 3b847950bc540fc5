"""What every condition of a goal has: its kind, its limits, and the ranges of its values."""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import StrEnum
from typing import Annotated, ClassVar

from msgspec import Meta

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

MAX_PLACES = 1000
"""Largest number of places, levels, lines, calls or turns in one condition."""

X = Annotated[float, Meta(ge=0, le=FIELD_WIDTH_MM)]
Y = Annotated[float, Meta(ge=0, le=FIELD_HEIGHT_MM)]
Heading = Annotated[float, Meta(ge=-36_000, le=36_000)]
Tolerance = Annotated[float, Meta(ge=1, le=2000)]
Share = Annotated[float, Meta(ge=0.01, le=1)]
Percent = Annotated[float, Meta(ge=0, le=100)]
Offset = Annotated[float, Meta(ge=-500, le=500)]
Seconds = Annotated[float, Meta(ge=0, le=1e6)]
Points = Annotated[float, Meta(ge=-1000, le=1000)]
Gap = Annotated[float, Meta(ge=0, le=10_000)]
Times = Annotated[int, Meta(ge=0, le=1_000_000)]
Number = Annotated[float, Meta(ge=-1e15, le=1e15)]


class UnjudgedError(Exception):
    """A condition cannot be judged; the error's text says why, without a full stop."""


class ConditionKind(StrEnum):
    """The kinds of conditions, by when a condition is met or missed: for example, as soon as it is true once."""

    REACHED = "reached"
    """Met as soon as it is true once; missed if that never happens."""
    HELD = "held"
    """Missed as soon as it is violated; met if that never happens."""
    FIXED = "fixed"
    """Known from the program's text, before the run."""
    COMBINED = "combined"
    """Decided by other goals."""


LIMITS: Mapping[ConditionKind, tuple[str, ...]] = {
    ConditionKind.REACHED: ("before", "after"),
    ConditionKind.HELD: ("after", "until"),
    ConditionKind.FIXED: (),
    ConditionKind.COMBINED: ("before",),
}
"""The limits that a condition of a kind can have."""
WINDOWED = (ConditionKind.REACHED, ConditionKind.HELD)
"""The kinds of conditions that can be limited to a duration, see `Goal.within_s`."""


def check_count(entries: tuple[object, ...], key: str) -> None:
    """Check the number of entries in a list of a goals file.

    Args:
        entries: The list.
        key: The key of the list, for the error.

    Raises:
        ConfigError: there are none, or too many.
    """
    if not 1 <= len(entries) <= MAX_PLACES:
        raise ConfigError(f"must have 1 to {MAX_PLACES} entries, has {len(entries)}", key=key)


@dataclass(frozen=True, slots=True)
class Condition:
    """The base class of the conditions that a goal can set for a run, such as that the robot reaches a place."""

    KIND: ClassVar[ConditionKind] = ConditionKind.REACHED
    SHORT: ClassVar[str] = ""
    """The key of a value that a file gives in place of a table; a single text may replace a list."""


def require_regex(pattern: str, key: str) -> None:
    """Check that a text is a regular expression.

    Args:
        pattern: Text to check.
        key: Name of the value in the error.

    Raises:
        ConfigError: the text is not a regular expression.
    """
    try:
        re.compile(pattern)
    except (re.error, RecursionError, OverflowError) as error:
        raise ConfigError(f"{pattern!r} is not a regular expression: {error}", key=key) from None
