"""The command palette: the actions of the app, or of the screen above it, by title."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from textual.command import CommandList, CommandPalette, DiscoveryHit, Hit, Hits, Provider

from tuisim.app.dialogs.dialog import ClosesOnce
from tuisim.app.keys.action import ActionHost


class Palette(CommandPalette, ClosesOnce[None]):
    """Textual's command palette, as one of the app's screens that close once."""

    def _action_command_list(self, action: str) -> None:
        # A list that was never shown has no pages and no lines yet.
        if self.query_one(CommandList).size:
            super()._action_command_list(action)


class ActionProvider(Provider):
    """Provides the actions of the screen that the palette opens above, else those of the app."""

    def _offers(self) -> Iterator[tuple[str, Callable[[], None], str]]:
        """Yield the title of each action, a call that runs it, and the text below the title."""
        host = self.screen if isinstance(self.screen, ActionHost) else self.app
        if isinstance(host, ActionHost):
            for action in host.ACTIONS.values():
                yield action.title, partial(host.action_act, action.id), f"{action.group} · key {action.key_label}"

    async def discover(self) -> Hits:
        """Yield every action, before anything is typed."""
        for title, do, text in self._offers():
            yield DiscoveryHit(title, do, help=text)

    async def search(self, query: str) -> Hits:
        """Yield the actions with a matching title."""
        matcher = self.matcher(query)
        for title, do, text in self._offers():
            if (score := matcher.match(title)) > 0:
                yield Hit(score, matcher.highlight(title), do, help=text)
