"""Checks that the frozen specs make of their values."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tuisim.errors import ConfigError, RobotError


def require(
    value: float, low: float, high: float, key: str, error: type[ConfigError] = RobotError, *, whole: bool = False
) -> None:
    """Check that a value is a number within limits.

    Args:
        value: What is checked; a truth value is no number.
        low: The least that is allowed.
        high: The most that is allowed.
        key: What the value is called.
        error: Class of the error.
        whole: Whether only whole numbers are allowed.

    Raises:
        ConfigError: of the class `error`: it is not.
    """
    number = isinstance(value, int) or (isinstance(value, float) and not whole and math.isfinite(value))
    if not number or isinstance(value, bool):
        raise error(f"must be a {'whole ' if whole else ''}number, got {value!r}", key=key)
    if not low <= value <= high:
        raise error(f"must be from {low:g} to {high:g}, got {value!r}", key=key)


def require_one_of(
    value: object, what: str, allowed: Iterable[object], key: str, error: type[ConfigError] = RobotError
) -> None:
    """Check that a value is among some.

    Args:
        value: What is checked; a truth value is no number.
        what: What it is, such as `port`.
        allowed: Everything that it can be.
        key: What the value is called.
        error: Class of the error.

    Raises:
        ConfigError: of the class `error`: it is not.
    """
    allowed = tuple(allowed)
    if value not in allowed or isinstance(value, bool):
        raise error(f"no such {what} {value!r}", f"one of {', '.join(map(str, allowed))}", key=key)
