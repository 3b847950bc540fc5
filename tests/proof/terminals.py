"""A terminal of its own with tuisim in it, as a job of a small shell; what it leaves behind there can be looked at."""

from __future__ import annotations

import fcntl
import json
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from tests.proof.kind import FaultError
from tests.running import PATIENCE_S

SHELL = """\
import fcntl, json, os, signal, sys, termios
said, heard, forwards, words = int(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]), sys.argv[4:]
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
for ignored in (signal.SIGTTOU, signal.SIGHUP):
    signal.signal(ignored, signal.SIG_IGN)
job = os.fork()
if not job:
    os.setpgid(0, 0)
    os.tcsetpgrp(0, os.getpid())
    for usual in (signal.SIGTTOU, signal.SIGHUP):
        signal.signal(usual, signal.SIG_DFL)
    os.execv(sys.executable, [sys.executable, *words])

def say(**what):
    os.write(said, json.dumps(what).encode() + b"\\n")

def give(group):
    try:
        os.tcsetpgrp(0, group)
    except OSError:
        pass

def hung_up(*_):
    os.killpg(job, signal.SIGHUP)

if forwards:
    signal.signal(signal.SIGHUP, hung_up)
say(job=job)
while True:
    status = os.waitpid(job, os.WUNTRACED)[1]
    give(os.getpgrp())
    if not os.WIFSTOPPED(status):
        break
    say(stopped=os.WSTOPSIG(status))
    os.read(heard, 1)
    give(job)
    os.killpg(job, signal.SIGCONT)
say(code=os.waitstatus_to_exitcode(status))
"""
"""The least of a shell: runs a job in the foreground, says when it stops or ends, and lets it go on at a word.

It forwards a hang-up to its job, as most shells do, or leaves the job to itself.
"""

_MODE = re.compile(rb"\x1b\[\?([\d;]+)([hl])")
_MOST_QUIETS = 20
"""How many times as long as the silence that is wanted something may come; then it draws without an end."""
_USUALLY_ON = {b"7", b"25"}
"""Modes of a terminal that are on before anything is set: lines wrap, the cursor is shown."""


def modes_left(written: bytes) -> list[str]:
    """Return the modes of a terminal that what was written leaves other than they were."""
    last = {mode: found[2] for found in _MODE.finditer(written) for mode in found[1].split(b";")}
    wrong = [
        f"?{mode.decode()}" for mode, at in last.items() if (at == b"h") != (mode in _USUALLY_ON)
    ]
    keyboard = len(re.findall(rb"\x1b\[>\d*u", written)) - len(re.findall(rb"\x1b\[<\d*u", written))
    return sorted(wrong) + ["keyboard protocol"] * (keyboard != 0)


class Terminal:
    """A terminal with one command in it.

    Args:
        words: The words after `tuisim`.
        folder: The working directory of the command.
        environment: Its environment.
        forwards: Whether its shell tells it that the terminal is lost.
    """

    def __init__(
        self, words: Sequence[str], folder: Path, environment: dict[str, str], forwards: bool = True
    ) -> None:
        self.outer, inner = pty.openpty()
        os.set_blocking(self.outer, False)
        self.before = termios.tcgetattr(inner)
        self._heard, said = os.pipe()
        heard, self._say = os.pipe()
        shell = [sys.executable, "-c", SHELL, str(said), str(heard), str(int(forwards))]
        command = [*shell, "-P", "-m", "tuisim", *words]
        self.resize(120, 40)
        self._shell = subprocess.Popen(
            command,
            stdin=inner,
            stdout=inner,
            stderr=inner,
            cwd=folder,
            env=environment,
            start_new_session=True,
            pass_fds=(said, heard),
        )
        for fd in (inner, said, heard):
            os.close(fd)
        self.written = b""
        """All that came from the command."""
        self.code: int | None = None
        """How the command ended."""
        self.job = 0
        self.is_stopped = False
        self._rest = b""
        self._open = [self.outer, self._heard]

    def take(self, quiet_s: float) -> None:
        """Take what comes until nothing comes for this long; of what never ends, take some."""
        give_up = time.monotonic() + _MOST_QUIETS * quiet_s
        while self._open:
            readable, _, _ = select.select(self._open, [], [], quiet_s)
            for fd in readable:
                try:
                    some = os.read(fd, 65536)
                except OSError:
                    some = b""
                if not some:
                    self._open.remove(fd)
                elif fd == self.outer:
                    self.written += some
                else:
                    self._take_words(some)
            if not readable or (quiet_s and time.monotonic() > give_up):
                break

    def _take_words(self, some: bytes) -> None:
        *lines, self._rest = (self._rest + some).split(b"\n")
        for line in lines:
            word = json.loads(line)
            self.job = word.get("job", self.job)
            self.code = word.get("code", self.code)
            self.is_stopped = self.is_stopped or "stopped" in word

    def until(self, ready: Callable[[], bool], what: str) -> None:
        """Take what comes until something is so."""
        give_up = time.monotonic() + PATIENCE_S
        while not ready():
            if time.monotonic() > give_up:
                raise FaultError(f"{what} never came; the last was {self.written[-600:]!r}")
            self.take(0.02)

    @property
    def is_over(self) -> bool:
        """Whether the command has ended."""
        return self.code is not None

    def write(self, some: bytes) -> None:
        """Type something, taking what comes while there is no room for it."""
        while some and not self.is_over:
            with suppress(BlockingIOError):
                some = some[os.write(self.outer, some[:256]) :]
            self.take(0)

    def resize(self, columns: int, rows: int) -> None:
        """Change the size; the system tells the command."""
        fcntl.ioctl(self.outer, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def signal(self, number: signal.Signals) -> None:
        """Send a signal to the command alone."""
        if not self.is_over:
            os.kill(self.job, number)

    def go_on(self) -> None:
        """Let a stopped command go on."""
        self.is_stopped = False
        os.write(self._say, b"\n")

    def lose(self) -> None:
        """Hang up."""
        os.close(self.outer)
        self._open.remove(self.outer)

    def check_restored(self) -> None:
        """Raise a fault if the terminal does not become as it was before."""
        give_up = time.monotonic() + PATIENCE_S
        # The system hands on what was written only when it finds the time.
        while left := modes_left(self.written):
            if time.monotonic() > give_up:
                raise FaultError(f"left on the terminal: {', '.join(left)}")
            self.take(0.02)
        if (now := termios.tcgetattr(self.outer)) != self.before:
            raise FaultError(f"the terminal was {self.before}, and is {now}")

    def close(self) -> None:
        """End what is still there."""
        for fd in (self.outer, self._heard, self._say):
            if fd not in (self.outer, self._heard) or fd in self._open:
                os.close(fd)
        if not self.is_over and self.job:
            os.kill(self.job, signal.SIGKILL)
        self._shell.kill()
        self._shell.wait()
