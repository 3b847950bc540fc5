"""The analyser with its keys: a screen above the lab, and the app that `tuisim analyse` starts."""

from __future__ import annotations

import gc
from typing import ClassVar

from textual.binding import BindingType

from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.source import LogRequest
from tuisim.app.action import build_bindings
from tuisim.app.analyser.actions.keys import ACTIONS
from tuisim.app.analyser.screen import LogScreen
from tuisim.app.background import enter, leave
from tuisim.app.terminal_app import TerminalApp, picture_mode_at_start
from tuisim.base.errors import TuisimError
from tuisim.terminal.picture_mode import PictureMode
from tuisim.terminal.picture_options import AUTO


class Analyser(LogScreen):
    """The screen with the views of one log and the keys that work on them."""

    ACTIONS = ACTIONS
    BINDINGS: ClassVar[list[BindingType]] = build_bindings(ACTIONS.values())


class AnalyserApp(TerminalApp):
    """The app of `tuisim analyse`; its only screen is the analyser.

    Args:
        request: The log to open.
        picture_mode: How pictures are drawn.
    """

    CSS_PATH = "../tuisim.tcss"

    def __init__(self, request: LogRequest, picture_mode: PictureMode | None = None) -> None:
        super().__init__(picture_mode)
        self.request = request
        self.failure: TuisimError | None = None
        """The error because of which the log could not be opened; None without one."""

    def on_mount(self) -> None:
        """Show the analyser; when the user closes it, end the app."""
        self.push_screen(_First(self.request), lambda _: self.exit())


class _First(Analyser):
    """The only screen of an `AnalyserApp`; an error before a log is shown ends the app."""

    def set_model(self, model: AnalysisModel) -> None:
        first = not self.is_open
        super().set_model(model)
        if first:
            # Rows and imported modules stay until the end: no key should wait for a garbage collection of them.
            self.call_after_refresh(gc.freeze)

    def complain(self, error: TuisimError) -> None:
        """Show an error; before a log is open, store the error in the app instead, so that the shell shows it."""
        app = self.app
        if not self.is_open and isinstance(app, AnalyserApp):
            app.failure = error
        else:
            super().complain(error)


def run_analyser(request: LogRequest) -> int:
    """Run the analyser in this terminal until the user leaves it; return the exit code.

    Raises:
        LogError: the log does not exist, or cannot be read.
    """
    enter()
    app = AnalyserApp(request, picture_mode_at_start(None, AUTO))
    app.run()
    if app.failure is not None:
        raise app.failure
    return leave(app.return_code or 0)
