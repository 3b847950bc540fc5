"""The terminal of an app: lent to other programs, asked what it can do, and survived if it is lost."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from encodings import utf_8
from pathlib import Path
from typing import TextIO

from textual.app import App

from tuisim.terminal import kitty
from tuisim.terminal.picture_mode import find_picture_mode
from tuisim.terminal.picture_options import Protocol
from tuisim.terminal.probe import SILENT, take_typed
from tuisim.terminal.queries import QUESTIONS, AnswerParser
from tuisim.terminal.textual_internals import (
    HookedLinuxDriver,
    find_app,
    is_leaving,
    set_input_parser,
)

SIGNALLED = 128
"""The exit code of a program that a signal has ended is this plus the number of the signal, as in a shell."""
_LOST = SIGNALLED + signal.SIGHUP
"""The exit code of an app whose terminal is gone, as if the shell had sent SIGHUP."""


class ResilientOutput:
    """The output to a terminal; once the terminal is lost, for example with its connection, all output is dropped.

    Textual writes from a thread of its own. Without this class, that thread would end at the first failed write. The
    app has to write a little more before it can shut down, and would wait for the ended thread for ever.

    Args:
        file: The output.
    """

    def __init__(self, file: TextIO) -> None:
        self._file = file
        self.gone = False
        """Whether a write to the terminal has failed; later output is dropped."""

    def write(self, text: str) -> int:
        """Write a text, and return its length; if the terminal is lost, drop the text."""
        if not self.gone:
            try:
                self._file.write(text)
            except OSError:
                self._lose()
        return len(text)

    def flush(self) -> None:
        """Flush the output, unless the terminal is lost."""
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
        """Return the file descriptor of the output."""
        return self._file.fileno()


class InputDecoder(utf_8.IncrementalDecoder):
    """Decodes the bytes from the terminal; bytes that are not UTF-8, as from a bad line, do not end the app."""

    def __init__(self) -> None:
        super().__init__("replace")

    def decode(self, data: bytes, final: bool = False) -> str:  # type: ignore[override]
        """Return the characters of which all bytes have arrived.

        Raises:
            EOFError: the terminal is lost, so that no more bytes will come.
        """
        if not data and not final and not sys.stdin.isatty():
            raise EOFError
        return super().decode(data, final)


def run_in_foreground(command: Sequence[str]) -> None:
    """Run a program in this terminal, and wait until it ends.

    Raises:
        OSError: the program cannot start.
    """
    program = subprocess.Popen(command)
    # The keys that interrupt the program also send a signal to this process, which ignores it meanwhile.
    handlers = {
        number: signal.signal(number, signal.SIG_IGN) for number in (signal.SIGINT, signal.SIGQUIT)
    }
    try:
        program.wait()
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)


class TerminalDriver(HookedLinuxDriver):
    """Textual's driver of a terminal; it also survives the loss of the terminal, and asks what the terminal can do."""

    def __init__(
        self,
        app: App[object],
        *,
        debug: bool = False,
        mouse: bool = True,
        size: tuple[int, int] | None = None,
    ) -> None:
        super().__init__(app, debug=debug, mouse=mouse, size=size)
        self.wrap_output(ResilientOutput)
        self._is_lent = False
        """Whether the shell or another program has the terminal now."""
        self._was_continued = False
        """Whether the process has been continued since it was last stopped."""

    def run_input_thread(self) -> None:
        """Read the user's input until the app ends; if the terminal is lost, end the app."""
        try:
            for message in AnswerParser().feed(take_typed()):
                self.process_message(message)
            super().run_input_thread()
        except (EOFError, OSError):
            # Not every shell sends a signal to its jobs when the terminal is gone, so the app is ended here.
            find_app(self).call_later(find_app(self).exit, return_code=_LOST)

    def start_application_mode(self) -> None:
        """Begin to draw on the terminal, and query its abilities."""
        super().start_application_mode()  # type: ignore[no-untyped-call]
        if os.environ.get("TERM", "") not in SILENT:
            self.write(QUESTIONS)
            self.flush()

    def stop_application_mode(self) -> None:
        """Restore the terminal, and delete the images that it has stored for the app."""
        graphics = find_picture_mode(find_app(self)).graphics
        if graphics is not None and graphics.protocol is Protocol.KITTY:
            self.write(kitty.wrap_tmux(kitty.DELETE_ALL) if graphics.in_tmux else kitty.DELETE_ALL)
        super().stop_application_mode()

    @contextmanager
    def lend(self) -> Iterator[None]:
        """In a `with` block, leave the terminal to the shell or to another program, and take it back at the end."""
        # If this process is stopped and continued meanwhile, it must not take the terminal back too early.
        self._is_lent = True
        self.suspend_application_mode()
        handler = signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        try:
            yield
        finally:
            signal.signal(signal.SIGTSTP, handler)
            self._is_lent = False
            if os.isatty(self.fileno):
                self.resume()
            else:
                # The terminal was lost meanwhile, and no thread reads from it that would notice.
                find_app(self).exit(return_code=_LOST)

    def stop_as_job(self) -> bool:
        """Restore the terminal, and stop the process group of the app until the shell resumes it.

        The signal is SIGTSTP, which the system drops if no shell could resume the app. Textual sends SIGSTOP, which
        would stop the app for ever in that case.

        Returns:
            Whether the app was stopped, and has resumed.
        """
        with self.lend():
            self._was_continued = False
            os.kill(0, signal.SIGTSTP)
            return self._was_continued

    def handle_continuation(self) -> None:
        """Take the terminal back after the process was stopped; called by the handler of the signal.

        While another program uses the terminal, only record that the process was continued.
        """
        if self._is_lent:
            self._was_continued = True
        elif self.resumes:
            # The signal may come while the app holds the lock of its output, which is not to be taken twice.
            self.call_soon(self._take_terminal_again)

    def _take_terminal_again(self) -> None:
        # The signal also arrives when the terminal is lost, so that nothing can resume, and after a stop without
        # preparation, where the former reader and writer must end before they are started again.
        if is_leaving(find_app(self)) or not self.resumes or not os.isatty(self.fileno):
            return
        if self.writes:
            self.suspend_application_mode()
            self.resume()
        else:
            self.resume_application_mode()


set_input_parser(AnswerParser, InputDecoder)
