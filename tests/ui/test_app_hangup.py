"""A terminal that goes away, as at the end of a lost connection, takes the app and its program with it."""

from __future__ import annotations

import errno
import io
import os
import pty
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from threading import Thread
from typing import TextIO, cast

import pytest
from textual.drivers._writer_thread import MAX_QUEUED_WRITES, WriterThread

from tests.ui.terminals import PATIENCE_S
from tuisim.ui.driver import Outlasting

ENTER = "import fcntl, os, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); os.execv(sys.executable, sys.argv[1:])"
"""Makes the standard input the terminal that can hang up, and becomes the app."""

pytestmark = [pytest.mark.usefixtures("home")]


def wait(condition: Callable[[], bool]) -> None:
    give_up = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < give_up
        time.sleep(0.02)


def children(process: int) -> list[int]:
    listed = subprocess.run(["ps", "-o", "pid=", "--ppid", str(process)], capture_output=True, text=True, check=False)
    return [int(pid) for pid in listed.stdout.split()]


def alive(process: int) -> bool:
    return subprocess.run(["ps", "-p", str(process)], capture_output=True, check=False).returncode == 0


class Broken(io.StringIO):
    """The output to a terminal that is gone."""

    def write(self, text: str) -> int:
        raise OSError(errno.EIO, "Input/output error")


def test_more_than_the_queue_holds_is_written_to_a_terminal_that_is_gone() -> None:
    writer = WriterThread(cast(TextIO, Outlasting(Broken())))

    def leave() -> None:
        for _ in range(2 * MAX_QUEUED_WRITES):
            writer.write("x")
        writer.stop()

    writer.start()
    leaving = Thread(target=leave, daemon=True)
    leaving.start()
    leaving.join(PATIENCE_S)
    assert not leaving.is_alive()
    assert not writer.is_alive()


def test_a_lost_terminal_ends_the_app_and_its_program(tmp_path: Path, root: Path) -> None:
    (tmp_path / "spin.py").write_text("tank_drive.on(20, 30)\nwhile True:\n    pass\n")
    outer, inner = pty.openpty()
    words = [sys.executable, "-m", "tuisim", "spin.py", "-R"]
    environment = {**os.environ, "TERM": "xterm-256color", "PYTHONPATH": str(root), "COLUMNS": "120", "LINES": "40"}
    app = subprocess.Popen(
        [sys.executable, "-c", ENTER, *words],
        stdin=inner, stdout=inner, stderr=inner, cwd=tmp_path, env=environment, start_new_session=True,
    )  # fmt: skip
    os.close(inner)
    try:
        shown = b""
        while b"running" not in shown:
            shown += os.read(outer, 65536)
        program = children(app.pid)
        assert program
        # With keys on their way it has the more to draw when nobody takes it any more.
        os.write(outer, b"cCpP\x1bxX")
    finally:
        os.close(outer)
        try:
            assert app.wait(PATIENCE_S) == 129
        finally:
            app.kill()
    wait(lambda: not any(alive(process) for process in program))
