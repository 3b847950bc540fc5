"""A real terminal to run the app in."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from tests.running import PATIENCE_S

SLOWLY = """
import runpy, time
from asyncio.base_events import BaseEventLoop as Loop
turn = Loop._run_once
Loop._run_once = lambda loop: (time.sleep(0.01), turn(loop))
runpy.run_module("tuisim", run_name="__main__", alter_sys=True)
"""
"""The app on a slow machine: each turn of its event loop takes 10 ms more."""


class Terminal:
    """A tmux session of its own with one program in it."""

    def __init__(self, name: str, folder: Path) -> None:
        self._tmux = ["tmux", "-L", name, "-f", "/dev/null"]
        self._folder = folder

    def start(self, arguments: list[str], columns: int, rows: int, *, code: str = "") -> None:
        """Start the app, or `code` in its place."""
        program = ["-c", code] if code else ["-m", "tuisim"]
        command = shlex.join([sys.executable, *program, *arguments])
        size = ["-x", str(columns), "-y", str(rows)]
        shell = f"{command}; echo EXIT $?; exec cat"
        # Where these two are set, they win over the size of the terminal.
        inherited = {
            name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES")
        }
        environment = {
            **inherited,
            "TERM": "xterm-256color",
            "LANG": "C.UTF-8",
            "PYTHONPATH": str(Path.cwd()),
        }
        self._run("new-session", "-d", *size, "-c", str(self._folder), shell, env=environment)

    def _run(self, *words: str, env: dict[str, str] | None = None) -> str:
        done = subprocess.run(
            [*self._tmux, *words], capture_output=True, text=True, check=True, env=env
        )
        return done.stdout

    def shell_id(self) -> int:
        """The process that the program is a child of."""
        return int(self._run("display-message", "-p", "#{pane_pid}"))

    def keys(self, *keys: str) -> None:
        for key in keys:
            self._run("send-keys", key)

    def scribble(self, text: str) -> None:
        """Write over the screen, as another program that has the same terminal."""
        Path(self._run("display-message", "-p", "#{pane_tty}").strip()).write_text(text)

    def resize(self, columns: int, rows: int) -> None:
        self._run("resize-window", "-x", str(columns), "-y", str(rows))

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
