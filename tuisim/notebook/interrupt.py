"""Kernel interrupts while a program runs."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any, TypeVar

Result = TypeVar("Result")


class Interruption:
    """Counts interrupts instead of raising at any point, such as between starting and storing a child.

    Only where the code of others runs are they what they always are, see `call`.
    """

    def __init__(self) -> None:
        self.count = 0
        """Number of interrupts."""
        self._allowed = False
        self._before: Any = None

    def __enter__(self) -> Interruption:
        # Python lets signals come to the main thread only.
        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGINT, self._strike)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)

    def _strike(self, _number: int, _frame: FrameType | None) -> None:
        self.count += 1
        if self._allowed:
            raise KeyboardInterrupt

    def call(self, act: Callable[[], Result]) -> Result | None:
        """Call a user's function, which an interrupt ends at once. Return its result, None if interrupted."""
        self._allowed = True
        try:
            return None if self.count else act()
        except KeyboardInterrupt:
            # It may also have raised one by itself.
            self.count = max(1, self.count)
            return None
        finally:
            self._allowed = False
