"""Background work of the analyser: in a thread or process for long logs, else at once."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, TypeVar

from textual.worker import get_current_worker

from tuisim.analysis.table import AT_ONCE, TableTask
from tuisim.errors import TuisimError
from tuisim.logs.plateaus import plateaus_aside

if TYPE_CHECKING:
    from tuisim.analysis.model import Model
    from tuisim.app.analyser.screen import Analyser

_SEARCHED_AT_ONCE = 20_000
"""Up to this many rows, the search for bands takes a few hundredths of a second."""


class Finder:
    """Computes the content of panes, each one once at a time.

    Args:
        screen: Updated when a result has arrived.
    """

    def __init__(self, screen: Analyser) -> None:
        self._screen = screen
        self.busy: dict[str, Model] = {}
        """The log that is being processed, by pane."""

    def look(self, model: Model, pane: str) -> None:
        """Compute the missing content of a pane; small logs synchronously."""
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


Made = TypeVar("Made")


def work(screen: Analyser, word: str, rows: int, do: Callable[[TableTask], Made], then: Callable[[Made], None]) -> None:
    """Run a function and pass on its result; newer work replaces older work.

    Args:
        screen: Shows the progress.
        word: Label of the work.
        rows: Number of rows; decides between background and synchronous work.
        do: The work; must only read the log.
        then: Called with the result, in the app's thread.

    Raises:
        TuisimError: raised by `do` if it runs synchronously; otherwise the error is shown on the screen.
    """
    if rows <= AT_ONCE:
        then(do(TableTask(word)))
        return
    task = TableTask(word)
    screen.begin(task)
    screen.run_worker(partial(_aside, screen, task, do, then), thread=True, group="work")


def _aside(screen: Analyser, task: TableTask, do: Callable[[TableTask], Made], then: Callable[[Made], None]) -> None:
    try:
        made = do(task)
    except TuisimError as error:
        screen.app.call_from_thread(screen.end, task, partial(screen.complain, error))
    else:
        screen.app.call_from_thread(screen.end, task, partial(then, made))
