"""A run that the app in a cell has started, with the methods of a run that a cell calls."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from queue import Empty
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import HostError
from tuisim.engine.protocol import Ended, Message, Wheels
from tuisim.engine.runs.store import RunStore

if TYPE_CHECKING:
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.notebook.app_view import AppView


_START_WITHIN_S = 60.0


class AppRun:
    """Follows a run in the app; its output is read from the store.

    Args:
        view: The app, which has been asked to start a run.
        is_interrupted: Returns whether the user has interrupted the cell.

    Raises:
        HostError: the app has told why it cannot start the run, does not answer, or the user has interrupted the cell
            before.
    """

    waiting_for_reply = False
    waiting_for_input: str | None = None
    """None, as the app itself asks its user for input."""

    def __init__(self, view: AppView, is_interrupted: Callable[[], bool]) -> None:
        self._view = view
        self._is_interrupted = is_interrupted
        self.ended: Ended | None = None
        self.wheels = Wheels()
        self.run_id = str(self._wait_for_news("run", "problem")["id"])
        self.output = RunStore().load_run(self.run_id).output

    def _wait_for_news(self, *kinds: str) -> Mapping[str, Any]:
        """Return the next message of the app of one of these kinds.

        Raises:
            HostError: it is a problem, the user has interrupted the cell, or none comes in time.
        """
        until_s = time.monotonic() + _START_WITHIN_S
        while self._view.is_alive and time.monotonic() < until_s:
            if self._is_interrupted():
                self._view.ask("stop")
                raise HostError("interrupted before the app had begun")
            news = self._receive(0.2)
            if news.get("what") == "problem" and "problem" in kinds:
                raise HostError(str(news["text"]))
            if news.get("what") in kinds:
                return news
        raise HostError(
            "the app in the cell does not answer", "%sim_app --off runs cells without it"
        )

    def _receive(self, timeout_s: float) -> Mapping[str, Any]:
        try:
            return (
                self._view.told.get(timeout=timeout_s)
                if timeout_s
                else self._view.told.get_nowait()
            )
        except Empty:
            return {}

    def wait_for_event(self, timeout_s: float) -> None:
        """Wait until the run has ended, for at most `timeout_s` seconds."""
        if self.ended is None:
            news = self._receive(timeout_s)
            if (
                news.get("what") == "ended" and news.get("id") == self.run_id
            ) or not self._view.is_alive:
                self.ended = self.stored().end

    def pump(self) -> list[Message]:
        """Return nothing: the app handles the events."""
        return []

    def send(self, command: Message) -> None:
        """Ignore a command: the app sends its own."""

    def stop(self) -> None:
        """Ask the app to stop the program."""
        if self.ended is None and self._view.is_alive:
            self._view.ask("stop")

    def wait(self, timeout_s: float) -> None:
        """Wait until the run has ended, for at most `timeout_s` seconds."""
        until = time.monotonic() + timeout_s
        while self.ended is None and (left_s := until - time.monotonic()) > 0:
            self.wait_for_event(left_s)

    kill = stop

    def close(self) -> None:
        """Do nothing: the run belongs to the app."""

    def stored(self) -> StoredRun:
        """Load the run from the store."""
        return RunStore().load_run(self.run_id)
