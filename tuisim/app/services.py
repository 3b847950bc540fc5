"""What the parts of the app may ask of it: they know it by this interface only."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, ClassVar, Protocol, TypeVar

from textual.screen import Screen

from tuisim.app.keys.action import Action
from tuisim.errors import TuisimError

Result = TypeVar("Result")


class AppServices(Protocol):
    """Notices, dialogs and timers, and what changes the screen as a whole."""

    ACTIONS: ClassVar[Mapping[str, Action[Any, Any]]]
    """The keys by id."""

    def say(self, text: str) -> None:
        """Show a short notice."""

    def complain(self, error: TuisimError) -> None:
        """Show an error."""

    def push_screen(self, screen: Screen[Result], callback: Callable[[Result | None], None] | None = None) -> Any:
        """Open a dialog; its result is passed to the callback."""

    def set_timer(self, delay: float, callback: Callable[[], Any]) -> Any:
        """Call a function after a number of seconds."""

    def call_after_refresh(self, callback: Callable[..., Any], *args: Any) -> Any:
        """Call a function after the next layout."""

    def situation_changed(self) -> None:
        """Update the footer."""

    def draw(self, force: bool = False) -> bool:
        """Show the current moment in every panel. Return whether it differs from what they show already."""

    def start_run(self, paused: bool = False) -> bool:
        """Start the program, as soon as the mat is ready. Return whether it has started.

        Args:
            paused: Pause it at its first line.
        """

    def run_changed(self, last_words: str = "", error_line: int = 0) -> None:
        """Prepare the panels for another run, which may have ended already with some last words."""

    def action_redraw(self) -> None:
        """Redraw the whole screen."""

    def action_suspend_process(self) -> None:
        """Suspend the app as a job of its shell."""

    def exit(self) -> None:
        """End the app."""
