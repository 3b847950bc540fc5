"""Help: how to start, and every key."""

from __future__ import annotations

from typing import ClassVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.widgets import Static

from tuisim.ui.actions import ACTIONS, Action
from tuisim.ui.editor.area import EDITOR_KEYS
from tuisim.ui.screens.dialog import Dialog

START = (
    "Press o and open an example, then R: the robot runs it. S stops, space pauses. b lays out another mat; "
    "drag the robot with the mouse or nudge it with the arrows, and the sensors follow. What a program prints as "
    "a name, a colon and a number, such as Colour: 86.3, goes into the log and the chart; e writes the log to a file."
)


def _nudge_rows(actions: list[Action]) -> list[tuple[str, str]]:
    """The ten nudging keys in three rows."""
    rows = [(a.key_label, a.title) for a in actions if not a.id.startswith("nudge-")]
    if len(rows) < len(actions):
        rows += [
            ("← ↑ → ↓", "Move the robot 10 mm"),
            ("shift + arrow", "Move the robot 1 mm"),
            ("ctrl + ← →", "Turn the robot 5°"),
        ]
    return rows


def key_table() -> Table:
    """Return every key by group, two columns."""
    groups: dict[str, list[Action]] = {}
    for action in ACTIONS.values():
        groups.setdefault(action.group, []).append(action)
    table = Table.grid(padding=(0, 2))
    table.add_column(justify="right", style="bold")
    table.add_column()
    for group, actions in groups.items():
        table.add_row("", Text(group, "bold #5fafff"))
        for key, title in _nudge_rows(actions):
            table.add_row(key, title)
        table.add_row()
    table.add_row("", Text("In the code", "bold #5fafff"))
    for key, title in EDITOR_KEYS:
        table.add_row(key, title)
    table.add_row()
    for key, title in (("ctrl+p", "Command palette"), ("tab", "Next panel or field"), ("Escape", "Leave a field")):
        table.add_row(key, title)
    return table


class HelpScreen(Dialog[None]):
    """How to start, and every key."""

    TITLE_TEXT: str = "Help"
    HINT: str = "↑ ↓ scroll · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [Binding("question_mark,q", "leave", "Close", show=False)]

    def content(self) -> ComposeResult:
        """The text, scrolled if need be."""
        with VerticalScroll():
            yield Static(START, classes="start", markup=False)
            yield Static(key_table())
