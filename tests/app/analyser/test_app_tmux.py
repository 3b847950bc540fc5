"""The course's question, answered by keys alone in a real terminal."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.app.terminals import Terminal
from tuisim.analysis.source import read_notes

pytestmark = [pytest.mark.tmux, pytest.mark.slow]


def test_from_a_run_to_the_bands_to_a_note(terminal: Terminal, home: Path) -> None:
    terminal.start(["log_greys", "--speed", "16"], 120, 40)
    terminal.until(lambda text: "R run" in text.splitlines()[-1])
    terminal.keys("R")
    terminal.until(lambda text: "finished" in text.splitlines()[-1])
    terminal.keys("l")
    terminal.until(lambda text: "[x] Colour" in text and "b bands" in text.splitlines()[-1])
    terminal.keys("b")
    levels = (
        "100.00  white",
        "86.27  pale grey",
        "82.75  light grey",
        "50.20  grey",
        "0.00  black",
    )
    terminal.until(lambda text: all(words in text for words in ("5 levels", *levels)))
    terminal.keys("Down", "m")
    terminal.until(lambda text: "Note on Colour" in text)
    terminal.keys("Enter")
    terminal.until(lambda text: "Note saved" in text)
    terminal.keys("n")
    terminal.until(lambda text: "[Notes]" in text and "band 2: 86.27 pale grey" in text)
    (notes,) = home.rglob("notes.jsonl")
    assert [note.text for note in read_notes(notes)] == ["band 2: 86.27 pale grey"]
    terminal.keys("q")
    terminal.until(lambda text: "finished" in text.splitlines()[-1])
    terminal.keys("q")
    terminal.until(lambda text: "EXIT 0" in text)


def test_what_cannot_be_opened_is_said_in_the_shell(terminal: Terminal) -> None:
    terminal.start(["analyse", "none.csv"], 80, 24)
    text = terminal.until(lambda text: "EXIT" in text)
    assert "none.csv: no such file" in text
    assert "EXIT 2" in text
