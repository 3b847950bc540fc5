"""What is shown of a passage among the answers to a question."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from textwrap import dedent, wrap

from tuisim.guide.catalogue import LINK
from tuisim.guide.search import SET_IN, SearchResult
from tuisim.tasks.lessons.markdown import CODE, PLAIN, markdown_lines, plain_text
from tuisim.terminal.text_runs import Line

_CLEAR_COLUMNS = 2
"""Rows of a table with so many columns need no heads."""
_CODE_BELOW = re.compile(r"(?<=:)\n\s*\n|\n\s*\n(?=    )")
"""Before the code that belongs to a passage."""
_MARK = re.compile(r"\A(?:- |\d+\. )")
_ELLIPSIS = " …"
_BULLET = "• "
_NOTE = re.compile(r" {2,}#")
"""Before a comment beside code, in a column with others."""
_SENTENCE_END = re.compile(r"(?<=[.:!?]) (?=[\w`*])")
_TOLD_BY = 4
"""Letters that tell one word of a question from another."""
_FOR_SCRIPTS = ("group", "id")
"""Columns of the keys that say nothing to a reader of one of them."""
_KEPT = 256
"""Texts that are kept as lines: those of several questions."""
_LEAST = 3
"""Lines that make sense by themselves, of a text as of code."""


def excerpt_of(
    one: SearchResult, width: int, most: int, asked: re.Pattern[str] | None = None
) -> list[Line]:
    """Return what is shown of a passage that was found: its beginning, or what the question is about.

    Args:
        one: What was found.
        width: Columns.
        most: So many lines at most; what is left out is an ellipsis.
        asked: Finds the words of the question. A longer passage begins where most of them follow: at a sentence,
            and its code at a line.
    """
    words, *set_in = (
        ("", one.passage) if one.passage.startswith(SET_IN) else _CODE_BELOW.split(one.passage)
    )
    code = [
        part for line in dedent("\n".join(set_in)).split("\n") for part in _wrapped(line, width)
    ]
    markdown = _as_sentences(_with_head(words, one.head))
    most_of_text = min(most, max(most - len(code) - len(one.below), most - _LEAST, _LEAST))
    if asked and len(_drawn(markdown, width)) > most_of_text:
        markdown = _from_sentence(markdown, width * most_of_text, asked)
    lines = [*_shortened(markdown, width, most_of_text)]
    items = [line for item in one.below for line in _item_lines(item, width)]
    lines += items if len(items) <= (room := most - len(lines)) else _first_of(items, room)
    return lines + [[(line, CODE)] for line in _lines_of_code(code, most - len(lines), asked)]


def _first_of(lines: list[Line], most: int) -> list[Line]:
    """Return the first of more lines, with an ellipsis below them where it is not all that has room."""
    return [*lines[: most - 1], [(_ELLIPSIS.strip(), PLAIN)]] if most > 1 else lines[:most]


def _lines_of_code(code: list[str], most: int, asked: re.Pattern[str] | None) -> list[str]:
    """Return the lines that have most words of a question, with an ellipsis below them if there are more."""
    if len(code) <= most or most < _LEAST:
        return code[:most]
    first = _line_with_most(code, most - 1, asked) if asked else 0
    shown = code[first : first + most - 1]
    return [*shown, _ELLIPSIS.strip()] if first + len(shown) < len(code) else code[-most:]


def _wrapped(line: str, width: int) -> list[str]:
    """Return a line of code as lines of at most a number of columns; none if it is empty."""
    further = " " * (len(line) - len(line.lstrip()) + 4)
    return wrap(_NOTE.sub("  #", line), width, subsequent_indent=further, replace_whitespace=False)


def _shortened(markdown: str, width: int, most: int) -> list[Line]:
    """Return the first lines, with an ellipsis at their end if there are more."""
    lines = _drawn(markdown, width)
    if len(lines) <= most:
        return lines
    *above, last = _drawn(markdown, width - len(_ELLIPSIS))[:most]
    return [*above, [*last, (_ELLIPSIS, PLAIN)]]


@lru_cache(_KEPT)
def _drawn(markdown: str, width: int) -> list[Line]:
    """Return Markdown as lines, which nobody changes: answers are drawn again until they fit."""
    return markdown_lines(markdown, width)


def _item_lines(item: str, width: int) -> list[Line]:
    """Return an item of a list, or a row of a table, as lines."""
    lines = _drawn(_as_sentences(item), width - len(_BULLET))
    return [
        [(" " * len(_BULLET) if row else _BULLET, PLAIN), *line] for row, line in enumerate(lines)
    ]


def _from_sentence(text: str, letters: int, asked: re.Pattern[str]) -> str:
    """Return a text from the sentence on from which a number of letters has most words of a question."""
    starts = [0, *(found.end() for found in _SENTENCE_END.finditer(text))]
    start = max(starts, key=lambda at: (_words_in(text[at : at + letters], asked), -at))
    return f"… {text[start:]}" if start else text


def _line_with_most(lines: Sequence[str], count: int, asked: re.Pattern[str]) -> int:
    """Return the line from which on a number of lines has most words of a question."""
    starts = range(max(1, len(lines) - count + 1))
    return max(starts, key=lambda at: (_words_in("\n".join(lines[at : at + count]), asked), -at))


def _words_in(text: str, asked: re.Pattern[str]) -> int:
    return len({word[:_TOLD_BY].lower() for word in asked.findall(text)})


def _with_head(passage: str, head: str) -> str:
    """Return a row of a table of more than two columns with the heads of its columns, but for the first."""
    cells, heads = cells_of(passage), cells_of(head)
    if not head or len(cells) <= _CLEAR_COLUMNS or len(heads) != len(cells):
        return passage
    said = [
        (name, cell)
        for name, cell in zip(heads[1:], cells[1:], strict=True)
        if cell and name not in _FOR_SCRIPTS
    ]
    named = (
        [f"{name}: {cell}" for name, cell in said] if len(said) > 1 else [cell for _, cell in said]
    )
    return "| " + " | ".join([cells[0], *named]) + " |"


def passage_text(markdown: str) -> str:
    """Return a passage of a page as one line of plain text."""
    return " ".join(plain_text(_as_sentences(markdown)).split())


def _as_sentences(markdown: str) -> str:
    """Return a passage of a page without the mark of an item, the cells of a row and the targets of links."""
    text = " · ".join(filter(None, cells_of(_MARK.sub("", markdown))))
    # In one line: a number at the beginning of a line would begin a list.
    return " ".join(LINK.sub(lambda link: link[1], text).split())


def cells_of(markdown: str) -> list[str]:
    """Return the cells of a passage that is a row of a table, else the passage."""
    return (
        [cell.strip() for cell in markdown.strip("|").split(" | ")]
        if markdown.startswith("|")
        else [markdown]
    )
