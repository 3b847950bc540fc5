"""A bar on stderr for work that takes more than a second, where that is a terminal; nothing in pipes and files."""

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
"""Work that takes less is not worth a bar."""

_QUIET_S = 0.3
"""A bar that had to make room for text comes back when there was none for so long."""
_TURNS_A_S = 10


def is_watched() -> bool:
    """Return whether somebody looks at stderr who can see a bar."""
    return sys.stderr.isatty() and os.environ.get("TERM", "") not in ("", "dumb")


_at_work: list[Progress] = []
"""The work that is shown; one at most."""


@contextmanager
def aside(stream: TextIO) -> Iterator[None]:
    """Keep the bar, if there is one, away while text is written to a stream that may be the same terminal."""
    if _at_work and stream.isatty():
        with _at_work[-1].away():
            yield
    else:
        yield


def tell(what: str, done: float = 0.0, total: float | None = None) -> None:
    """Say how far the work is, if it is shown at all."""
    if _at_work:
        _at_work[-1].tell(what, done, total)


class Progress:
    """How far a piece of work is, as a context.

    A thread draws it, so that the work need not come back now and then; rich is imported when a bar is shown first.

    Args:
        what: What is being done, such as `exporting log.csv`.
        total: How much there is to do, None where that is not known.
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
            _at_work.append(self)
            self._thread = threading.Thread(target=self._draw, daemon=True)
            self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        if self._thread is not None:
            self._thread.join()
            _at_work.remove(self)

    def tell(self, what: str, done: float, total: float | None = None) -> None:
        """Say how far the work is; drawn when it is time."""
        self._what, self._done, self._total = what, done, total

    @contextmanager
    def away(self) -> Iterator[None]:
        """Keep the bar away while something else is written to the terminal."""
        with self._lock:
            self._take_away()
            self._show_at = max(self._show_at, time.monotonic() + _QUIET_S)
            yield

    def _draw(self) -> None:
        try:
            while not self._over.wait(1 / _TURNS_A_S):
                with self._lock:
                    if time.monotonic() >= self._show_at:
                        self._show()
        finally:
            with self._lock:
                self._take_away()

    def _show(self) -> None:
        if self._bar is None:
            self._bar = _bar()
            self._bar.add_task("")
            # It may have been away for a while.
            self._bar.tasks[0].start_time = self._bar.get_time() - (time.monotonic() - self._begun)
            self._bar.start()
        task = self._bar.tasks[0]
        task.description, task.completed, task.total = printable(self._what), self._done, self._total
        self._bar.refresh()

    def _take_away(self) -> None:
        if self._bar is not None:
            self._bar.stop()
            self._bar = None


def _bar() -> Bar:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}", markup=False), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    # What is written to stdout and stderr meanwhile goes there as it is: only the bar goes through rich.
    console = Console(stderr=True)
    return Progress(
        *columns, console=console, auto_refresh=False, transient=True, redirect_stdout=False, redirect_stderr=False
    )
