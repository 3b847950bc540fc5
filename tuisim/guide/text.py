"""Pages as text for a terminal."""

from __future__ import annotations

import re
from itertools import accumulate

from tuisim.guide.catalogue import LINK, Page
from tuisim.guide.excerpt import flatten_passage, split_cells
from tuisim.guide.markdown import render_markdown
from tuisim.guide.tables import build_markdown
from tuisim.terminal.text_runs import Line

_LETTERS = re.compile(r"[\W_]+")
_LONG_PREFIXES, _SHORT_PREFIXES = (40, 20), (10, 5)
"""Numbers of first letters by which the beginning of a passage is looked for, the most reliable number first."""
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
    plain_texts = [
        _LETTERS.sub("", text)
        for text in (flatten_passage(passage), max(split_cells(passage), key=len))
    ]
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
    while passage.startswith("|") and row > top and texts[row].startswith("  "):
        row -= 1  # go up to the first cell of the table's row
    return top, row


def find_passage_end(lines: list[Line], row: int, passage: str) -> int:
    """Return the row below a passage of a drawn page.

    Args:
        lines: The lines of the page.
        row: The row at which the passage begins.
        passage: The passage in Markdown.
    """
    left = len(_LETTERS.sub("", flatten_passage(passage)))
    while left > 0 and row < len(lines):
        left -= len(_LETTERS.sub("", "".join(part for part, _ in lines[row])))
        row += 1
    return row
