"""The command palette: every action by its title."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, cast

from textual.command import CommandList, CommandPalette, DiscoveryHit, Hit, Hits, Provider

from tuisim.app.actions.table import ACTIONS
from tuisim.app.dialogs.dialog import ClosesOnce

if TYPE_CHECKING:
    from tuisim.app.app import LabApp


class Palette(CommandPalette, ClosesOnce[None]):
    """Textual's command palette, as one of the app's screens that close once."""

    def _action_command_list(self, action: str) -> None:
        # A list that was never shown has no pages and no lines yet.
        if self.query_one(CommandList).size:
            super()._action_command_list(action)


@dataclass(frozen=True, slots=True)
class Offer:
    """One entry of the palette."""

    title: str
    group: str
    key: str
    """Display name of the key."""
    do: Callable[[], None]

    @property
    def help(self) -> str:
        """The text below the title."""
        return f"{self.group} · key {self.key}"


class KeyProvider(Provider):
    """Provides actions that have a key."""

    def offers(self) -> Iterator[Offer]:
        """Yield every entry."""
        yield from ()

    async def discover(self) -> Hits:
        """Yield every entry, before anything is typed."""
        for offer in self.offers():
            yield DiscoveryHit(offer.title, offer.do, help=offer.help)

    async def search(self, query: str) -> Hits:
        """Yield the entries with a matching title."""
        matcher = self.matcher(query)
        for offer in self.offers():
            if (score := matcher.match(offer.title)) > 0:
                yield Hit(score, matcher.highlight(offer.title), offer.do, help=offer.help)


class ActionProvider(KeyProvider):
    """Provides the app's `ACTIONS`."""

    def offers(self) -> Iterator[Offer]:
        """Yield every action of the app."""
        act = cast("LabApp", self.app).action_act
        for action in ACTIONS.values():
            yield Offer(action.title, action.group, action.key_label, partial(act, action.id))
