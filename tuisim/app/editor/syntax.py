"""Syntax highlighting of Python line by line, so that an edit costs no more than the lines that it changes.

A line depends on those above only through the triple-quoted string that it may begin in. So the state before each line
is stored, and after an edit it is recomputed only until the states agree again.
"""

from __future__ import annotations

import builtins
import keyword
import re
from collections.abc import Sequence

Span = tuple[int, int, str]
"""First column of a coloured part of a line, the column after its last one, and its kind, one of `KINDS`."""

KINDS = ("keyword", "string", "comment", "number", "name")

_BUILTINS = frozenset(name for name in dir(builtins) if not name.startswith("_"))
_TOKEN = re.compile(
    r"""
    (?P<comment>\#.*)
    | (?P<triple>[rRbBuUfF]{0,2}(?:\"\"\"|'''))
    | (?P<string>[rRbBuUfF]{0,2}(?:"(?:[^"\\]|\\.)*(?:"|\\?$)|'(?:[^'\\]|\\.)*(?:'|\\?$)))
    | (?P<number>\b(?:0[xXoObB][\da-fA-F_]+|\d[\d_]*\.?[\d_]*(?:[eE][+-]?\d+)?[jJ]?)|\B\.\d[\d_]*(?:[eE][+-]?\d+)?)
    | (?P<word>[^\W\d]\w*)
    """,
    re.VERBOSE,
)
_CLOSING = {quote: re.compile(rf"(?:[^\\]|\\.)*?{quote}") for quote in ('"""', "'''")}


def find_spans(line: str, before: str = "") -> tuple[list[Span], str]:
    """Return the coloured parts of a line of Python, and the quotes of a string that goes on in the next line.

    Each part is its first column, the column after its last one, and its kind, such as `string`. The quotes are empty
    if no string goes on.

    Args:
        line: Without its line end.
        before: The quotes of the string in which the line begins, empty if in none.
    """
    spans: list[Span] = []
    position = 0
    state = before
    named = False
    while True:
        if state:
            closed = _CLOSING[state].match(line, position)
            start = (
                spans.pop()[0]
                if spans and spans[-1][1] == position and spans[-1][2] == "string"
                else position
            )
            end = closed.end() if closed else len(line)
            if end > start:
                spans.append((start, end, "string"))
            if not closed:
                return spans, state
            position = end
            state = ""
        match = _TOKEN.search(line, position)
        if match is None:
            return spans, ""
        position = match.end()
        kind = str(match.lastgroup)
        if kind == "triple":
            state = match.group()[-3:]
            kind = "string"
        elif kind == "word":
            word = match.group()
            if keyword.iskeyword(word):
                kind = "keyword"
            elif named or word in _BUILTINS:
                kind = "name"
            else:
                kind = ""
            named = word in ("def", "class")
        if kind:
            spans.append((match.start(), position, kind))


class Colouring:
    """Finds the colours of a text that is edited; it remembers which lines begin inside a string of several lines."""

    def __init__(self) -> None:
        self._before: list[str] = [""]

    def forget_line(self, line: int) -> None:
        """Drop the stored colours of a line, from 0, that was edited, and of all lines below it."""
        del self._before[line + 1 :]

    def color_line(self, lines: Sequence[str], line: int) -> list[Span]:
        """Return the coloured parts of one line of the text, as `find_spans` does.

        Args:
            lines: The lines of the text.
            line: Index of the line, from 0.
        """
        states = self._before
        while len(states) <= line:
            above = lines[len(states) - 1]
            # Most lines have no triple quotes and need no further scan.
            plain = '"""' not in above and "'''" not in above
            states.append(states[-1] if plain else find_spans(above, states[-1])[1])
        return find_spans(lines[line], states[line])[0]
