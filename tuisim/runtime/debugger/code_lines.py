"""Which lines of a program have code: only these are ever about to run."""

from __future__ import annotations

import types
from bisect import bisect_left


class CodeLines:
    """The lines of one program.

    Args:
        code: The program, None if there is none.
    """

    def __init__(self, code: types.CodeType | None) -> None:
        self._code = code
        self._lines: list[int] | None = None

    def from_here(self, line: int) -> int:
        """Return the line, or if it is blank, a comment or the like, the next one that has code.

        Behind the last such line, and for 0, the line itself.
        """
        if self._lines is None:
            self._lines = sorted(_lines_of(self._code)) if self._code else []
        at = bisect_left(self._lines, line)
        return self._lines[at] if line and at < len(self._lines) else line


def _lines_of(code: types.CodeType) -> set[int]:
    """The lines of a piece of code and of all functions and classes in it."""
    found: set[int] = set()
    left = [code]
    while left:
        one = left.pop()
        found |= {line for _, _, line in one.co_lines() if line}
        left += [part for part in one.co_consts if isinstance(part, types.CodeType)]
    return found
