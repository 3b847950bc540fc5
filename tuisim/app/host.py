"""What the parts of the app may ask of it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from math import inf
from typing import TYPE_CHECKING

from tuisim.app.action import ActionHost
from tuisim.app.terminal_app import TerminalApp

if TYPE_CHECKING:
    from tuisim.terminal.pixels import Pixels


class LabHost(ActionHost, TerminalApp):
    """Notices, dialogs and timers of an app with keys; and what changes its screen as a whole."""

    undo: Callable[[], None] | None = None
    """Takes back what the last key has changed at once; None if there is nothing to take back."""

    def action_act(self, name: str) -> None:
        self.notices.release()
        super().action_act(name)

    def answer(self, text: str) -> None:
        """Show what a key has found out until the next one does something; ids of actions are in braces."""
        self.notify(self.fill_keys(text), timeout=inf)

    def offer_undo(self, undo: Callable[[], None] | None) -> None:
        """Offer a key that takes something back, until a run starts or another key changes something."""
        self.undo = undo
        self.handle_situation_change()

    @abstractmethod
    def handle_situation_change(self) -> None:
        """Update the footer: other keys may be available."""

    @abstractmethod
    def draw(self, force: bool = False) -> bool:
        """Show the instant in view in every panel. Return whether it differs from what they show already."""

    @abstractmethod
    def show_log_again(self) -> None:
        """Show what the run in view has written in output and chart again, after they were cleared."""

    @abstractmethod
    def start_run(self, paused: bool = False) -> bool:
        """Start the program, as soon as the mat is ready. Return whether it has started.

        Args:
            paused: Pause it at its first line.
        """

    @abstractmethod
    def show_mat(self, pixels: Pixels | None) -> None:
        """Show the image of the mat that has been prepared; None if it is shown already."""

    @abstractmethod
    def show_next_run(self) -> None:
        """Update the panels after the plan of the next run has changed."""

    @abstractmethod
    def go_to_now(self) -> None:
        """Return from the past to the newest instant."""

    @abstractmethod
    def run_changed(self, last_words: str = "", error_line: int = 0) -> None:
        """Prepare the panels for another run, which may have ended already with some last words."""
