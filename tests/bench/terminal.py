"""The app in a pseudo-terminal that answers like a real one."""

from __future__ import annotations

import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Self

from tests.bench.processes import app_environment

COLUMNS = 120
ROWS = 40
CURSOR_QUERY, CURSOR_ANSWER = b"\x1b[6n", f"\x1b[{ROWS};{COLUMNS}R".encode()
PATIENCE_S = 30.0


class Terminal:
    """A terminal with the app in it, 120×40, xterm with 256 colours as over SSH.

    Args:
        words: The command line of the app.
        command: What is started with them, if it is not the app.
        environment: What it is started in, if that is not the app's environment.
        variables: More of that, such as COLORTERM.
    """

    def __init__(
        self,
        words: Sequence[str],
        command: Sequence[str] = (sys.executable, "-m", "tuisim"),
        environment: Mapping[str, str] | None = None,
        **variables: str,
    ) -> None:
        self._fd, inside = pty.openpty()
        fcntl.ioctl(inside, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        self._process = subprocess.Popen(
            [*command, *words],
            stdin=inside,
            stdout=inside,
            stderr=inside,
            env={
                **(app_environment() if environment is None else environment),
                "TERM": "xterm-256color",
                "LANG": "C.UTF-8",
                **variables,
            },
            start_new_session=True,
        )
        os.close(inside)
        self.pid = self._process.pid
        self.seen = bytearray()
        """Everything that the app has written."""
        self.arrivals: list[tuple[float, int]] = []
        """When something arrived, on the monotonic clock, and the length of `seen` with it."""
        self.queries = 0
        """How often the app has asked for the cursor position, which it does after each frame."""
        self.shown = 0
        """How many bytes of `seen` belong to whole frames."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        os.killpg(self.pid, signal.SIGKILL)
        self._process.wait()
        os.close(self._fd)

    def type(self, keys: bytes) -> None:
        """Send what keys send."""
        os.write(self._fd, keys)

    def read_until(self, condition: Callable[[], bool], patience_s: float = PATIENCE_S) -> None:
        """Take what the app writes, and answer it, until something is so.

        Raises:
            AssertionError: it was not so in time, or the app has ended.
        """
        give_up = time.monotonic() + patience_s
        while not condition():
            left = give_up - time.monotonic()
            assert left > 0, f"the app did not show what was awaited: {bytes(self.seen[-500:])!r}"
            self._read(min(left, 0.05))

    def read_for(self, seconds: float) -> None:
        """Take what the app writes, and answer it, for a time."""
        until = time.monotonic() + seconds
        self.read_until(lambda: time.monotonic() >= until, seconds + PATIENCE_S)

    def _read(self, wait_s: float) -> None:
        if not select.select([self._fd], [], [], wait_s)[0]:
            return
        try:
            data = os.read(self._fd, 65536)
        except OSError:
            # What a pseudo-terminal says when nobody has it open any more.
            data = b""
        assert data, f"the app has ended: {bytes(self.seen[-500:])!r}"
        self.seen += data
        self.arrivals.append((time.monotonic(), len(self.seen)))
        while (at := self.seen.find(CURSOR_QUERY, self.shown)) >= 0:
            self.shown = at + len(CURSOR_QUERY)
            self.queries += 1
            os.write(self._fd, CURSOR_ANSWER)
