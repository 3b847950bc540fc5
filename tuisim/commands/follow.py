"""Watches one headless run: passes on what it prints, answers its questions, stops it on ctrl-C."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import TextIO

from tuisim.commands.outcome import EXIT_BROKEN_PIPE, EXIT_INTERRUPTED, EXIT_LIMIT
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
            How it ended, and the exit code that an interruption or a closed stdout asks for, else 0.
        """
        while True:
            try:
                if ended := self._turn():
                    return ended, self._cut
            except KeyboardInterrupt:
                # The second ctrl-C does not wait for the program's own clearing up.
                (self._handle.kill if self._cut else self._handle.stop)()
                self._cut = EXIT_INTERRUPTED
            except BrokenPipeError:
                self._handle.stop()
                self._cut = EXIT_BROKEN_PIPE

    def _turn(self) -> Ended | None:
        ended = self._handle.wait(POLL_S)
        if self._cut != EXIT_BROKEN_PIPE:
            self._pass_on(self._handle.output.new_rows())
        if self._handle.waiting_for_input is not None:
            # Nobody is there to answer: the end of the input, as for a program whose stdin is empty.
            self._handle.send(Answer(None))
        if not (ended or self._cut) and self._handle.telemetry.count > self._last_tick + 1:
            self._handle.stop()
            self._cut = EXIT_LIMIT
        return ended

    def _pass_on(self, rows: Iterable[OutputRow]) -> None:
        out: list[str] = []
        for row in rows:
            match row.stream:
                case stream if stream == STDOUT:
                    out.append(row.text + "\n")
                case stream if stream == STDERR:
                    sys.stderr.write(row.text + "\n")
                case stream if stream == SPEECH:
                    sys.stderr.write(f"says: {row.text}\n")
        if out:
            self._out.write("".join(out))
            self._out.flush()
