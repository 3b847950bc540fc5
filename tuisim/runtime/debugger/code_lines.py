"""The lines of a program that have code: a breakpoint on any other line would never be hit."""

from __future__ import annotations

import types
from bisect import bisect_left


class CodeLines:
    """The lines of one program.

    Args:
        code: The program; None if there is none.
    """

    def __init__(self, code: types.CodeType | None) -> None:
        self._code = code
        self._lines: list[int] | None = None

    def from_here(self, line: int) -> int:
        """Return `line` or, if it has no code, the next line that has.

        After the last such line, and for 0, return `line`.
        """
        if self._lines is None:
            self._lines = sorted(_lines_of(self._code)) if self._code else []
        at = bisect_left(self._lines, line)
        return self._lines[at] if line and at < len(self._lines) else line


def _lines_of(code: types.CodeType) -> set[int]:
    found: set[int] = set()
    left = [code]
    while left:
        one = left.pop()
        found |= {line for _, _, line in one.co_lines() if line}
        left += [part for part in one.co_consts if isinstance(part, types.CodeType)]
    return found
