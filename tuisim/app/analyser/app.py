"""The stand-alone analyser, as `tuisim analyse` starts it."""

from __future__ import annotations

import gc
from typing import ClassVar

from tuisim.analysis.model import Model
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.screen import Analyser
from tuisim.app.terminal.terminal_app import TerminalApp
from tuisim.errors import TuisimError


class AnalyserApp(TerminalApp):
    """An app with one screen.

    Args:
        wanted: What to open.
    """

    CSS_PATH = "../tuisim.tcss"
    TITLE = "tuisim"
    NOTIFICATION_TIMEOUT = 4
    ENABLE_COMMAND_PALETTE: ClassVar[bool] = True

    def __init__(self, wanted: LogRequest) -> None:
        super().__init__()
        self.wanted = wanted
        self.failure: TuisimError | None = None
        """The error that prevented the log from being opened."""

    def on_mount(self) -> None:
        """Show the analyser; closing it ends the app."""
        self.push_screen(_First(self.wanted), lambda _: self.exit())


class _First(Analyser):
    """The only screen: an error before anything is shown ends the app."""

    def take(self, model: Model) -> None:
        first = self.model is None
        super().take(model)
        if first:
            # Modules imported by drawing stay as well; no key should wait for a garbage collection of all that.
            self.call_after_refresh(gc.freeze)

    def complain(self, error: TuisimError) -> None:
        """Show an error, or keep it for the shell."""
        app = self.app
        if self.model is None and isinstance(app, AnalyserApp):
            app.failure = error
        else:
            super().complain(error)


def run_analyser(wanted: LogRequest) -> int:
    """Run the analyser in this terminal until the user leaves it; return the exit code.

    Raises:
        LogError: there is no such log, or it cannot be read.
    """
    # Modules imported by now stay until the end: exclude them from garbage collection.
    gc.freeze()
    app = AnalyserApp(wanted)
    app.run()
    if app.failure is not None:
        raise app.failure
    return app.return_code or 0
