"""How the apps stop, go on and end: in order, whoever makes them and whatever they are doing."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Sequence
from functools import partial
from typing import Any

from textual import on
from textual.app import App
from textual.css.query import NoMatches
from textual.driver import Driver
from textual.filter import LineFilter

from tuisim.ui.driver import TerminalDriver
from tuisim.ui.harmless import Harmless

_HARMLESS = Harmless()


def is_leaving(app: App[Any]) -> bool:
    """Return whether the app has been told to end: nothing may be opened any more, for it could not be drawn."""
    # Textual has no public word for it.
    return app._exit


class TerminalApp(App[None]):
    """An app that gives the terminal back in order, also when it is stopped or ended from outside."""

    def __init__(self) -> None:
        super().__init__(driver_class=TerminalDriver)

    def get_line_filters(self) -> Sequence[LineFilter]:
        """Return what all that is drawn goes through."""
        return [*super().get_line_filters(), _HARMLESS]

    def on_ready(self) -> None:
        """End the app as by a key when it is told to from outside."""
        if self.is_headless:
            return
        loop = asyncio.get_running_loop()
        for number in (signal.SIGTERM, signal.SIGHUP):
            # As a shell shows a program that the signal has ended.
            loop.add_signal_handler(number, partial(self.exit, return_code=128 + number))

    @on(Driver.SignalResume)
    def draw_again(self) -> None:
        """Draw all of the screen: while the app was stopped the shell has written over it."""
        self.refresh(layout=True)

    def _handle_exception(self, error: Exception) -> None:
        # A screen that was being opened when the app was told to end is taken down half built.
        if not (is_leaving(self) and isinstance(error, NoMatches)):
            super()._handle_exception(error)
