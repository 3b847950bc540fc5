"""Pages as text for a terminal."""

from __future__ import annotations

import re
from collections import Counter
from functools import lru_cache
from itertools import accumulate

from tuisim.guide.catalogue import LINK, Page
from tuisim.guide.excerpt import flatten_passage, split_cells
from tuisim.guide.markdown import render_markdown
from tuisim.guide.tables import build_markdown
from tuisim.terminal.text_runs import Line

_LETTERS = re.compile(r"[\W_]+")
_LONG_PREFIXES, _SHORT_PREFIXES = (40, 20), (10, 5)
"""How many of a passage's first letters are looked for on a drawn page to find the passage there; the most reliable
number comes first.
"""
NO_WORDS = "No page has these words"


def draw_page(page: Page, width: int) -> list[Line]:
    """Return a page as lines of at most `width` columns; a link shows the name of its page."""
    return render_markdown(LINK.sub(_format_link, build_markdown(page)), width)


def _format_link(link: re.Match[str]) -> str:
    text = link[1]
    name = link[2]
    plain = text.replace("`", "").lower().replace(" ", "-")
    return f"**{text}**" if plain == name else f"**{text}** (page `{name}`)"


def find_rows(lines: list[Line], heading: str, passage: str) -> tuple[int, int]:
    """Return two rows of a drawn page: where a section begins, and where a passage in it begins.

    Without the passage, both are the row of the section.

    Args:
        lines: The lines of the page.
        heading: The section's heading as readers see it; empty for the beginning of the page.
        passage: The passage in Markdown; empty for none.
    """
    texts = ["".join(part for part, _ in line) for line in lines]
    top = next((row for row, text in enumerate(texts) if heading and text.strip() == heading), 0)
    # Only letters are compared, as drawn lines break at other places than the source, and tables are laid out.
    letters = [_LETTERS.sub("", text) for text in texts[top:]]
    plain_texts = [_read_letters(text) for text in (passage, max(split_cells(passage), key=len))]
    prefixes = [plain_texts[0][:count] for count in _LONG_PREFIXES]
    prefixes += [
        text[:count]
        for text in plain_texts[::-1]
        for count in (*_LONG_PREFIXES[1:], *_SHORT_PREFIXES)
    ]
    starts = ("".join(letters).find(text) for text in prefixes if text)
    offset = next((start for start in starts if start >= 0), 0)
    ends = accumulate(map(len, letters))
    row = top + next((row for row, end in enumerate(ends) if end > offset), 0)
    return top, _find_table_row(lines, top, passage, row) if passage.startswith("|") else row


def _find_table_row(lines: list[Line], top: int, passage: str, default: int) -> int:
    """Return the row of a drawn page at which a row of a table begins.

    Cells are drawn beside each other, so their texts are mixed: of the rows that begin with the first word, the result
    is the one whose letters are most similar.

    Args:
        lines: The lines of the page.
        top: The first row that may be the result.
        passage: The row of the table in Markdown.
        default: The result if no row begins with the first word.
    """
    word = next(iter(flatten_passage(split_cells(passage)[0]).split()), "")
    letters = Counter(_read_letters(passage))

    def count_differences(row: int) -> int:
        drawn = Counter(_LETTERS.sub("", _join(lines[row : find_passage_end(lines, row, passage)])))
        return (letters - drawn).total() + (drawn - letters).total()

    rows = [
        row
        for row in range(top, len(lines))
        if _join(lines[row : row + 1]).removeprefix(" ").startswith(word)
    ]
    return min(rows, key=count_differences, default=default)


@lru_cache(8)
def _read_letters(passage: str) -> str:
    return _LETTERS.sub("", flatten_passage(LINK.sub(_format_link, passage)))


def _join(lines: list[Line]) -> str:
    return "".join(part for line in lines for part, _ in line)


def find_passage_end(lines: list[Line], row: int, passage: str) -> int:
    """Return the row below a passage of a drawn page.

    Args:
        lines: The lines of the page.
        row: The row at which the passage begins.
        passage: The passage in Markdown.
    """
    left = len(_read_letters(passage))
    while left > 0 and row < len(lines):
        left -= len(_LETTERS.sub("", _join(lines[row : row + 1])))
        row += 1
    # In a narrow table, each cell stands below the first one, after its heading.
    while passage.startswith("|") and _join(lines[row : row + 1]).startswith("  "):
        row += 1
    return row
