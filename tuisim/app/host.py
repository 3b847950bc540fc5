"""What the parts of the app may ask of it."""

from __future__ import annotations

from abc import abstractmethod

from tuisim.app.action import ActionHost
from tuisim.app.terminal.terminal_app import TerminalApp


class LabHost(ActionHost, TerminalApp):
    """Notices, dialogs and timers of an app with keys; and what changes its screen as a whole."""

    @abstractmethod
    def situation_changed(self) -> None:
        """Update the footer: other keys may be available."""

    @abstractmethod
    def draw(self, force: bool = False) -> bool:
        """Show the instant in view in every panel. Return whether it differs from what they show already."""

    @abstractmethod
    def start_run(self, paused: bool = False) -> bool:
        """Start the program, as soon as the mat is ready. Return whether it has started.

        Args:
            paused: Pause it at its first line.
        """

    @abstractmethod
    def run_changed(self, last_words: str = "", error_line: int = 0) -> None:
        """Prepare the panels for another run, which may have ended already with some last words."""
