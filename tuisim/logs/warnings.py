"""What was wrong with a file: counted by kind, with the first rows where it was."""

from __future__ import annotations

from collections.abc import Iterable

ROWS_NAMED = 3
"""Rows that a note names; more are only counted."""


class Notes:
    """Collects what was left out or read with a guess."""

    def __init__(self) -> None:
        self._rows: dict[str, list[int]] = {}
        self._counts: dict[str, int] = {}
        self._said: dict[str, None] = {}

    def say(self, text: str) -> None:
        """Note something about the whole file, once."""
        self._said[text] = None

    def add(self, text: str, rows: Iterable[int], count: int | None = None) -> None:
        """Note something that is wrong in some rows.

        Args:
            text: What, such as `cells that are no number`.
            rows: Rows of the file, from 1; the first few are enough if `count` is given.
            count: How many times.
        """
        found = list(rows)
        self._counts[text] = self._counts.get(text, 0) + (len(found) if count is None else count)
        named = self._rows.setdefault(text, [])
        named += found[: ROWS_NAMED - len(named)]

    @property
    def left_out(self) -> int:
        """How many rows or cells could not be read as they are."""
        return sum(self._counts.values())

    def texts(self) -> tuple[str, ...]:
        """Return one sentence each."""
        counted = []
        for text, count in self._counts.items():
            rows = self._rows[text]
            where = f" ({'row' if len(rows) == 1 == count else 'rows'} {', '.join(map(str, rows))}" if rows else ""
            where += f"{', …' if count > len(rows) else ''})" if rows else ""
            counted.append(f"{count} {text}{where}")
        return (*self._said, *counted)
