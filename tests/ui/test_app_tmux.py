"""The app in a real terminal with a real child process."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

pytestmark = [pytest.mark.tmux, pytest.mark.usefixtures("home")]

PATIENCE_S = 30.0


class Terminal:
    """A tmux session of its own with one program in it."""

    def __init__(self, name: str, folder: Path) -> None:
        self._tmux = ["tmux", "-L", name, "-f", "/dev/null"]
        self._folder = folder

    def start(self, arguments: list[str], columns: int, rows: int) -> None:
        command = shlex.join([sys.executable, "-m", "tuisim", *arguments])
        size = ["-x", str(columns), "-y", str(rows)]
        shell = f"{command}; echo EXIT $?; exec cat"
        # Where these two are set, they win over the size of the terminal.
        inherited = {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES")}
        environment = {**inherited, "TERM": "xterm-256color", "LANG": "C.UTF-8", "PYTHONPATH": str(Path.cwd())}
        self._run("new-session", "-d", *size, "-c", str(self._folder), shell, env=environment)

    def _run(self, *words: str, env: dict[str, str] | None = None) -> str:
        done = subprocess.run([*self._tmux, *words], capture_output=True, text=True, check=True, env=env)
        return done.stdout

    def keys(self, *keys: str) -> None:
        for key in keys:
            self._run("send-keys", key)

    def screen(self) -> str:
        return self._run("capture-pane", "-p")

    def until(self, condition: Callable[[str], bool]) -> str:
        """Look at the screen until something is on it."""
        give_up = time.monotonic() + PATIENCE_S
        while not condition(text := self.screen()):
            assert time.monotonic() < give_up, text
            time.sleep(0.05)
        return text

    def end(self) -> None:
        subprocess.run([*self._tmux, "kill-server"], capture_output=True, check=False)


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Terminal]:
    made = Terminal(f"tuisim-{os.getpid()}-{tmp_path.name[-20:]}", tmp_path)
    yield made
    made.end()


def test_a_program_runs_to_its_end_and_its_log_is_exported(terminal: Terminal, tmp_path: Path) -> None:
    terminal.start(["log_greys", "-R", "--speed", "4"], 120, 40)
    first = terminal.until(lambda text: "running" in text.splitlines()[-1])
    assert "World" in first
    assert "Ultrasonic" in first
    last = terminal.until(lambda text: "finished" in text.splitlines()[-1])
    assert "Colour: 0.0" in last
    terminal.keys("e")
    terminal.until(lambda text: "Export the log" in text)
    terminal.keys("Enter")
    terminal.until(lambda text: "The log is in log_greys.csv" in text)
    assert (tmp_path / "log_greys.csv").read_text().startswith("index,variable,value,time,run,")
    terminal.keys("q")
    terminal.until(lambda text: "EXIT 0" in text)


def test_stop_reaches_a_program_that_spins(terminal: Terminal, tmp_path: Path) -> None:
    (tmp_path / "spin.py").write_text("while True:\n    try:\n        pass\n    except:\n        pass\n")
    terminal.start(["spin.py", "-R"], 80, 24)
    terminal.until(lambda text: "running" in text.splitlines()[-1])
    terminal.keys("S")
    terminal.until(lambda text: "stopped" in text.splitlines()[-1])
    terminal.keys("q")
    terminal.until(lambda text: "EXIT 0" in text)


def test_capital_and_small_letters_are_different_keys(terminal: Terminal) -> None:
    terminal.start(["log_greys"], 120, 40)
    terminal.until(lambda text: "R run" in text.splitlines()[-1])
    terminal.keys("c")
    terminal.until(lambda text: "─ Chart" in text)
    terminal.keys("C", "p")
    terminal.until(lambda text: "─ Chart" in text and "pen down" in text)
    terminal.keys("P")
    terminal.until(lambda text: "─ Saved poses" in text)
    terminal.keys("Escape")
    terminal.until(lambda text: "─ Saved poses" not in text)
    terminal.keys("x", "X")
    # The panels are painted one after another.
    terminal.until(lambda text: "─ Positioning" in text and "pen down" in text)
