"""The output of a run by tick: what had been printed at any moment, found without reading it all again."""

from __future__ import annotations

from array import array
from bisect import bisect_right
from collections.abc import Iterator
from itertools import islice
from typing import TYPE_CHECKING

from tuisim.datalog.records import CONSOLE, DISPLAY, LED, MOTORS, SPEECH, STDERR, STDOUT, TEXT_STREAMS, OutputRow
from tuisim.datalog.samples import parse_sample

if TYPE_CHECKING:
    from tuisim.datalog.views import OutputView

SAMPLE, ERROR = "sample", "error"
"""What is marked of the output: a sample that reached another level, an error text."""

_FACE_STREAMS = (LED, DISPLAY, CONSOLE, MOTORS, SPEECH)
_LEVEL_SHARE = 0.15
"""A sample that has gone so much of its variable's range is on another level."""

_FINEST = 500
"""Changes closer than this share of the time so far are one mark, so that marks stay few."""


class _Level:
    """The level of one variable, to tell when it reaches another."""

    def __init__(self, value: float) -> None:
        self._low = self._high = self._level = value

    def changes(self, value: float) -> bool:
        """Take in a value; whether it is on another level than the last one that was."""
        self._low, self._high = min(self._low, value), max(self._high, value)
        if abs(value - self._level) <= _LEVEL_SHARE * (self._high - self._low):
            return False
        self._level = value
        return True


class RowIndex:
    """Tick and place of each row that has been read.

    Args:
        output: Where the rows are; it may still grow.
    """

    def __init__(self, output: OutputView) -> None:
        self._output = output
        self._end = 0
        self._ticks, self._lines, self._starts = array("I"), array("I"), array("Q")
        self._texts: array[int] = array("I")
        """Numbers of the rows that are lines for people."""
        self._faces: dict[int, array[int]] = {stream: array("I") for stream in _FACE_STREAMS}
        self._levels: dict[str, _Level] = {}
        self._last_change = -1
        """Tick of the last changed sample that was marked."""
        self.marks: list[tuple[int, str]] = []
        """Ticks of changed samples and of errors, in order."""

    def __len__(self) -> int:
        return len(self._ticks)

    def take(self, limit: int) -> list[OutputRow]:
        """Read on, at most `limit` rows, and return them.

        Raises:
            LogError: the recording is damaged.
        """
        rows = []
        for row, after in islice(self._output.rows_from(self._end), limit):
            self._note(row)
            self._end = after
            rows.append(row)
        return rows

    def _note(self, row: OutputRow) -> None:
        number = len(self._ticks)
        self._ticks.append(row.tick)
        self._lines.append(row.line)
        self._starts.append(self._end)
        if row.stream in TEXT_STREAMS:
            self._texts.append(number)
        if row.stream in self._faces:
            self._faces[row.stream].append(number)
        if row.stream == STDERR:
            if not self.marks or self.marks[-1] != (row.tick, ERROR):
                self.marks.append((row.tick, ERROR))
        elif row.stream == STDOUT and (sample := parse_sample(row.text)):
            level = self._levels.get(sample[0])
            if level is None:
                self._levels[sample[0]] = _Level(sample[1])
            elif level.changes(sample[1]) and row.tick - self._last_change > row.tick // _FINEST:
                self._last_change = row.tick
                self.marks.append((row.tick, SAMPLE))

    def until(self, tick: int) -> int:
        """Return how many rows there were when a tick was done."""
        return bisect_right(self._ticks, tick)

    def texts_until(self, tick: int, most: int) -> tuple[list[OutputRow], int]:
        """Return the last lines for people that there were when a tick was done, and how many there were before."""
        end = bisect_right(self._texts, self.until(tick) - 1)
        first = max(0, end - most)
        return [self.row(number) for number in self._texts[first:end]], first

    def face_numbers(self, tick: int) -> list[int]:
        """Return the numbers of the rows that say all of what the brick showed when a tick was done, in order."""
        count = self.until(tick)
        return sorted(numbers[at - 1] for numbers in self._faces.values() if (at := bisect_right(numbers, count - 1)))

    def row(self, number: int) -> OutputRow:
        """Return one row by its number, from 0."""
        return next(self._output.rows_from(self._starts[number]))[0]

    def rows(self, first: int, step: int = 1) -> Iterator[OutputRow]:
        """Yield the rows from a number on, or those up to it, backwards, with a step of -1."""
        if step < 0:
            yield from (self.row(number) for number in range(first, -1, -1))
        elif first < len(self):
            rows = self._output.rows_from(self._starts[first])
            yield from (row for row, _ in islice(rows, len(self) - first))

    def ticks_of_line(self, line: int) -> list[int]:
        """Return the ticks at which a line of the program printed."""
        return [tick for tick, number in zip(self._ticks, self._lines, strict=True) if number == line]
