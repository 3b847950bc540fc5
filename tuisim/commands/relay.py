"""Relays the output of one headless run; stops it on ctrl-C."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Callable, Iterable
from itertools import groupby
from types import FrameType
from typing import TextIO

from tuisim.base.data_class import dataclass
from tuisim.base.errors import EXIT_BROKEN_PIPE, SIGNALLED
from tuisim.commands.echo import echo_error, hide_progress, tell
from tuisim.engine.protocol import Ended, Message
from tuisim.engine.runs.handle import RunHandle
from tuisim.engine.runs.records import OutputRow, Stream

POLL_S = 0.05
"""The interval at which printed lines are relayed."""
_RESET = "\x1bc"
"""Clears the brick's display, with which many programs begin; a user's terminal would lose what it shows."""


class RelayInterrupts:
    """Handles ctrl-C and SIGTERM, from the start of the first run until all exports are written.

    The first signal stops the current run, and no further run is started; logged data is still exported.
    A second signal ends the command immediately.
    """

    def __init__(self) -> None:
        self.exit_code = 0
        """128 + the number of the signal that has arrived; 0 while none has."""
        self._handle: RunHandle | None = None

    def watch(self, handle: RunHandle) -> None:
        """From now on, stop this run when a signal comes; stop it immediately if a signal has come already."""
        self._handle = handle
        if self.exit_code:
            handle.stop()

    def handle(self, number: int, frame: FrameType | None) -> None:
        """Handle a signal: stop the run.

        Raises:
            KeyboardInterrupt: this is the second signal.
        """
        if self.exit_code:
            if self._handle is not None and self._handle.ended is None:
                self._handle.kill()
            raise KeyboardInterrupt
        self.exit_code = SIGNALLED + number
        if self._handle is not None:
            self._handle.stop()
            if self._handle.ended is not None:
                tell("still writing; ctrl-C again cancels it")


@dataclass(slots=True)
class Follower:
    """Writes the output of one run to stdout and stderr until the run ends."""

    handle: RunHandle
    out: TextIO
    """Where its printed lines go; error text and speech go to stderr."""
    listen: Callable[[Message], None] | None = None
    """Called with each event of the run, after the output before it has been written."""
    tell: Callable[[RunHandle], None] = lambda _: None
    """Called at each poll, to show progress."""
    cut: int = 0
    """The exit code `EXIT_BROKEN_PIPE` once stdout is found closed, else 0."""
    lost: str = ""
    """Why printed lines could not be written; empty if they were."""

    def follow_to_end(self) -> Ended:
        """Block until the run has ended, and return its end."""
        while True:
            events: list[Message] = []
            if self.listen is None:
                ended = self.handle.wait(POLL_S)
            else:
                self.handle.wait_for_event(POLL_S)
                events = self.handle.pump()
                ended = self.handle.ended
            self._write_rows(self.handle.output.read_new_rows())
            self.tell(self.handle)
            for event in events:
                if self.listen is not None:
                    self.listen(event)
            if ended:
                return ended

    def _write_rows(self, rows: Iterable[OutputRow]) -> None:
        """Write rows of output to stdout and stderr in their original order."""
        for to_stdout, group in groupby(rows, key=lambda row: row.stream == Stream.STDOUT):
            if to_stdout:
                with hide_progress(self.out):
                    self._write("".join(row.text + "\n" for row in group))
                continue
            for row in group:
                # Printed text is passed on unchanged; speech becomes a line of tuisim's own.
                if row.stream == Stream.STDERR:
                    with hide_progress(sys.stderr):
                        sys.stderr.write(row.text + "\n")
                elif row.stream == Stream.SPEECH:
                    echo_error(row.format_line())

    def _write(self, text: str) -> None:
        if self.cut or self.lost:
            return
        try:
            self.out.write(text.replace(_RESET, "") if self.out.isatty() else text)
            self.out.flush()
        except BrokenPipeError:
            self.cut = EXIT_BROKEN_PIPE
            self.handle.stop()
        except OSError as error:
            # The run goes on, since the recording has all lines.
            self.lost = f"cannot write to stdout: {error.strerror or error}"


def is_piped() -> bool:
    """Return whether stdin is a pipe or a file: its lines then answer `input()`."""
    try:
        mode = os.fstat(sys.stdin.fileno()).st_mode
    except (AttributeError, OSError, ValueError):
        # stdin is closed, or an object without a file descriptor.
        return False
    return stat.S_ISFIFO(mode) or stat.S_ISREG(mode)


def read_answer() -> str | None:
    """Return the next line of stdin, without its end; None after the last one."""
    line = sys.stdin.readline()
    return line.rstrip("\r\n") if line else None
