"""Throttle: does something at most so often, and never forgets the last time it was asked."""

from __future__ import annotations

import time
from collections.abc import Callable

from textual.timer import Timer
from textual.widget import Widget


class Throttle:
    """Calls a function at most once a period.

    Args:
        widget: Whose timers are used; while it is not mounted nothing is called.
        period_s: Least time between two calls, in wall-clock seconds.
        do: The function.
    """

    def __init__(self, widget: Widget, period_s: float, do: Callable[[], None]) -> None:
        self._widget = widget
        self._period_s = period_s
        self._do = do
        self._last_s = 0.0
        self._timer: Timer | None = None

    def ask(self) -> None:
        """Call the function now if the last call is a period ago, else as soon as it is."""
        if self._timer is not None or not self._widget.is_attached:
            return
        left_s = self._last_s + self._period_s - time.monotonic()
        if left_s > 0:
            self._timer = self._widget.set_timer(left_s, self.now)
        else:
            self.now()

    def now(self) -> None:
        """Call the function at once."""
        if self._timer is not None:
            self._timer.stop()
            self._timer = None
        self._last_s = time.monotonic()
        if self._widget.is_attached:
            self._do()
