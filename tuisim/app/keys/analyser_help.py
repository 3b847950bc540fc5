"""Help of the analyser, and its actions in the command palette."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, cast

from tuisim.app.analyser.actions.table import ACTIONS
from tuisim.app.keys.help import KeyHelp, Keys
from tuisim.app.keys.palette import KeyProvider, Offer

if TYPE_CHECKING:
    from tuisim.app.analyser.screen import Analyser


class AnalyserHelp(KeyHelp):
    """Every key of the analyser."""

    TITLE_TEXT: str = "Help: the analyser"
    START: str = (
        "One cursor moves chart, table, world and source line: ← → go through the chart, ↑ ↓ through the rows. "
        "b finds the bands: ↑ ↓ choose one, m writes a note about it. z zooms in, f shows everything again."
    )

    def groups(self) -> Mapping[str, Keys]:
        """Return the keys of the analyser."""
        groups: dict[str, list[tuple[str, str]]] = {}
        for action in ACTIONS.values():
            groups.setdefault(action.group, []).append((action.label, action.title))
        return groups


class AnalyserActions(KeyProvider):
    """Provides the analyser's `ACTIONS`."""

    def offers(self) -> Iterator[Offer]:
        """Yield every action of the analyser."""
        act = cast("Analyser", self.screen).action_act
        for action in ACTIONS.values():
            yield Offer(action.title, action.group, action.label, partial(act, action.id))
