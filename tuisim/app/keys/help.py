"""The help screen: a short introduction, then every key by group."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, ClassVar

from rich.table import Table
from rich.text import Text
from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.widgets import Static

from tuisim.app.dialogs.dialog import Dialog
from tuisim.app.keys.action import Action, KeyWord

COLUMN_CELLS = 50
"""A column of keys is not made narrower than this to fit another one next to it."""


def key_table(groups: Mapping[str, Iterable[KeyWord]], width: int) -> Table:
    """Return every key by group, in as many columns as fit; a group without a name has no heading."""
    rows = [(group, list(keys)) for group, keys in groups.items()]
    count = max(1, min(width // COLUMN_CELLS, len(rows)))
    columns = Table.grid(padding=(0, 2), expand=True)
    for _ in range(count):
        columns.add_column(ratio=1)
    columns.add_row(*map(_column, _in_columns(rows, count)))
    return columns


_Group = tuple[str, list[KeyWord]]


def _in_columns(groups: list[_Group], count: int) -> list[list[_Group]]:
    """Distribute groups over columns, in their order, so that the longest column is as short as possible."""

    def filled(most: int) -> list[list[_Group]]:
        columns: list[list[_Group]] = [[]]
        left = most
        for name, keys in groups:
            rows = len(keys) + 2
            if rows > left and columns[-1]:
                columns.append([])
                left = most
            columns[-1].append((name, keys))
            left -= rows
        return columns

    lowest = next(most for most in range(1, 10_000) if len(filled(most)) <= count)
    columns = filled(lowest)
    return columns + [[] for _ in range(count - len(columns))]


def _column(groups: list[_Group]) -> Table:
    table = Table.grid(padding=(0, 2))
    table.add_column(justify="right", style="bold")
    table.add_column()
    for group, keys in groups:
        if group:
            table.add_row("", Text(group, "bold #5fafff"))
        for key, title in keys:
            table.add_row(Text(key), Text(title))
        table.add_row()
    return table


class _KeyTable(Static):
    """The table of keys, laid out for the available width."""

    def __init__(self, groups: Mapping[str, Iterable[KeyWord]]) -> None:
        super().__init__()
        self._groups = {group: list(keys) for group, keys in groups.items()}

    def on_resize(self, event: events.Resize) -> None:
        """Lay out for the new width."""
        self.update(key_table(self._groups, event.size.width))


def key_groups(actions: Iterable[Action[Any, Any]]) -> dict[str, list[KeyWord]]:
    """Return the keys of actions by the name of their group."""
    groups: dict[str, list[KeyWord]] = {}
    for action in actions:
        groups.setdefault(action.group, []).append((action.key_label, action.title))
    return groups


class KeyHelp(Dialog[None]):
    """A help screen; `?` closes it as well.

    Args:
        title: Title of the dialog.
        start: How to start.
        groups: The keys by the name of their group.
    """

    HINT: str = "↑ ↓ scroll · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [Binding("question_mark,q", "leave", "Close", show=False)]

    def __init__(self, title: str, start: str, groups: Mapping[str, Iterable[KeyWord]]) -> None:
        super().__init__()
        self.TITLE_TEXT = title
        self._start = start
        self._groups = groups

    def content(self) -> ComposeResult:
        """Return the text, scrolled if necessary."""
        with VerticalScroll():
            yield Static(self._start, classes="start", markup=False)
            yield _KeyTable(self._groups)
