"""The line of a key in a TOML text, for errors: the parser of the standard library does not tell it."""

from __future__ import annotations

import re
import tomllib
from bisect import bisect_left
from typing import Any

_STATEMENT = re.compile(r"[ \t]*(?:[\w\"'-].*=|\[.*\][ \t]*(?:#.*)?$)")
"""What a line looks like that begins a statement; some others look like it, too."""
_STEP = re.compile(r"\[(\d+)\]|([^.\[\]]+)")


def line_of_key(text: str, key: str) -> int:
    """Return the line, from 1, at which a value of a valid TOML text begins.

    Args:
        key: Its path, such as `goal[2].reach.x_mm`, where entries count from 1. If there is no such value, the line
            of the innermost table around it is returned; 1 if there is none.
    """
    lines = text.split("\n")
    path = [int(step[1]) - 1 if step[1] else step[2] for step in _STEP.finditer(key)]
    while path and not _has(_parsed(lines), path):
        path.pop()

    # Only where statements begin: a value on thousands of lines would be parsed as often.
    starts = [index for index, line in enumerate(lines) if _STATEMENT.match(line)]
    ends = [*starts, len(lines)]

    def begun(count: int) -> bool:
        """Whether the value begins in the first statements; a value that they cut off is read to its end."""
        while (found := _parsed(lines[: ends[count]])) is None:
            count += 1
        return _has(found, path)

    statements = bisect_left(range(len(ends)), True, key=begun)
    return starts[statements - 1] + 1 if statements else 1


def _parsed(lines: list[str]) -> Any:
    try:
        return tomllib.loads("\n".join(lines))
    except (ValueError, RecursionError):
        return None


def _has(data: Any, path: list[int | str]) -> bool:
    try:
        for step in path:
            data = data[step]
    except (KeyError, IndexError, TypeError):
        return False
    return True
