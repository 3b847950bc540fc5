"""Help of the analyser, and its actions in the command palette."""

from __future__ import annotations

from functools import partial
from typing import ClassVar, cast

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.command import DiscoveryHit, Hit, Hits, Provider
from textual.containers import VerticalScroll
from textual.widgets import Static

from tuisim.ui.analyser.actions import ACTIONS, Action
from tuisim.ui.screens.dialog import Dialog

_START = (
    "One cursor moves chart, table, world and source line: ← → go through the chart, ↑ ↓ through the rows. "
    "b finds the bands: ↑ ↓ choose one, m writes a note about it. z zooms in, f shows everything again."
)


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
        for action in actions:
            table.add_row(Text(action.label), Text(action.title))
        table.add_row()
    return table


class AnalyserHelp(Dialog[None]):
    """Every key of the analyser."""

    TITLE_TEXT: str = "Help: the analyser"
    HINT: str = "↑ ↓ scroll · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [Binding("question_mark,q", "leave", "Close", show=False)]

    def content(self) -> ComposeResult:
        """The text, scrolled if need be."""
        with VerticalScroll():
            yield Static(_START, classes="start", markup=False)
            yield Static(key_table())


class AnalyserActions(Provider):
    """Offers what `ACTIONS` lists."""

    def _hits(self) -> list[tuple[Action, partial[None]]]:
        from tuisim.ui.analyser.screen import Analyser

        screen = cast(Analyser, self.screen)
        return [(action, partial(screen.action_act, action.id)) for action in ACTIONS.values()]

    async def discover(self) -> Hits:
        """Offer everything before a word is typed."""
        for action, do in self._hits():
            yield DiscoveryHit(action.title, do, help=f"{action.group} · key {action.label}")

    async def search(self, query: str) -> Hits:
        """Offer the actions whose title matches."""
        matcher = self.matcher(query)
        for action, do in self._hits():
            if (score := matcher.match(action.title)) > 0:
                yield Hit(score, matcher.highlight(action.title), do, help=f"{action.group} · key {action.label}")
