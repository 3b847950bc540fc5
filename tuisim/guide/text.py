"""Pages as text for a terminal."""

from __future__ import annotations

import re
from itertools import accumulate

from rich.style import Style

from tuisim.guide.catalogue import CONTENTS, LINK, Page, pages
from tuisim.guide.excerpt import cells_of, excerpt_of, passage_text
from tuisim.guide.search import SearchResult
from tuisim.guide.tables import markdown_of
from tuisim.tasks.lessons.markdown import PLAIN, markdown_lines
from tuisim.terminal.text_runs import Line

_HEADING = re.compile(r"^## (.+)$", re.MULTILINE)
_LETTERS = re.compile(r"[\W_]+")
_MANY_LETTERS, _FEW_LETTERS = (40, 20), (10, 5)
"""How many letters tell where a passage begins, those that tell it best first."""
_PASSAGE_LINES = 2
"""How much of a passage is shown among results."""
NO_WORDS = "No page has these words"


def linked_names(page: Page) -> list[str]:
    """Return the names of the pages that a page links to, in their order."""
    return list(dict.fromkeys(found[2] for found in LINK.finditer(page.source)))


def headings_in(page: Page) -> list[str]:
    """Return the headings of the sections of a page, as they are shown."""
    return [heading.replace("`", "") for heading in _HEADING.findall(page.source)]


def page_lines(page: Page, width: int) -> list[Line]:
    """Return a page as lines of at most a number of columns; a link shows the name of its page."""
    return markdown_lines(LINK.sub(_named, markdown_of(page)), width)


def _named(link: re.Match[str]) -> str:
    text, name = link[1], link[2]
    plain = text.replace("`", "").lower().replace(" ", "-")
    return f"**{text}**" if plain == name else f"**{text}** (page `{name}`)"


def contents_lines(width: int) -> list[Line]:
    """Return the contents: the pages by part."""
    text = [
        "# The guide",
        "`tuisim guide TOPIC` shows a page, `tuisim guide --search WORDS` finds one.",
    ]
    for part, names in CONTENTS.items():
        text += [f"## {part}", "\n".join(f"- `{name}` {pages()[name].title}" for name in names)]
    return markdown_lines("\n\n".join(text), width)


def result_lines(found: list[SearchResult], width: int) -> list[Line]:
    """Return what a search has found, the best passage first, each below its page and section."""
    lines = []
    for one in found:
        title = f"- `{one.name}` **{pages()[one.name].title}**{f': {one.heading}' if one.heading else ''}"
        passage = excerpt_of(one, max(20, width - 3), _PASSAGE_LINES)
        lines += [*markdown_lines(title, width), *([("   ", PLAIN), *line] for line in passage)]
    return lines


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
    wanted = [
        _LETTERS.sub("", text) for text in (passage_text(passage), max(cells_of(passage), key=len))
    ]
    tried = [wanted[0][:count] for count in _MANY_LETTERS]
    tried += [
        text[:count] for text in wanted[::-1] for count in (*_MANY_LETTERS[1:], *_FEW_LETTERS)
    ]
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
        return (
            Style(bold=bold, italic=style.italic, underline=style.underline).render(text)
            if styled
            else text
        )

    return "\n".join("".join(one(*run) for run in line) for line in lines) + "\n"
