"""What a search of the guide has found: passages that answer, one below the other."""

from __future__ import annotations

from collections.abc import Sequence

from rich.style import Style
from rich.text import Text
from textual.widgets import OptionList
from textual.widgets.option_list import Option

from tuisim import palette
from tuisim.guide.catalogue import pages
from tuisim.guide.search import SearchResult
from tuisim.guide.text import beginning

_FIRST_LINES, _LINES = 6, 3
"""Lines of the best answer, and of each other."""
_EDGES = 3
"""Columns beside the text: a space at each side, and the scroll bar."""
_LEAST_COLUMNS = 20
_SECTION, _PAGE, _TEXT = Style(bold=True, color=palette.BLUE), Style(color=palette.SOFT), Style(color=palette.INK)


class Answers(OptionList):
    """The answers, the best one first, as many as the window shows; the others below."""

    def __init__(self) -> None:
        super().__init__(id="answers")
        self._found: Sequence[SearchResult] = ()

    def show(self, found: Sequence[SearchResult], width: int) -> None:
        """Show other answers, the first one highlighted.

        Args:
            found: The best one first.
            width: Columns of the list.
        """
        self._found = found
        self.fit(width)
        self.highlighted = 0 if found else None
        self.scroll_home(animate=False)

    def fit(self, width: int) -> None:
        """Draw the answers for a number of columns."""
        columns, at = max(width - _EDGES, _LEAST_COLUMNS), self.highlighted
        self.clear_options()
        self.add_options(
            Option(_text_of(one, columns, _LINES if row else _FIRST_LINES)) for row, one in enumerate(self._found)
        )
        self.highlighted = at if at is not None and at < len(self._found) else None

    @property
    def chosen(self) -> SearchResult | None:
        """The highlighted answer; None without answers."""
        return self._found[self.highlighted] if self.highlighted is not None else None


def _text_of(one: SearchResult, columns: int, most: int) -> Text:
    """Return an answer below the names of its section and page."""
    title = pages()[one.name].title
    names = Text.assemble((one.heading, _SECTION), (f" · {title}", _PAGE)) if one.heading else Text(title, _SECTION)
    names.truncate(columns, overflow="ellipsis")
    return Text("\n", no_wrap=True).join([names, *(Text(line, _TEXT) for line in beginning(one, columns, most))])
