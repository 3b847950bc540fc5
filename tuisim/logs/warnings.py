"""Warnings about a file: counted by kind, with the first rows concerned."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.base.errors import counted, shortened
from tuisim.logs.choices import NO_CHOICES

ROWS_NAMED = 3
"""Rows that a warning names; more are only counted."""
MAX_WARNINGS = 8
"""Warnings about a whole file that are listed; more are only counted."""
MAX_CHARACTERS = 200
"""Length of a warning; a longer one, which quotes something of the file, is cut."""


def list_rows(rows: Sequence[int], noun: str = "row") -> str:
    """Return rows in words: the numbers of the first few, then `…` if there are more."""
    more = ", …" if len(rows) > ROWS_NAMED else ""
    numbers = ", ".join(map(str, rows[:ROWS_NAMED]))
    return f"{noun if len(rows) == 1 else f'{noun}s'} {numbers}{more}"


class Notes:
    """Collects warnings about data of a file that were skipped or guessed."""

    def __init__(self) -> None:
        self.form = NO_CHOICES
        """How a text is read: what was chosen, else what was found."""
        self.first_lines: Sequence[tuple[int, str]] = ()
        """The first lines of a text that are not blank, each with its number."""
        self.noun = "line"
        """What the numbers of rows count: lines of a text, else rows of a table."""
        self._rows: dict[tuple[str, str], list[int]] = {}
        self._counts: dict[tuple[str, str], int] = {}
        self._general: dict[str, None] = {}

    def say(self, text: str) -> None:
        """Add a warning about the whole file, unless it was added before."""
        self._general[text] = None

    def add(self, singular: str, plural: str, rows: Sequence[int]) -> None:
        """Add a warning about some rows that could not be read; if `rows` is empty, nothing is added.

        Args:
            singular: The problem, such as `cell is not a number`.
            plural: The same problem of several cells, such as `cells are not numbers`.
            rows: Rows of the file, from 1.
        """
        if rows:
            text = (singular, plural)
            self._counts[text] = self._counts.get(text, 0) + len(rows)
            named = self._rows.setdefault(text, [])
            # One row more than is named is stored: it shows that there are more rows.
            named += rows[: ROWS_NAMED + 1 - len(named)]

    def say_rows(self, text: str, rows: Sequence[int]) -> None:
        """Add a warning about rows that were read nevertheless; if `rows` is empty, nothing is added."""
        if rows:
            self.say(f"{text} ({list_rows(rows, self.noun)})")

    @property
    def left_out(self) -> int:
        """The number of rows or cells that could not be read."""
        return sum(self._counts.values())

    def texts(self) -> tuple[str, ...]:
        """Return the warnings as sentences."""
        texts = [
            f"{counted(count, *text)} ({list_rows(self._rows[text], self.noun)})"
            for text, count in self._counts.items()
        ]
        sentences = [shortened(text, MAX_CHARACTERS) for text in self._general]
        more = len(sentences) - MAX_WARNINGS
        return (
            *sentences[:MAX_WARNINGS],
            *([counted(more, "more warning")] if more > 0 else []),
            *texts,
        )
