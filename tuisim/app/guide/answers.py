"""What a search of the guide has found: passages that answer, one below the other."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from rich.style import Style
from rich.text import Text
from textual.geometry import Size
from textual.widgets import OptionList
from textual.widgets.option_list import Option

from tuisim.base import palette
from tuisim.guide.catalogue import load_pages
from tuisim.guide.excerpt import draw_excerpt
from tuisim.guide.search import SearchResult, compile_pattern

_FIRST_LINES = 11
_LINES = ((9, 1), (6, 1), (3, 1), (3, 0))
"""Maximum lines of an answer after the first, and lines of the gap below it; the first pair with which all answers fit
is used, else the last."""
_EDGES = 3
"""Columns beside the text: a space at each side, and the scroll bar."""
_MIN_COLUMNS = 20
_ITEM = "• "
STANDS_OUT = Style(bold=True, color=palette.WHITE)
"""Style of the words of the user's question where they occur in an answer."""
_SECTION, _PAGE, _TEXT = (
    Style(bold=True, color=palette.BLUE),
    Style(color=palette.SOFT),
    Style(color=palette.INK),
)


class AnswerList(OptionList):
    """The list of answers of a search; the first answer, which is the best, has the most lines.

    Each other answer has as many lines as fit while all answers stay visible.
    """

    def __init__(self) -> None:
        super().__init__(id="answers")
        self._found: Sequence[SearchResult] = ()
        self._asked: re.Pattern[str] | None = None

    def show(self, question: str, results: Sequence[SearchResult], size: Size) -> None:
        """Show the answers to another question, and highlight the first answer.

        Args:
            question: The user's question; its words stand out.
            results: The results of the search, the best first.
            size: Columns and rows of the list.
        """
        self._found, self._asked = results, compile_pattern(question)
        self.fit(size)
        self.highlighted = 0 if results else None
        self.scroll_home(animate=False)

    def fit(self, size: Size) -> None:
        """Draw the answers again, because the list has another size; each answer gets as many lines as fit.

        Args:
            size: Columns and rows of the list.
        """
        columns = max(size.width - _EDGES, _MIN_COLUMNS)
        index = self.highlighted
        for lines, gap in _LINES:
            drawn = list(self._draw_answers(columns, lines, gap))
            if sum(len(text.plain.split("\n")) for text in drawn) <= size.height + gap:
                break
        self.clear_options()
        self.add_options(Option(text) for text in drawn)
        self.highlighted = index if index is not None and index < len(self._found) else None

    def _draw_answers(self, columns: int, lines: int, gap: int) -> Iterator[Text]:
        """Yield each answer as a text with `gap` empty rows below it.

        Args:
            columns: Width of the list.
            lines: The largest number of lines of an answer after the first.
            gap: Number of empty rows; they are below the text, so that the highlight of an answer begins with its text.
        """
        above = ("", "")
        for row, answer in enumerate(self._found):
            section = answer.name, answer.heading
            text = _build_passage(answer, columns, lines if row else _FIRST_LINES, self._asked)
            if self._asked:
                text.highlight_regex(self._asked, STANDS_OUT)
            # Consecutive answers of one section share the heading above the first.
            item = text if section == above else _build_heading(answer, columns).append_text(text)
            yield item.append("\n" * gap)
            above = section

    @property
    def chosen(self) -> SearchResult | None:
        """The answer that is highlighted; None without answers."""
        return self._found[self.highlighted] if self.highlighted is not None else None


def name_answer(answer: SearchResult) -> tuple[str, str]:
    """Return the names of an answer's section and page; the second is empty for the beginning of a page."""
    title = load_pages()[answer.name].title
    return (answer.heading, title) if answer.heading else (title, "")


def _build_heading(answer: SearchResult, columns: int) -> Text:
    section, page = name_answer(answer)
    names = Text.assemble((section, _SECTION), (f" · {page}" if page else "", _PAGE), no_wrap=True)
    names.truncate(columns, overflow="ellipsis")
    return names.append("\n")


def _build_passage(
    answer: SearchResult, columns: int, max_rows: int, search: re.Pattern[str] | None
) -> Text:
    """Return the excerpt that the list shows of an answer, in at most `max_rows` rows."""
    lines = [
        Text.assemble(*line)
        for line in draw_excerpt(answer, columns - len(_ITEM), max_rows, search)
    ]
    return Text(_ITEM, _TEXT, no_wrap=True).append_text(Text(f"\n{' ' * len(_ITEM)}").join(lines))
