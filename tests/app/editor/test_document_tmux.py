"""The editor in a real terminal: what was typed and not saved outlives a crash."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.app.terminals import Terminal
from tests.running import PATIENCE_S

pytestmark = [pytest.mark.tmux, pytest.mark.slow]


def kill_the_app(terminal: Terminal) -> None:
    """Kill the one child of the terminal's shell without a warning."""
    shell = terminal.shell_id()
    children = subprocess.run(
        ["ps", "-o", "pid=", "--ppid", str(shell)], capture_output=True, text=True, check=True
    )
    os.kill(int(children.stdout.split()[0]), signal.SIGKILL)


def test_unsaved_text_outlives_a_kill_and_is_saved_and_run(
    open_terminal: Callable[[], Terminal], home: Path, tmp_path: Path
) -> None:
    # One to crash in, one to come back in.
    terminal, again = open_terminal(), open_terminal()
    path = tmp_path / "prog.py"
    path.write_text("print('A: 1')\n")
    terminal.start(["prog.py"], 80, 24)
    terminal.until(lambda text: "d edit" in text.splitlines()[-1])
    terminal.keys("d")
    terminal.until(lambda text: "esc done" in text)
    terminal.keys("#", "h", "i", "Enter")
    terminal.until(lambda text: "prog.py • edited" in text)
    give_up = time.monotonic() + PATIENCE_S
    while not list((home / "drafts").glob("*.json")):
        assert time.monotonic() < give_up
        time.sleep(0.05)
    kill_the_app(terminal)
    terminal.until(lambda text: "EXIT 137" in text)
    assert path.read_text() == "print('A: 1')\n"
    again.start(["prog.py"], 80, 24)
    again.until(lambda text: "1 line differs" in text)
    again.keys("r")
    again.until(lambda text: "differs" not in text)
    again.keys("d")
    again.until(lambda text: "prog.py • edited" in text and "1 #hi" in text and "esc done" in text)
    again.keys("C-s")
    again.until(lambda text: "• edited" not in text)
    assert path.read_text() == "#hi\nprint('A: 1')\n"
    again.keys("C-r")
    # Typing ends as the program starts.
    again.until(lambda text: "finished" in text.splitlines()[-1] and "esc done" not in text)
    again.keys("q")
    again.until(lambda text: "EXIT 0" in text)
    assert not list((home / "drafts").glob("*.json"))
