"""A progress bar on stderr for work that takes more than a second; only if stderr is a terminal."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Self, TextIO

from tuisim.errors import printable

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

SHOWN_AFTER_S = 1.0
"""Shorter work shows no bar."""

_QUIET_S = 0.3
"""A bar hidden for text reappears after this time without text."""
_REDRAWS_PER_S = 10


def is_watched() -> bool:
    """Return whether stderr is a terminal that can show a bar."""
    return sys.stderr.isatty() and os.environ.get("TERM", "") not in ("", "dumb")


_active: list[Progress] = []
"""The shown progress, at most one."""


@contextmanager
def aside(stream: TextIO) -> Iterator[None]:
    """Hide the bar, if any, while text is written to a stream that may be the same terminal."""
    if _active and stream.isatty():
        with _active[-1].away():
            yield
    else:
        yield


def tell(what: str, done: float = 0.0, total: float | None = None) -> None:
    """Update the shown progress, if any."""
    if _active:
        _active[-1].tell(what, done, total)


class Progress:
    """Progress of a piece of work, as a context manager.

    A thread draws the bar, so the work need not yield; rich is imported when a bar is first shown.

    Args:
        what: The description, such as `exporting log.csv`.
        total: The amount of work, None if unknown.
    """

    def __init__(self, what: str, total: float | None = None) -> None:
        self._what, self._total, self._done = what, total, 0.0
        self._bar: Bar | None = None
        self._lock = threading.RLock()
        self._over = threading.Event()
        self._begun = time.monotonic()
        self._show_at = self._begun + SHOWN_AFTER_S
        self._thread: threading.Thread | None = None

    def __enter__(self) -> Self:
        if is_watched():
            _active.append(self)
            self._thread = threading.Thread(target=self._draw, daemon=True)
            self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        if self._thread is not None:
            self._thread.join()
            _active.remove(self)

    def tell(self, what: str, done: float, total: float | None = None) -> None:
        """Update the progress; the thread draws it later."""
        self._what, self._done, self._total = what, done, total

    @contextmanager
    def away(self) -> Iterator[None]:
        """Hide the bar while something else is written to the terminal."""
        with self._lock:
            self._hide()
            self._show_at = max(self._show_at, time.monotonic() + _QUIET_S)
            yield

    def _draw(self) -> None:
        try:
            while not self._over.wait(1 / _REDRAWS_PER_S):
                with self._lock:
                    if time.monotonic() >= self._show_at:
                        self._show()
        finally:
            with self._lock:
                self._hide()

    def _show(self) -> None:
        if self._bar is None:
            self._bar = _bar()
            self._bar.add_task("")
            # The bar may have been hidden for a while.
            self._bar.tasks[0].start_time = self._bar.get_time() - (time.monotonic() - self._begun)
            self._bar.start()
        task = self._bar.tasks[0]
        task.description, task.completed, task.total = printable(self._what), self._done, self._total
        self._bar.refresh()

    def _hide(self) -> None:
        if self._bar is not None:
            self._bar.stop()
            self._bar = None


def _bar() -> Bar:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}", markup=False), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    # stdout and stderr are not redirected: only the bar goes through rich.
    console = Console(stderr=True)
    return Progress(
        *columns, console=console, auto_refresh=False, transient=True, redirect_stdout=False, redirect_stderr=False
    )
