"""Draws excerpts: the part of a passage that is shown among the answers to a question."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from textwrap import dedent, wrap

from tuisim.guide.catalogue import LINK
from tuisim.guide.markdown import CODE, PLAIN, render_markdown, render_plain_text
from tuisim.guide.search import SET_IN, SearchResult
from tuisim.terminal.text_runs import Line

_CLEAR_COLUMNS = 2
"""A row of a table with at most this number of columns is shown without the heads of the columns."""
_CODE_BELOW = re.compile(r"(?<=:)\n\s*\n|\n\s*\n(?=    )")
"""Matches the gap before the code that belongs to a passage."""
_MARK = re.compile(r"\A(?:- |\d+\. )")
_ELLIPSIS = " …"
_BULLET = "• "
_NOTE = re.compile(r" {2,}#")
"""Matches the gap before a comment beside code."""
_SENTENCE_END = re.compile(r"(?<=[.:!?]) (?=[\w`*])")
_PREFIX_LETTERS = 4
"""Matched words whose first letters, this many, are the same count as one word."""
_SCRIPT_COLUMNS = ("group", "id")
"""Columns of the table of keys that an excerpt leaves out, as they tell the reader of one row nothing."""
_CACHED_TEXTS = 256
"""Largest number of texts whose drawn lines are cached, enough for the answers to several questions."""
_MIN_LINES = 3
"""Fewest lines that the text of an excerpt gets, and fewest lines of code among which the best one is looked for."""


def draw_excerpt(
    passage: SearchResult, width: int, max_lines: int, pattern: re.Pattern[str] | None = None
) -> list[Line]:
    """Return the lines of an excerpt of a found passage: its beginning, or the part with most words of the question.

    Args:
        passage: The passage.
        width: The width of the lines in columns.
        max_lines: The largest number of lines; an ellipsis stands for the omitted text.
        pattern: Matches the words of the question; None for the beginning. The excerpt of a long passage begins at the
            sentence, or the line of code, after which there are most matches.
    """
    words, *set_in = (
        ("", passage.passage)
        if passage.passage.startswith(SET_IN)
        else _CODE_BELOW.split(passage.passage)
    )
    code = [
        part for line in dedent("\n".join(set_in)).split("\n") for part in _wrap_code(line, width)
    ]
    markdown = _strip_marks(_add_heads(words, passage.head))
    max_text_lines = min(
        max_lines,
        max(max_lines - len(code) - len(passage.below), max_lines - _MIN_LINES, _MIN_LINES),
    )
    if pattern and len(_draw_markdown(markdown, width)) > max_text_lines:
        markdown = _cut_beginning(markdown, width * max_text_lines, pattern)
    lines = [*_draw_shortened(markdown, width, max_text_lines)]
    items = [line for item in passage.below for line in _draw_item(item, width)]
    lines += items if len(items) <= (room := max_lines - len(lines)) else _cut_lines(items, room)
    return lines + [[(line, CODE)] for line in _cut_code(code, max_lines - len(lines), pattern)]


def _cut_lines(lines: list[Line], max_lines: int) -> list[Line]:
    """Return the first lines, at most `max_lines`; the last one is an ellipsis if there are more lines.

    With `max_lines` of 1, there is no ellipsis.
    """
    return (
        [*lines[: max_lines - 1], [(_ELLIPSIS.strip(), PLAIN)]]
        if max_lines > 1
        else lines[:max_lines]
    )


def _cut_code(code: list[str], max_lines: int, pattern: re.Pattern[str] | None) -> list[str]:
    """Return up to `max_lines` successive lines of code: those with most words of a question.

    If further lines follow, an ellipsis stands for them.
    """
    if len(code) <= max_lines or max_lines < _MIN_LINES:
        return code[:max_lines]
    first = _find_best_line(code, max_lines - 1, pattern) if pattern else 0
    visible = code[first : first + max_lines - 1]
    return [*visible, _ELLIPSIS.strip()] if first + len(visible) < len(code) else code[-max_lines:]


def _wrap_code(line: str, width: int) -> list[str]:
    """Return a line of code as lines of at most `width` columns; no lines if it is empty."""
    further = " " * (len(line) - len(line.lstrip()) + 4)
    return wrap(_NOTE.sub("  #", line), width, subsequent_indent=further, replace_whitespace=False)


def _draw_shortened(markdown: str, width: int, max_lines: int) -> list[Line]:
    """Return the first lines of Markdown; if there are more, the last one ends in an ellipsis."""
    lines = _draw_markdown(markdown, width)
    if len(lines) <= max_lines:
        return lines
    *above, last = _draw_markdown(markdown, width - len(_ELLIPSIS))[:max_lines]
    return [*above, [*last, (_ELLIPSIS, PLAIN)]]


@lru_cache(_CACHED_TEXTS)
def _draw_markdown(markdown: str, width: int) -> list[Line]:
    """Return Markdown as lines of at most `width` columns, cached since answers are drawn often.

    Callers must not change them.
    """
    return render_markdown(markdown, width)


def _draw_item(item: str, width: int) -> list[Line]:
    """Return an item of a list, or a row of a table, as lines of at most `width` columns."""
    lines = _draw_markdown(_strip_marks(item), width - len(_BULLET))
    return [
        [(" " * len(_BULLET) if row else _BULLET, PLAIN), *line] for row, line in enumerate(lines)
    ]


def _cut_beginning(text: str, letters: int, pattern: re.Pattern[str]) -> str:
    """Return a text without its beginning: it begins at the sentence after which most words of a question follow.

    Args:
        text: The text.
        letters: How many characters after the beginning of a sentence are searched for words of the question.
        pattern: Matches the words.
    """
    starts = [0, *(match.end() for match in _SENTENCE_END.finditer(text))]
    start = max(
        starts,
        key=lambda start_index: (
            _count_words(text[start_index : start_index + letters], pattern),
            -start_index,
        ),
    )
    return f"… {text[start:]}" if start else text


def _find_best_line(lines: Sequence[str], count: int, pattern: re.Pattern[str]) -> int:
    """Return the index of the line from which the next `count` lines have most words of the question."""
    starts = range(max(1, len(lines) - count + 1))
    return max(
        starts, key=lambda row: (_count_words("\n".join(lines[row : row + count]), pattern), -row)
    )


def _count_words(text: str, pattern: re.Pattern[str]) -> int:
    return len({word[:_PREFIX_LETTERS].lower() for word in pattern.findall(text)})


def _add_heads(passage: str, head: str) -> str:
    """Return a row of a table in which each cell, except the first, follows the heading of its column.

    A row of few columns is returned unchanged.

    Args:
        passage: The row.
        head: The row with the headings.
    """
    cells = split_cells(passage)
    heads = split_cells(head)
    if not head or len(cells) <= _CLEAR_COLUMNS or len(heads) != len(cells):
        return passage
    named_cells = [
        (name, cell)
        for name, cell in zip(heads[1:], cells[1:], strict=True)
        if cell and name not in _SCRIPT_COLUMNS
    ]
    texts = (
        [f"{name}: {cell}" for name, cell in named_cells]
        if len(named_cells) > 1
        else [cell for _, cell in named_cells]
    )
    return "| " + " | ".join([cells[0], *texts]) + " |"


def flatten_passage(markdown: str) -> str:
    """Return a passage of a page as one line of plain text."""
    return " ".join(render_plain_text(_strip_marks(markdown)).split())


def _strip_marks(markdown: str) -> str:
    """Return a passage as one line of plain text: without the signs of Markdown for lists, table cells and links."""
    text = " · ".join(filter(None, split_cells(_MARK.sub("", markdown))))
    if markdown.startswith("|"):
        text = text.replace(r"\|", "|")
    # The text becomes one line: a line that begins with a number would be drawn as an item of a list.
    return " ".join(LINK.sub(lambda link: link[1], text).split())


def split_cells(markdown: str) -> list[str]:
    """Return the cells of a passage that is a row of a table; for any other passage, a list with only the passage."""
    return (
        [cell.strip() for cell in markdown.strip("|").split(" | ")]
        if markdown.startswith("|")
        else [markdown]
    )
