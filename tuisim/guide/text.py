"""Pages as text for a terminal."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import accumulate
from textwrap import dedent, wrap

from rich.style import Style

from tuisim.guide.catalogue import CONTENTS, Page, pages
from tuisim.guide.search import SearchResult
from tuisim.guide.tables import markdown_of
from tuisim.lessons.markdown import PLAIN, markdown_lines, plain_text
from tuisim.terminal.text_runs import Line, cut

_LINK = re.compile(r"\[([^\[\]]+)\]\(([\w-]+)\.md\)")
_HEADING = re.compile(r"^## (.+)$", re.MULTILINE)
_LETTERS = re.compile(r"[\W_]+")
_MANY_LETTERS, _FEW_LETTERS = (40, 20), (10, 5)
"""How many letters tell where a passage begins, those that tell it best first."""
_CLEAR_COLUMNS = 2
"""Rows of a table with so many columns need no heads."""
_CODE_BELOW = re.compile(r"(?<=:)\n\s*\n|\n\s*\n(?=    )")
"""Before the code that belongs to a passage."""
_CODE = "    "
"""Begins each line of code in a passage."""
_NOTE = re.compile(r" {2,}#")
"""Before a comment beside code, in a column with others."""
_SENTENCE_END = re.compile(r"(?<=[.:!?]) (?=[\w`*])")
_TOLD_BY = 4
"""Letters that tell one word of a question from another."""
_FOR_SCRIPTS = ("group", "id")
"""Columns of the keys that say nothing to a reader of one of them."""
_LEAST = 3
"""Lines that make sense by themselves, of a text as of code."""
_PASSAGE_LINES = 2
"""How much of a passage is shown among results."""
NO_WORDS = "No page has these words"


def linked_names(page: Page) -> list[str]:
    """Return the names of the pages that a page links to, in their order."""
    return list(dict.fromkeys(found[2] for found in _LINK.finditer(page.source)))


def headings_in(page: Page) -> list[str]:
    """Return the headings of the sections of a page, as they are shown."""
    return [heading.replace("`", "") for heading in _HEADING.findall(page.source)]


def page_lines(page: Page, width: int) -> list[Line]:
    """Return a page as lines of at most a number of columns; a link shows the name of its page."""
    return markdown_lines(_LINK.sub(_named, markdown_of(page)), width)


def _named(link: re.Match[str]) -> str:
    text, name = link[1], link[2]
    plain = text.replace("`", "").lower().replace(" ", "-")
    return f"**{text}**" if plain == name else f"**{text}** (page `{name}`)"


def contents_lines(width: int) -> list[Line]:
    """Return the contents: the pages by part."""
    text = ["# The guide", "`tuisim guide TOPIC` shows a page, `tuisim guide --search WORDS` finds one."]
    for part, names in CONTENTS.items():
        text += [f"## {part}", "\n".join(f"- `{name}` {pages()[name].title}" for name in names)]
    return markdown_lines("\n\n".join(text), width)


def result_lines(found: list[SearchResult], width: int) -> list[Line]:
    """Return what a search has found, the best passage first, each below its page and section."""
    lines = []
    for one in found:
        title = f"- `{one.name}` **{pages()[one.name].title}**{f': {one.heading}' if one.heading else ''}"
        passage = beginning(one, max(20, width - 3), _PASSAGE_LINES)
        lines += [*markdown_lines(title, width), *([("   " + line, PLAIN)] for line in passage)]
    return lines


def beginning(one: SearchResult, width: int, most: int, asked: re.Pattern[str] | None = None) -> list[str]:
    """Return the beginning of a passage that was found, in lines of plain text.

    Args:
        one: What was found.
        width: Columns.
        most: So many lines at most; what is left out is an ellipsis.
        asked: Finds the words of the question. A longer passage begins where most of them follow: at a sentence,
            and its code at a line.
    """
    words, *code = ("", one.passage) if one.passage.startswith(_CODE) else _CODE_BELOW.split(one.passage)
    below = [line for line in dedent("\n".join(code)).split("\n") if line.strip()]
    below += [f"• {passage_text(item)}" for item in one.below]
    text = passage_text(_with_head(words, one.head))
    most_of_text = min(most, max(most - len(below), most - _LEAST, _LEAST))
    if asked and len(wrap(text, width)) > most_of_text:
        text = _from_sentence(text, width * most_of_text, asked)
    lines = wrap(text, width, max_lines=most_of_text, placeholder=" …")
    room = most - len(lines)
    first = _line_with_most(below, room, asked) if asked and room >= _LEAST else 0
    return lines + [cut(_NOTE.sub("  #", line), width) for line in below[first : first + room]]


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
    said = [(name, cell) for name, cell in zip(heads[1:], cells[1:], strict=True) if cell and name not in _FOR_SCRIPTS]
    named = [f"{name}: {cell}" for name, cell in said] if len(said) > 1 else [cell for _, cell in said]
    return "| " + " | ".join([cells[0], *named]) + " |"


def passage_text(markdown: str) -> str:
    """Return a passage of a page as one line of plain text."""
    text = _LINK.sub(lambda link: link[1], " · ".join(filter(None, cells_of(markdown))))
    return " ".join(plain_text(text).removeprefix(" •").split())


def cells_of(markdown: str) -> list[str]:
    """Return the cells of a passage that is a row of a table, else the passage."""
    return [cell.strip() for cell in markdown.strip("|").split(" | ")] if markdown.startswith("|") else [markdown]


def rows_of(lines: list[Line], heading: str, passage: str) -> tuple[int, int]:
    """Return the rows at which a section of a drawn page and a passage of it begin; that of the section for both.

    Args:
        lines: The page.
        heading: As it is shown; empty for the beginning of the page.
        passage: In Markdown; empty for none.
    """
    texts = ["".join(part for part, _ in line) for line in lines]
    top = next((row for row, text in enumerate(texts) if heading and text.strip() == heading), 0)
    # Lines break elsewhere than in the source, and a table puts cells side by side or names each.
    letters = [_LETTERS.sub("", text) for text in texts[top:]]
    wanted = [_LETTERS.sub("", text) for text in (passage_text(passage), max(cells_of(passage), key=len))]
    tried = [wanted[0][:count] for count in _MANY_LETTERS]
    tried += [text[:count] for text in wanted[::-1] for count in (*_MANY_LETTERS[1:], *_FEW_LETTERS)]
    starts = ("".join(letters).find(text) for text in tried if text)
    at = next((start for start in starts if start >= 0), 0)
    ends = accumulate(map(len, letters))
    row = top + next((row for row, end in enumerate(ends) if end > at), 0)
    while passage.startswith("|") and row > top and texts[row].startswith("  "):
        row -= 1  # the row's first cell
    return top, row


def end_of_passage(lines: list[Line], row: int, passage: str) -> int:
    """Return the row below a passage of a drawn page that begins at a row."""
    left = len(_LETTERS.sub("", passage_text(passage)))
    while left > 0 and row < len(lines):
        left -= len(_LETTERS.sub("", "".join(part for part, _ in lines[row])))
        row += 1
    return row


def written(lines: list[Line], *, styled: bool) -> str:
    """Return lines as one text, with the control sequences of a terminal."""

    def one(text: str, style: Style) -> str:
        # No colours: the terminal may have any background.
        bold = style.bold or style.color != PLAIN.color
        return Style(bold=bold, italic=style.italic, underline=style.underline).render(text) if styled else text

    return "\n".join("".join(one(*run) for run in line) for line in lines) + "\n"
