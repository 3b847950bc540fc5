"""The driver of the terminal: one that goes away must not keep the app from ending."""

from __future__ import annotations

import os
import signal
from contextlib import suppress
from io import TextIOWrapper
from pathlib import Path
from typing import TextIO, cast

from textual.app import App
from textual.drivers.linux_driver import LinuxDriver


class ResilientOutput:
    """A terminal's output that may be written to when the terminal is gone, after a lost connection for one.

    Textual writes from a thread of its own. That thread would end with the first write that fails, and the app, which
    has to write a few words more before it can leave its program and its files in order, would wait for it for ever.

    Args:
        file: The output.
    """

    def __init__(self, file: TextIO) -> None:
        self._file = file
        self.gone = False
        """Whether a write has failed; what follows is dropped."""

    def write(self, text: str) -> int:
        """Write a text, or drop it; return its length."""
        if not self.gone:
            try:
                self._file.write(text)
            except OSError:
                self._lose()
        return len(text)

    def flush(self) -> None:
        """Send what was written."""
        if not self.gone:
            try:
                self._file.flush()
            except OSError:
                self._lose()

    def _lose(self) -> None:
        # What is still in the file's buffer would fail once more when Python ends, and change the exit code.
        with suppress(OSError), Path(os.devnull).open("wb") as nothing:
            os.dup2(nothing.fileno(), self._file.fileno())
            self._file.flush()
        self.gone = True

    def fileno(self) -> int:
        """Return the number of the output's file."""
        return self._file.fileno()


class TerminalDriver(LinuxDriver):
    """Textual's driver with an output that outlasts its terminal."""

    def __init__(
        self, app: App[object], *, debug: bool = False, mouse: bool = True, size: tuple[int, int] | None = None
    ) -> None:
        super().__init__(app, debug=debug, mouse=mouse, size=size)
        self._file = cast(TextIOWrapper, ResilientOutput(cast(TextIO, self._file)))

    def stop_as_job(self) -> bool:
        """Give the terminal back and stop, with all that was started together; go on when the shell says so.

        Textual stops with a signal that cannot be refused, also where no shell is there to go on from it. The one for
        a job's stop is dropped there.

        Returns:
            Whether the app was stopped, and goes on now.
        """
        self.suspend_application_mode()
        self._must_signal_resume = True
        handler = signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(0, signal.SIGTSTP)
        signal.signal(signal.SIGTSTP, handler)
        # Whoever lets the app go on has had the terminal prepared by then.
        stopped = not self._must_signal_resume
        if not stopped:
            self.resume_application_mode()
        return stopped

    def _sigcont_application(self, *_: object) -> None:
        # The signal also comes with the news that the terminal is gone, where there is nothing to go on with, and after
        # a stop that could not be prepared for, where what read and wrote before must end before the same begins anew.
        if not self._auto_restart or not os.isatty(self.fileno):
            return
        if self._writer_thread is not None and self._writer_thread.is_alive():
            self.suspend_application_mode()
            self._must_signal_resume = True
        self.resume_application_mode()
