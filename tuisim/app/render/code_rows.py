"""A program in a narrow column: long lines become several rows, which are the same program."""

from __future__ import annotations

import io
import textwrap
import tokenize
from collections.abc import Iterator, Mapping
from dataclasses import field

from tuisim.base.data_class import dataclass
from tuisim.base.source import source_lines

_INDENT = "  "
"""The indentation of the further rows of a line."""
_CONTINUATION = " \\"
"""Ends a row that goes on, outside of brackets."""
_OPEN, _CLOSED = frozenset("([{"), frozenset(")]}")
_LAYOUT = frozenset(
    {tokenize.NEWLINE, tokenize.NL, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}
)
_TEXT_BEGINS, _TEXT_ENDS = (getattr(tokenize, f"FSTRING_{word}", None) for word in ("START", "END"))


@dataclass(slots=True)
class _Breaks:
    """The columns at which one line of a program may be broken."""

    inside: dict[int, bool] = field(default_factory=dict)
    """The columns at which a row may begin, each with whether it is in brackets."""
    comment: int | None = None
    """Column at which the line's comment begins; None without one."""


def split_rows(program: str, width: int) -> Iterator[str]:
    """Yield a program as rows of at most `width` cells; a row is longer only if a single word is.

    Rows are broken between words, in brackets if possible; elsewhere they end in a backslash. A comment behind a long
    line is put above the line. A program that Python cannot read keeps its lines.
    """
    try:
        breaks = _find_breaks(program)
    except (tokenize.TokenError, SyntaxError):
        breaks = {}
    for number, line in enumerate(source_lines(program), start=1):
        if len(line) <= width or number not in breaks:
            yield line
        else:
            yield from _split_line(line, breaks[number], width)


def _find_breaks(program: str) -> Mapping[int, _Breaks]:
    """Return for each line of a program the columns at which it may be broken, by line number from 1.

    A line may be broken after a blank or an opening bracket, and before a dot.
    """
    breaks: dict[int, _Breaks] = {}
    depth = texts = 0
    before: tokenize.TokenInfo | None = None
    for token in tokenize.generate_tokens(io.StringIO(program).readline):
        line, column = token.start
        line_breaks = breaks.setdefault(line, _Breaks())
        same_line = before is not None and before.end[0] == line and before.type not in _LAYOUT
        is_word = token.type not in _LAYOUT and not texts
        if token.type == tokenize.COMMENT:
            line_breaks.comment = column
        elif before and same_line and is_word and _can_break(before, token):
            line_breaks.inside[column] = depth > 0
        texts += (token.type == _TEXT_BEGINS) - (token.type == _TEXT_ENDS)
        if token.type == tokenize.OP:
            depth += (token.string in _OPEN) - (token.string in _CLOSED)
        before = token
    return breaks


def _can_break(before: tokenize.TokenInfo, token: tokenize.TokenInfo) -> bool:
    return before.end[1] < token.start[1] or before.string in _OPEN or token.string == "."


def _split_line(line: str, breaks: _Breaks, width: int) -> Iterator[str]:
    indent = line[: len(line) - len(line.lstrip())]
    if breaks.comment is not None:
        words = line[breaks.comment :].lstrip("#").strip()
        line = line[: breaks.comment].rstrip()
        sign = f"{indent}# "
        yield from textwrap.wrap(
            words,
            width,
            initial_indent=sign,
            subsequent_indent=sign,
            break_long_words=False,
            break_on_hyphens=False,
        )
    lead = ""
    start = len(indent)
    while line[start:]:
        room = width - len(indent) - len(lead)
        end = len(line) if len(line) - start <= room else _end(line, start, room, breaks.inside)
        tail = _CONTINUATION if end < len(line) and not breaks.inside[end] else ""
        yield f"{indent}{lead}{line[start:end].rstrip()}{tail}"
        lead = _INDENT
        start = end


def _end(line: str, start: int, room: int, inside: Mapping[int, bool]) -> int:
    """Return the column at which to break a line: in brackets if possible, before a dot only if nothing else fits.

    If nothing fits, return the column of the next possible break, or the end of the line.

    Args:
        line: The line.
        start: The column at which the row begins.
        room: How many characters fit.
        inside: The columns of possible breaks, and whether each is in brackets.
    """
    later = [column for column in inside if column > start]
    fits = [
        column
        for column in later
        if len(line[start:column].rstrip()) + (0 if inside[column] else len(_CONTINUATION)) <= room
    ]
    words = [column for column in fits if line[column] != "."]
    in_brackets = [column for column in words if inside[column]]
    return max(in_brackets or words or fits, default=min(later, default=len(line)))
