"""Maps lines of the running text to lines of the same text after edits, and back."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import SequenceMatcher

MOST_COMPARED = 400
"""Up to this many changed lines are compared one by one; of more, only the lines before and after are mapped."""


class LineMap:
    """The lines that two texts have in common, in the same order. Lines count from 1; 0 is none.

    Args:
        run: Lines of the running text.
        shown: Lines of the text shown.
    """

    def __init__(self, run: Sequence[str], shown: Sequence[str]) -> None:
        self._to_shown = [0] * (len(run) + 1)
        self._to_run = [0] * (len(shown) + 1)
        least, same = min(len(run), len(shown)), 0
        while same < least and run[same] == shown[same]:
            same += 1
        last = 0
        while last < least - same and run[-1 - last] == shown[-1 - last]:
            last += 1
        self._join(0, 0, same)
        self._join(len(run) - last, len(shown) - last, last)
        old, new = run[same : len(run) - last], shown[same : len(shown) - last]
        if max(len(old), len(new)) <= MOST_COMPARED:
            for block in SequenceMatcher(None, old, new, autojunk=False).get_matching_blocks():
                self._join(same + block.a, same + block.b, block.size)

    def _join(self, run: int, shown: int, count: int) -> None:
        for at in range(1, count + 1):
            self._to_shown[run + at], self._to_run[shown + at] = shown + at, run + at

    def to_shown(self, line: int) -> int:
        """Return the line of the text shown for a line of the running text."""
        return self._to_shown[line] if 0 <= line < len(self._to_shown) else 0

    def to_run(self, line: int) -> int:
        """Return the line of the running text for a line of the text shown."""
        return self._to_run[line] if 0 <= line < len(self._to_run) else 0
