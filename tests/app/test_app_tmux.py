"""The app in a real terminal with a real child process."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.app.terminals import Terminal

pytestmark = [pytest.mark.tmux, pytest.mark.slow]


def test_a_program_runs_to_its_end_and_its_log_is_exported(
    terminal: Terminal, tmp_path: Path
) -> None:
    terminal.start(["log_greys", "-R"], 120, 40)
    # The panels are painted one after another.
    terminal.until(
        lambda text: "running" in text.splitlines()[-1] and "World" in text and "Ultrasonic" in text
    )
    terminal.until(lambda text: "finished" in text.splitlines()[-1] and "Colour: 0.0" in text)
    terminal.keys("e")
    terminal.until(lambda text: "Export the log" in text)
    terminal.keys("Enter")
    terminal.until(lambda text: "Log saved to log_greys.csv" in text)
    assert (tmp_path / "log_greys.csv").read_text().startswith("index,variable,value,time,run,")
    terminal.keys("q")
    terminal.until(lambda text: "EXIT 0" in text)


def test_stop_reaches_a_program_that_spins(terminal: Terminal, tmp_path: Path) -> None:
    (tmp_path / "spin.py").write_text(
        "while True:\n    try:\n        pass\n    except:\n        pass\n"
    )
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
    terminal.until(lambda text: "c Chart" in text)
    terminal.keys("C", "p")
    terminal.until(lambda text: "c Chart" in text and "pen down" in text)
    terminal.keys("P")
    terminal.until(lambda text: "─ Saved poses" in text)
    terminal.keys("Escape")
    terminal.until(lambda text: "─ Saved poses" not in text)
    terminal.keys("x", "X")
    # The panels are painted one after another.
    terminal.until(lambda text: "X Positioning" in text)


@pytest.mark.parametrize(
    "arguments, opened",
    [
        (["log_greys"], ()),
        (["log_greys"], ("question_mark",)),
        (["analyse", "some.csv"], ()),
        (["log_greys"], ("d",)),
    ],
    ids=["app", "dialog", "analyser", "editor"],
)
def test_a_key_draws_what_something_else_has_written_over(
    terminal: Terminal, tmp_path: Path, arguments: list[str], opened: tuple[str, ...]
) -> None:
    (tmp_path / "some.csv").write_text("time,red\n0,5\n1,6\n")
    terminal.start(arguments, 120, 40)
    terminal.until(lambda text: "help" in text.splitlines()[-1])
    for key in opened:
        terminal.keys("?" if key == "question_mark" else key)
    if opened:
        terminal.until(lambda text: "─ Help" in text or "R run" not in text.splitlines()[-1])

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
