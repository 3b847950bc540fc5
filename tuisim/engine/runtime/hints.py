"""Hints of errors for which Python has none: a name of the library that was meant, and text that numbers become."""

from __future__ import annotations

import re
from typing import Any

from tuisim.base.meant import find_meant_names

_LIBRARIES = frozenset({"ev3dev2", "pybricks"})
_TEXT_AND_NUMBER = re.compile(
    r'can only concatenate str \(not "(?:int|float)"\) to str'
    r"|unsupported operand type\(s\) for \+: '(?:int|float)' and 'str'"
)


def add_hint(trace: Any, error: BaseException) -> None:
    """Add a hint to the message of an error, unless Python has already suggested something.

    Args:
        trace: The error as a `traceback.TracebackException`.
        error: The error itself.
    """
    hint = ""
    if type(error) is AttributeError:
        hint = "" if "Did you mean" in str(trace._str) else _find_meant(error)
    elif type(error) is TypeError and _TEXT_AND_NUMBER.fullmatch(str(trace._str)):
        hint = "`str(number)` makes text of a number"
    if hint:
        trace._str = f"{trace._str}. {hint}"


def _find_meant(error: AttributeError) -> str:
    """Return a suggestion of similar names for a wrong attribute of a library's object; empty if there are none."""
    kind = type(error.obj)
    wrong = error.name
    library = str(getattr(kind, "__module__", "")).partition(".")[0]
    if not isinstance(wrong, str) or library not in _LIBRARIES:
        return ""
    # The names of classes only: to list those of an object may run code.
    names = {name for base in kind.__mro__ for name in vars(base)}
    meant = find_meant_names(wrong, names)
    return f"Did you mean: {' or '.join(map(repr, meant))}?" if meant else ""
