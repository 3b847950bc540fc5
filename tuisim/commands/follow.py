"""Watches one headless run: passes on what it prints, stops it on ctrl-C."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import groupby
from types import FrameType
from typing import TextIO

from tuisim.commands.echo import echo_error
from tuisim.commands.outcome import EXIT_BROKEN_PIPE
from tuisim.datalog.records import SPEECH, STDERR, STDOUT, OutputRow, line_of
from tuisim.host import RunHandle
from tuisim.protocol import Ended, Message

POLL_S = 0.05
"""How long a printed line may wait before it is passed on."""


class Follower:
    """Follows one run.

    Args:
        handle: The run.
        out: Where its printed lines go; error text and speech go to stderr.
        listen: Called with each event of the run, after what was printed before it.
    """

    def __init__(self, handle: RunHandle, out: TextIO, listen: Callable[[Message], None] | None = None) -> None:
        self._listen = listen
        self._handle = handle
        self._out = out
        self._cut = 0
        self.lost = ""
        """Why printed lines could not be passed on, empty if they were."""

    def to_the_end(self) -> tuple[Ended, int]:
        """Wait until the run has ended.

        Returns:
            How it ended, and the exit code that an interruption or a closed stdout asks for, else 0.

        Raises:
            KeyboardInterrupt: a second signal came; the run has been killed.
        """
        with self._signals():
            while True:
                events: list[Message] = []
                if self._listen is None:
                    ended = self._handle.wait(POLL_S)
                else:
                    self._handle.wait_for_event(POLL_S)
                    events = self._handle.pump()
                    ended = self._handle.ended
                self._pass_on(self._handle.output.new_rows())
                for event in events:
                    if self._listen is not None:
                        self._listen(event)
                if ended:
                    return ended, self._cut

    @contextmanager
    def _signals(self) -> Iterator[None]:
        """Let ctrl-C and SIGTERM stop the run, and not strike in the middle of reading its messages."""
        before = {number: signal.signal(number, self._interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        if self._cut:
            self._handle.kill()
            raise KeyboardInterrupt
        # As a shell shows a program that the signal has ended.
        self._stop(128 + number)

    def _stop(self, exit_code: int) -> None:
        self._cut = exit_code
        self._handle.stop()

    def _pass_on(self, rows: Iterable[OutputRow]) -> None:
        """Write rows in the order in which they came, also where some go to stdout and some to stderr."""
        for to_stdout, group in groupby(rows, key=lambda row: row.stream == STDOUT):
            if to_stdout:
                self._write("".join(row.text + "\n" for row in group))
                continue
            for row in group:
                # What it prints is the program's affair, as in a shell; what it says stands in a line of ours.
                if row.stream == STDERR:
                    sys.stderr.write(row.text + "\n")
                elif row.stream == SPEECH:
                    echo_error(line_of(row))

    def _write(self, text: str) -> None:
        if self._cut == EXIT_BROKEN_PIPE or self.lost:
            return
        try:
            self._out.write(text)
            self._out.flush()
        except BrokenPipeError:
            self._stop(EXIT_BROKEN_PIPE)
        except OSError as error:
            # The run and its recording are worth more than its echo here.
            self.lost = f"cannot write to stdout: {error.strerror or error}"
