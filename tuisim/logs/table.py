"""The table of a log as rows of text: columns, order, filters. Only the rows that are shown are read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, among
from tuisim.engine.core.conditions import (
    COMPARE,
    Operator,
    ValueCondition,
    describe_comparison,
    parse_condition,
)
from tuisim.engine.runs.arrays import IntArray
from tuisim.logs.arrow import format_cell, match_condition, match_text, sort_places

if TYPE_CHECKING:
    from tuisim.logs.log import Log, LogTable

FAST_ROWS = 200_000
"""Number of rows that are processed within some hundredths of a second."""


@dataclass(slots=True)
class TableTask:
    """A background task of the table, such as a search, with its progress."""

    word: str
    part: float = 0.0
    """Fraction done, 0 to 1; 0 if unknown."""
    stopped: bool = False
    """Whether it has been cancelled."""

    def __str__(self) -> str:
        return f"{self.word} {self.part:.0%}" if self.part else self.word


FORM = f"{describe_comparison((*COMPARE, Operator.CONTAINS))} and NAME a column; several with `and`"
_STRETCH = 100_000
"""Rows that are searched at a time."""


@dataclass(frozen=True, slots=True)
class TableView:
    """The rows of a log that a table shows, and their order."""

    conditions: tuple[ValueCondition, ...] = ()
    fulfilled: IntArray | None = None
    """Rows that match the filter, increasing; None for all."""
    sorted_by: str = ""
    descending: bool = False
    order: IntArray | None = None
    """These rows in display order; None for all in the order of the log."""


class Rows:
    """The rows and columns of a log that the table shows, with the selected column, the order and the filters."""

    def __init__(self, log: Log) -> None:
        self._log = log
        self.columns: list[str] = list(log.table.column_names)
        """The visible columns, pinned ones first."""
        self.frozen = 0
        """Number of pinned columns at the left."""
        self.column = 0
        """Position of the chosen one in `columns`."""
        self.view = TableView()

    def __len__(self) -> int:
        return self._log.rows if self.view.order is None else len(self.view.order)

    @property
    def chosen(self) -> str:
        """The name of the column that is selected in the table."""
        return self.columns[self.column]

    def row(self, place: int) -> int:
        """Return the row of the log at a position of the table."""
        return place if self.view.order is None else int(self.view.order[place])

    def place(self, row: int) -> int:
        """Return the position of a row of the log in the table.

        For a hidden row, the result is the position of the next shown row, or 0 in a sorted table.
        """
        if self.view.order is None or not len(self.view.order):
            return row
        if self.view.sorted_by:
            places = np.flatnonzero(self.view.order == row)
            return int(places[0]) if len(places) else 0
        return min(int(np.searchsorted(self.view.order, row)), len(self.view.order) - 1)

    def text(self, row: int, column: str) -> str:
        """Return the text of a cell of the table."""
        return format_cell(self._log.table.column(column)[row])

    def shown(self, first: int = 0, last: int | None = None) -> LogTable:
        """Return the shown rows and columns as a table, with the rows from position `first` to before `last`."""
        table = self._log.table.select(self.columns)
        order = self.view.order
        return table[first:last] if order is None else table.take(order[first:last])

    # Which rows, in which order

    def parse_conditions(self, text: str) -> tuple[ValueCondition, ...]:
        """Return the conditions in a text such as `variable == Colour and value > 50`; none if it is empty.

        Raises:
            LogError: a part of the text is not a condition, or names a column that the log does not have.
        """
        columns = self._log.table.column_names
        conditions = []
        for part in re.split(r"\s+and\s+|\s*,\s*", text.strip()) if text else ():
            condition = parse_condition(part, name=r"[^<>=!~]+?", value=".*?")
            if condition is None:
                raise LogError(f"no condition: {part!r}", FORM)
            if condition.name not in columns:
                raise LogError(f"no column {condition.name!r}", among(condition.name, columns))
            conditions.append(replace(condition, value=condition.value.strip("'\"")))
        return tuple(conditions)

    def build_filtered_view(self, conditions: tuple[ValueCondition, ...]) -> TableView:
        """Return a view of the rows that meet all conditions, in the current order. This is slow for a long log.

        Raises:
            LogError: a value does not fit its column.
        """
        masks = [
            match_condition(self._log.table.column(condition.name), condition)
            for condition in conditions
        ]
        fulfilled = np.flatnonzero(np.logical_and.reduce(masks)) if masks else None
        return self._arrange(conditions, fulfilled, self.view.sorted_by, self.view.descending)

    def build_sorted_view(self, column: str, descending: bool) -> TableView:
        """Return a view of the same rows, sorted by a column.

        Without a column, the rows are in the order of the log. This is slow for a long log.
        """
        return self._arrange(self.view.conditions, self.view.fulfilled, column, descending)

    def _arrange(
        self,
        conditions: tuple[ValueCondition, ...],
        fulfilled: IntArray | None,
        sorted_by: str,
        descending: bool,
    ) -> TableView:
        order = fulfilled
        if sorted_by:
            column = self._log.table.column(sorted_by)
            places = sort_places(column if order is None else column.take(order), descending)
            order = places if order is None else order[places]
        return TableView(conditions, fulfilled, sorted_by, descending, order)

    # Which columns

    def choose(self, step: int) -> None:
        """Select another column, `step` columns to the right."""
        self.column = min(max(self.column + step, 0), len(self.columns) - 1)

    def hide(self) -> None:
        """Hide the selected column, unless it is the only one."""
        if len(self.columns) > 1:
            self.frozen -= self.column < self.frozen
            del self.columns[self.column]
            self.column = min(self.column, len(self.columns) - 1)

    def show_all(self) -> None:
        """Show every row and every column, in the order of the log."""
        self.view = TableView()
        self.columns = list(self._log.table.column_names)
        self.frozen = self.column = 0

    def freeze(self) -> None:
        """Pin the selected column at the left of the table; if it is pinned already, unpin it."""
        name = self.columns.pop(self.column)
        if self.column < self.frozen:
            self.frozen -= 1
            self.column = self.frozen
        else:
            self.column = self.frozen
            self.frozen += 1
        self.columns.insert(self.column, name)

    def set_log(self, log: Log) -> None:
        """Switch to the same log with other columns: new columns are shown.

        Conditions on removed columns are dropped.
        """
        before = self._log.table.column_names
        names = log.table.column_names
        chosen = self.chosen
        self._log = log
        self.frozen = sum(name in names for name in self.columns[: self.frozen])
        self.columns = [name for name in self.columns if name in names] or list(names)
        self.columns += [name for name in names if name not in before and name not in self.columns]
        self.column = self.columns.index(chosen) if chosen in self.columns else 0
        view = self.view
        sorted_by = view.sorted_by if view.sorted_by in names else ""
        conditions = tuple(condition for condition in view.conditions if condition.name in names)
        if (sorted_by, conditions) != (view.sorted_by, view.conditions):
            self.view = replace(view, sorted_by=sorted_by)
            self.view = self.build_filtered_view(conditions)

    def restore(self, other: Rows) -> None:
        """Show the columns and the rows that another table of the same log shows, in its order."""
        self.columns = other.columns
        self.frozen = other.frozen
        self.column = other.column
        self.view = replace(
            self.view, sorted_by=other.view.sorted_by, descending=other.view.descending
        )
        self.view = self.build_filtered_view(other.view.conditions)

    # Search

    def find(
        self, text: str, from_place: int, step: int, task: TableTask | None = None
    ) -> int | None:
        """Return the next position whose row contains a text in a shown column; None if no row does.

        Upper and lower case are the same. After the last position, the search goes on at the first. It is slow for a
        long log without a match.

        Args:
            text: The text.
            from_place: The search begins beside this position, and ends with it.
            step: 1 for forwards, -1 for backwards.
            task: Receives the progress, and can stop the search; None for no task.
        """
        seen = 0
        for first, last in _split_places(from_place, len(self), step):
            places = self._find_places(text, first, last)
            if len(places):
                return int(places[0] if step > 0 else places[-1])
            seen += last - first
            if task is not None:
                task.part = seen / len(self)
                if task.stopped:
                    return None
        return None

    def _find_places(self, text: str, first: int, last: int) -> IntArray:
        """Return the positions from `first` to before `last` whose rows contain a text."""
        matches = np.zeros(last - first, bool)
        for column in self.shown(first, last).columns:
            matches |= match_text(column, text)
        return first + np.flatnonzero(matches)


def _split_places(from_place: int, count: int, step: int) -> Iterator[tuple[int, int]]:
    """Yield all positions in ranges (first, one after the last), in the order in which a search visits them.

    Args:
        from_place: The position next to which the search begins; it is in the last range.
        count: The number of positions.
        step: 1 for forwards, -1 for backwards.
    """
    middle = from_place + 1 if step > 0 else from_place
    onwards = [(first, min(first + _STRETCH, count)) for first in range(middle, count, _STRETCH)]
    before = [(first, min(first + _STRETCH, middle)) for first in range(0, middle, _STRETCH)]
    yield from [*onwards, *before] if step > 0 else [*reversed(before), *reversed(onwards)]
