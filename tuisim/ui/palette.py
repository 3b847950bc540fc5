"""The command palette: every action by its title."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, cast

from textual.command import DiscoveryHit, Hit, Hits, Provider

from tuisim.ui.actions import ACTIONS, Action

if TYPE_CHECKING:
    from tuisim.ui.app import Lab


class ActionProvider(Provider):
    """Offers what `ACTIONS` lists."""

    def _do(self, action: Action) -> None:
        cast("Lab", self.app).action_act(action.id)

    async def discover(self) -> Hits:
        """Offer everything before a word is typed."""
        for action in ACTIONS.values():
            yield DiscoveryHit(action.title, partial(self._do, action), help=_help(action))

    async def search(self, query: str) -> Hits:
        """Offer the actions whose title matches."""
        matcher = self.matcher(query)
        for action in ACTIONS.values():
            if (score := matcher.match(action.title)) > 0:
                yield Hit(score, matcher.highlight(action.title), partial(self._do, action), help=_help(action))


def _help(action: Action) -> str:
    return f"{action.group} · key {action.key_label}"
