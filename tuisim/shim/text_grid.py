"""A character grid that interprets the control codes which the library writes."""

from __future__ import annotations

import re

from tuisim.runs.brick_state import TextScreen

BLANK = (" ", False)
"""A cell: character, and whether it is in reverse video."""

_PARTS = re.compile(r"\x1b\[\??([-\d;]*)([A-Za-z])|([^\x1b])|\x1b", re.DOTALL)


class TextGrid:
    """The subset of the Linux console that the library uses.

    Args:
        columns: Characters per row.
        rows: Number of rows.
    """

    def __init__(self, columns: int, rows: int) -> None:
        self.columns, self.rows = columns, rows
        self._cells = [[BLANK] * columns for _ in range(rows)]
        self._column = self._row = 0
        """Cursor position from 0; one column beyond the last until the next character wraps."""
        self._inverse = False

    def resize(self, columns: int, rows: int) -> None:
        """Change the size; content that still fits is kept."""
        self.columns, self.rows = columns, rows
        wide = [(row + [BLANK] * columns)[:columns] for row in self._cells[:rows]]
        self._cells = wide + [[BLANK] * columns for _ in range(rows - len(wide))]
        self._move(self._column, self._row)

    def write(self, text: str) -> None:
        """Write characters and interpret control codes; unknown codes are ignored."""
        for part in _PARTS.finditer(text):
            numbers, code, letter = part.groups()
            if code:
                self._obey(code, [int(number) if number.lstrip("-").isdigit() else 0 for number in numbers.split(";")])
            elif letter:
                self._put(letter)

    def screen(self) -> TextScreen:
        """Return the visible text."""
        spans = []
        for number, row in enumerate(self._cells):
            start = None
            for column in range(self.columns + 1):
                inverse = column < self.columns and row[column][1]
                if inverse and start is None:
                    start = column
                elif not inverse and start is not None:
                    spans.append((number, start, column))
                    start = None
        lines = tuple("".join(letter for letter, _ in row).rstrip() for row in self._cells)
        return TextScreen(self.columns, self.rows, lines, tuple(spans))

    def _obey(self, code: str, numbers: list[int]) -> None:
        first = numbers[0]
        match code:
            case "H":
                # Positions below 1 count as 1.
                column = numbers[1] if len(numbers) > 1 else 1
                self._move(column - 1, first - 1)
            case "J" if first == 2:
                self._cells = [[BLANK] * self.columns for _ in range(self.rows)]
            case "K" if first == 0:
                row = self._cells[self._row]
                row[self._column :] = [BLANK] * (self.columns - self._column)
            case "m":
                self._inverse = first == 7

    def _move(self, column: int, row: int) -> None:
        self._column = min(max(column, 0), self.columns - 1)
        self._row = min(max(row, 0), self.rows - 1)

    def _put(self, letter: str) -> None:
        match letter:
            case "\n":
                self._new_line()
            case "\r":
                self._column = 0
            case "\b":
                self._column = max(self._column - 1, 0)
            case "\t":
                self._column = min(self._column // 8 * 8 + 8, self.columns - 1)
            case _ if letter.isprintable():
                if self._column >= self.columns:
                    self._new_line()
                self._cells[self._row][self._column] = (letter, self._inverse)
                self._column += 1

    def _new_line(self) -> None:
        self._column = 0
        if self._row < self.rows - 1:
            self._row += 1
        else:
            self._cells = [*self._cells[1:], [BLANK] * self.columns]
