"""What panes show and takes long to find: the bands and the figures of long logs, beside the screen."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from textual.worker import get_current_worker

from tuisim.datalog.analysis.aside import plateaus_aside
from tuisim.errors import TuisimError
from tuisim.ui.analyser.task import AT_ONCE

if TYPE_CHECKING:
    from tuisim.ui.analyser.model import Model
    from tuisim.ui.analyser.screen import Analyser

_SEARCHED_AT_ONCE = 20_000
"""Rows in which bands are found within a few hundredths of a second."""


class Finder:
    """Finds what a pane shows, each thing once at a time.

    Args:
        screen: Shows it again when it is there.
    """

    def __init__(self, screen: Analyser) -> None:
        self._screen = screen
        self.busy: dict[str, Model] = {}
        """The log that is worked on, by pane."""

    def look(self, model: Model, pane: str) -> None:
        """Find what a pane is going to show and is not there yet; at once where that is quick."""
        names = {"bands": model.unsearched, "statistics": model.unsummed}.get(pane, list)()
        if not names or self.busy.get(pane) is model:
            return
        if pane == "bands" and model.log.rows <= _SEARCHED_AT_ONCE:
            model.find_bands(names)
        elif pane == "statistics" and model.log.rows <= AT_ONCE:
            model.sum_up(names)
        else:
            self.busy[pane] = model
            self._screen.run_worker(partial(self._find, model, pane, names), thread=True, group=pane, exclusive=True)

    def _find(self, model: Model, pane: str, names: list[str]) -> None:
        worker = get_current_worker()
        app = self._screen.app
        try:
            if pane == "bands":
                model.find_bands(names, partial(plateaus_aside, stopped=lambda: worker.is_cancelled))
            else:
                model.sum_up(names)
        except TuisimError as error:
            if not worker.is_cancelled:
                app.call_from_thread(self._screen.complain, error)
            return
        app.call_from_thread(self._found, pane)

    def _found(self, pane: str) -> None:
        self.busy.pop(pane, None)
        self._screen.update()
