"""The interface of the app for its parts."""

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
    """The interface of the app for its parts: notices, dialogs, timers, and methods that redraw or start a run."""

    undo: Callable[[], None] | None = None
    """Function that undoes the last change; None if there is nothing to undo."""
    has_greeted = False
    """Whether the welcome was shown, or need not be; while it may still appear, keys wait."""

    def action_act(self, name: str) -> None:
        self.notices.release()
        super().action_act(name)

    def answer(self, text: str) -> None:
        """Show a notice with the result of a key until another key does something.

        Args:
            text: Ids of actions in braces, such as `{run}`, are shown as their keys.
        """
        self.notify(self.fill_keys(text), timeout=inf)

    def offer_undo(self, undo: Callable[[], None] | None) -> None:
        """Let the undo key call a function, until a run starts or another change can be undone.

        Args:
            undo: The function; None for nothing to undo.
        """
        self.undo = undo
        self.handle_situation_change()

    @abstractmethod
    def handle_situation_change(self) -> None:
        """Update the footer, because other keys may be available."""

    @abstractmethod
    def draw(self, force: bool = False) -> bool:
        """Show the instant in view in every panel. Return whether the panels have changed.

        Args:
            force: Whether to draw the panels even if nothing has changed.
        """

    @abstractmethod
    def show_log_again(self) -> None:
        """Show the output and the logged data of the run in view again, after they were cleared."""

    @abstractmethod
    def start_run(self, paused: bool = False) -> bool:
        """Start the program; if the mat is not prepared yet, start it when the mat is.

        Return whether it has started now.

        Args:
            paused: Whether the program pauses at its first line.
        """

    @abstractmethod
    def show_mat(self, pixels: Pixels | None) -> None:
        """Show the image of the prepared mat.

        Args:
            pixels: The image; None if the world panel shows it already.
        """

    @abstractmethod
    def show_next_run(self) -> None:
        """Show the changed plan of the next run in the panels."""

    @abstractmethod
    def go_to_now(self) -> None:
        """Return from the past to the newest instant."""

    @abstractmethod
    def run_changed(self, last_words: str = "", error_line: int = 0) -> None:
        """Prepare the panels for another run.

        Args:
            last_words: How the run ended, if it has ended already.
            error_line: The line at which it ended with an error, 0 for none.
        """
