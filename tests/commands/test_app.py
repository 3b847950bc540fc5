"""The command at a terminal: the app is drawn there, wherever stderr goes."""

from __future__ import annotations

import fcntl
import os
import pty
import select
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.running import PATIENCE_S


class Screen:
    """A terminal of 120 × 40, without anybody who would draw it."""

    def __init__(self) -> None:
        self._master, self.slave = pty.openpty()
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
        self.seen = b""

    def until(self, text: bytes) -> None:
        """Read until something has been drawn."""
        give_up = time.monotonic() + PATIENCE_S
        while text not in self.seen:
            assert time.monotonic() < give_up, self.seen[-2000:]
            if select.select([self._master], [], [], 0.1)[0]:
                self.seen += os.read(self._master, 65536)

    def press(self, key: bytes) -> None:
        os.write(self._master, key)

    def drain_until_gone(self, process: subprocess.Popen[bytes]) -> int:
        """Read on, so that the app is not held up by a full terminal, until it has ended."""
        give_up = time.monotonic() + PATIENCE_S
        while process.poll() is None:
            assert time.monotonic() < give_up
            if select.select([self._master], [], [], 0.05)[0]:
                self.seen += os.read(self._master, 65536)
        return process.returncode

    def close(self) -> None:
        os.close(self._master)
        os.close(self.slave)


@pytest.fixture
def screen() -> Iterator[Screen]:
    made = Screen()
    yield made
    made.close()


def start(
    screen: Screen, folder: Path, *words: str, stdin: int | None = None
) -> subprocess.Popen[bytes]:
    with (folder / "errors").open("wb") as errors:
        return subprocess.Popen(
            [sys.executable, "-m", "tuisim", *words],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(ROOT), "TERM": "xterm-256color"},
            stdin=screen.slave if stdin is None else stdin,
            stdout=screen.slave,
            stderr=errors,
            start_new_session=True,
        )


@pytest.mark.slow
def test_app_is_drawn_on_stdout_and_q_leaves_it(screen: Screen, tmp_path: Path) -> None:
    app = start(screen, tmp_path, "log_greys", "-W")
    screen.until(b"Instrumentation")
    screen.press(b"q")
    code = screen.drain_until_gone(app)
    assert (code, (tmp_path / "errors").read_bytes()) == (0, b"")


def test_app_without_a_keyboard_says_so(screen: Screen, tmp_path: Path) -> None:
    app = start(screen, tmp_path, "log_greys", stdin=subprocess.DEVNULL)
    assert screen.drain_until_gone(app) == 2
    assert (tmp_path / "errors").read_text().startswith("tuisim: the app needs a terminal")
    assert screen.seen == b""
