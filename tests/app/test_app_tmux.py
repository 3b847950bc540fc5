"""The app in a real terminal with a real child process."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.app.terminals import Terminal

pytestmark = [pytest.mark.tmux, pytest.mark.slow]


def test_a_key_draws_what_something_else_has_written_over(terminal: Terminal) -> None:
    terminal.start(["log_greys"], 120, 40)
    terminal.until(lambda text: "help" in text.splitlines()[-1])
    terminal.keys("?")
    terminal.until(lambda text: "R run" not in text.splitlines()[-1])

    def is_written_over(text: str) -> bool:
        if "Broken pipe" in text and not text.splitlines()[-1].strip():
            return True
        # The app may still draw what was opened.
        terminal.scribble("\033[2J\033[10;5HWrite failed: Broken pipe")
        return False

    terminal.until(is_written_over)
    terminal.keys("C-l")
    terminal.until(lambda text: "Broken pipe" not in text and "╭" in text)


UNTRIED = """
import runpy, sys, textual
textual.__file__ = sys.argv[1] + "/textual/__init__.py"
del sys.argv[1]
runpy.run_module("tuisim", run_name="__main__", alter_sys=True)
"""
"""The app with a Textual whose version cannot be told."""


def test_with_an_untried_textual_it_runs_without_private_names(
    terminal: Terminal, tmp_path: Path
) -> None:
    terminal.start([str(tmp_path), "log_greys"], 120, 40, code=UNTRIED)
    terminal.until(lambda text: "R run" in text.splitlines()[-1])
    terminal.keys("R")
    text = terminal.until(
        lambda text: "finished" in text.splitlines()[-1] and "Colour: 0.0" in text
    )
    assert "▀" in text
    terminal.keys("?")
    terminal.until(lambda text: "Guide" in text and "esc closes" in text)
    terminal.keys("Escape")
    terminal.until(lambda text: "Guide" not in text and "R run" in text.splitlines()[-1])
    terminal.keys("q")
    terminal.until(lambda text: "EXIT 0" in text)


def test_what_cannot_be_opened_is_said_in_the_shell(terminal: Terminal) -> None:
    terminal.start(["analyse", "none.csv"], 80, 24)
    text = terminal.until(lambda text: "EXIT 2" in text)
    assert "none.csv: no such file" in text
