"""The terminal driver: a terminal that disappears must not keep the app from ending."""

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
    """Terminal output that accepts writes even after the terminal is gone, for example after a lost connection.

    Textual writes from a thread of its own. That thread would end at the first failed write, and the app, which has to
    write a little more before it can shut down, would wait for it for ever.

    Args:
        file: The output.
    """

    def __init__(self, file: TextIO) -> None:
        self._file = file
        self.gone = False
        """Whether a write has failed; later output is dropped."""

    def write(self, text: str) -> int:
        """Write a text, or drop it. Return its length."""
        if not self.gone:
            try:
                self._file.write(text)
            except OSError:
                self._lose()
        return len(text)

    def flush(self) -> None:
        """Flush the output."""
        if not self.gone:
            try:
                self._file.flush()
            except OSError:
                self._lose()

    def _lose(self) -> None:
        # Data left in the file's buffer would fail again when Python ends, and change the exit code.
        with suppress(OSError), Path(os.devnull).open("wb") as nothing:
            os.dup2(nothing.fileno(), self._file.fileno())
            self._file.flush()
        self.gone = True

    def fileno(self) -> int:
        """Return the file descriptor."""
        return self._file.fileno()


class TerminalDriver(LinuxDriver):
    """Textual's driver with an output that survives the loss of its terminal."""

    def __init__(
        self, app: App[object], *, debug: bool = False, mouse: bool = True, size: tuple[int, int] | None = None
    ) -> None:
        super().__init__(app, debug=debug, mouse=mouse, size=size)
        self._file = cast(TextIOWrapper, ResilientOutput(cast(TextIO, self._file)))

    def stop_as_job(self) -> bool:
        """Restore the terminal and stop the whole process group; resume when the shell says so.

        Textual stops with a signal that cannot be ignored, even without a shell that could resume the app. The signal
        for job control is dropped in that case.

        Returns:
            Whether the app was stopped, and has resumed.
        """
        self.suspend_application_mode()
        self._must_signal_resume = True
        handler = signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(0, signal.SIGTSTP)
        signal.signal(signal.SIGTSTP, handler)
        # Whoever resumes the app has restored the terminal by then.
        stopped = not self._must_signal_resume
        if not stopped:
            self.resume_application_mode()
        return stopped

    def _sigcont_application(self, *_: object) -> None:
        # The signal also arrives when the terminal is lost, so that nothing can resume, and after a stop without
        # preparation, where the former reader and writer must end before they are started again.
        if not self._auto_restart or not os.isatty(self.fileno):
            return
        if self._writer_thread is not None and self._writer_thread.is_alive():
            self.suspend_application_mode()
            self._must_signal_resume = True
        self.resume_application_mode()
