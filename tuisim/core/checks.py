"""Validation of values in the frozen specs."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tuisim.errors import ConfigError, RobotError


def require(
    value: float, low: float, high: float, key: str, error: type[ConfigError] = RobotError, *, whole: bool = False
) -> None:
    """Check that a value is a number within limits.

    Args:
        value: Value to check; a bool is not a number.
        low: Smallest allowed value.
        high: Largest allowed value.
        key: Name of the value in the error.
        error: Class of the error.
        whole: Whether only whole numbers are allowed.

    Raises:
        ConfigError: the check failed; raised as `error`.
    """
    number = isinstance(value, int) or (isinstance(value, float) and not whole and math.isfinite(value))
    if not number or isinstance(value, bool):
        raise error(f"must be a {'whole ' if whole else ''}number, got {value!r}", key=key)
    if not low <= value <= high:
        raise error(f"must be from {low:g} to {high:g}, got {value!r}", key=key)


def require_one_of(
    value: object, what: str, allowed: Iterable[object], key: str, error: type[ConfigError] = RobotError
) -> None:
    """Check that a value is one of `allowed`.

    Args:
        value: Value to check; a bool is not a number.
        what: What the value is, such as `port`.
        allowed: All allowed values.
        key: Name of the value in the error.
        error: Class of the error.

    Raises:
        ConfigError: the check failed; raised as `error`.
    """
    allowed = tuple(allowed)
    if value not in allowed or isinstance(value, bool):
        raise error(f"no such {what} {value!r}", f"one of {', '.join(map(str, allowed))}", key=key)
