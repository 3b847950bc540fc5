"""Watches one headless run: passes on what it prints, answers its questions, stops it on ctrl-C."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TextIO

from tuisim.commands.outcome import EXIT_BROKEN_PIPE, EXIT_LIMIT
from tuisim.datalog.records import SPEECH, STDERR, STDOUT, OutputRow
from tuisim.host import RunHandle
from tuisim.protocol import Answer, Ended

POLL_S = 0.05
"""How long a printed line may wait before it is passed on."""


class Follower:
    """Follows one run.

    Args:
        handle: The run.
        out: Where its printed lines go; error text and speech go to stderr.
        time_limit_s: Simulated time after which it is stopped, also if it is paced and knows no limit itself.
    """

    def __init__(self, handle: RunHandle, out: TextIO, time_limit_s: float) -> None:
        self._handle = handle
        self._out = out
        self._last_tick = time_limit_s * handle.spec.profile.tick_hz
        self._cut = 0

    def to_the_end(self) -> tuple[Ended, int]:
        """Wait until the run has ended.

        Returns:
            How it ended, and the exit code that an interruption, a closed stdout or the time limit asks for, else 0.

        Raises:
            KeyboardInterrupt: a second signal came; the run has been killed.
        """
        with self._signals():
            while True:
                ended = self._handle.wait(POLL_S)
                self._pass_on(self._handle.output.new_rows())
                if ended:
                    return ended, self._cut
                self._attend()

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

    def _attend(self) -> None:
        if self._handle.waiting_for_input is not None:
            # Nobody is there to answer: the end of the input, as for a program whose stdin is empty.
            self._handle.send(Answer(None))
        if not self._cut and self._handle.telemetry.count > self._last_tick + 1:
            self._stop(EXIT_LIMIT)

    def _pass_on(self, rows: Iterable[OutputRow]) -> None:
        if self._cut == EXIT_BROKEN_PIPE:
            return
        out: list[str] = []
        for row in rows:
            if row.stream == STDOUT:
                out.append(row.text + "\n")
            elif row.stream == STDERR:
                sys.stderr.write(row.text + "\n")
            elif row.stream == SPEECH:
                sys.stderr.write(f"says: {row.text}\n")
        try:
            self._out.write("".join(out))
            self._out.flush()
        except BrokenPipeError:
            self._stop(EXIT_BROKEN_PIPE)
