"""What the helps have in common: a few words to start with, then every key by group."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import ClassVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.widgets import Static

from tuisim.ui.screens.dialog import Dialog

Keys = Iterable[tuple[str, str]]
"""Each key as people write it, and what it does."""


def key_table(groups: Mapping[str, Keys]) -> Table:
    """Return every key by group, two columns; a group without a name has no heading."""
    table = Table.grid(padding=(0, 2))
    table.add_column(justify="right", style="bold")
    table.add_column()
    for group, keys in groups.items():
        if group:
            table.add_row("", Text(group, "bold #5fafff"))
        for key, title in keys:
            table.add_row(Text(key), Text(title))
        table.add_row()
    return table


class KeyHelp(Dialog[None]):
    """A help; `?` closes it as it opened it."""

    HINT: str = "↑ ↓ scroll · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [Binding("question_mark,q", "leave", "Close", show=False)]
    START: str = ""

    def groups(self) -> Mapping[str, Keys]:
        """Every key by the name of its group."""
        return {}

    def content(self) -> ComposeResult:
        """The text, scrolled if need be."""
        with VerticalScroll():
            yield Static(self.START, classes="start", markup=False)
            yield Static(key_table(self.groups()))
