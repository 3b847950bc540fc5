"""Which glyphs a terminal is known to show, and what of that is asked."""

from __future__ import annotations

import os
import pty
import sys
import threading
from collections.abc import Mapping

import pytest

from tests.cases import cases, for_rows
from tests.running import PATIENCE_S
from tuisim.terminal import probe
from tuisim.terminal.picture_options import CellSet
from tuisim.terminal.probe import choose_cells, find_cells, read_cells

ATTRIBUTES = b"\x1b[?62;4c"


@for_rows(
    "name, octant_cols, cells",
    {
        "kitty": ("kitty(0.42.1)", 1, CellSet.OCTANT),
        "an older kitty": ("kitty(0.26.5)", 1, CellSet.SEXTANT),
        "foot": ("foot(1.22.0)", 1, CellSet.OCTANT),
        "an older foot": ("foot(1.13.1)", 1, CellSet.SEXTANT),
        "ghostty": ("ghostty 1.2.3", 1, CellSet.OCTANT),
        "WezTerm": ("WezTerm 20240203-110809-5046fc22", 1, CellSet.SEXTANT),
        "a very old WezTerm": ("WezTerm 20200101-1", 1, CellSet.QUADRANT),
        "VTE": ("VTE(7000)", 1, CellSet.SEXTANT),
        "xterm draws with its font": ("XTerm(379)", 1, CellSet.QUADRANT),
        "tmux that does not tell what is around it": ("tmux 3.5a", 1, CellSet.QUADRANT),
        "octants are dropped on the way": ("kitty(0.42.1)", 0, CellSet.QUADRANT),
        "no position": ("kitty(0.42.1)", None, CellSet.QUADRANT),
        "no version": ("kitty", 1, CellSet.QUADRANT),
        "no name": ("", 1, CellSet.QUADRANT),
    },
)
def test_fine_glyphs_are_chosen_only_for_terminals_that_draw_them(
    name: str, octant_cols: int | None, cells: CellSet
) -> None:
    assert find_cells(name, octant_cols) is cells


@for_rows(
    "environment, cells",
    {
        "dumb": ({"TERM": "dumb", "LANG": "en_GB.UTF-8"}, CellSet.ASCII),
        "no TERM": ({"LANG": "en_GB.UTF-8"}, CellSet.ASCII),
        "C": ({"TERM": "xterm", "LANG": "C"}, CellSet.ASCII),
        "POSIX": ({"TERM": "xterm", "LANG": "POSIX"}, CellSet.ASCII),
        "Latin 1": ({"TERM": "xterm", "LANG": "de_DE.ISO-8859-1"}, CellSet.ASCII),
        "LC_ALL wins": ({"TERM": "xterm", "LANG": "de_DE.UTF-8", "LC_ALL": "C"}, CellSet.ASCII),
        "the Linux console": ({"TERM": "linux", "LANG": "C.UTF-8"}, CellSet.HALF),
        "UTF-8": ({"TERM": "xterm", "LANG": "C.utf8"}, None),
        "no locale, as in a container": ({"TERM": "xterm"}, None),
    },
)
def test_the_environment_decides_which_glyphs_are_used(
    environment: Mapping[str, str], cells: CellSet | None
) -> None:
    assert read_cells(environment) is cells


class Answers:
    """A terminal that gives some answers, each to the question that ends with its key."""

    def __init__(self, answers: Mapping[bytes, bytes]) -> None:
        self.answers = answers
        self.outside, self.inside = pty.openpty()
        self.seen = b""
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self) -> None:
        try:
            while data := os.read(self.outside, 1024):
                self.seen += data
                for question, answer in self.answers.items():
                    if data.endswith(question):
                        os.write(self.outside, answer)
        except OSError:
            pass

    def close(self) -> None:
        os.close(self.inside)
        self.reader.join(PATIENCE_S)
        os.close(self.outside)


@cases(
    "answers, cells, asks_name",
    {
        "kitty": (
            {b"[6n": b"\x1b[9;2R", b"[c": b"\x1bP>|kitty(0.42.1)\x1b\\" + ATTRIBUTES},
            CellSet.OCTANT,
            True,
        ),
        "no name": ({b"[6n": b"\x1b[9;2R", b"[c": ATTRIBUTES}, CellSet.QUADRANT, True),
        "tmux 3.3a drops it": ({b"[6n": b"\x1b[9;1R"}, CellSet.QUADRANT, False),
        "no answer at all": ({}, CellSet.QUADRANT, False),
    },
)
def test_the_set_of_glyphs_follows_the_terminals_answers(
    answers: Mapping[bytes, bytes], cells: CellSet, asks_name: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    terminal = Answers(answers)
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setattr(probe, "read_first_environment", lambda: {"LANG": "C.UTF-8"})
    monkeypatch.setattr(probe, "ANSWER_S", PATIENCE_S if answers else 0.1)
    with open(terminal.inside, "rb+", buffering=0, closefd=False) as tty:
        monkeypatch.setattr(sys, "stdin", tty)
        monkeypatch.setattr(sys, "stdout", tty)
        found = choose_cells()
    terminal.close()

    assert found is cells
    assert (b"\x1b[>0q" in terminal.seen) is asks_name
    # Nothing of the question stays on the screen.
    assert terminal.seen.rstrip(b"\x1b[>0qc").endswith(b"\r\x1b[K") or asks_name


def test_what_is_typed_while_the_terminal_is_asked_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Answers({b"[6n": b"R\x1b[9;2R", b"[c": b"\x7f" + ATTRIBUTES + b"\x1b[A"})
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setattr(probe, "read_first_environment", lambda: {"LANG": "C.UTF-8"})
    monkeypatch.setattr(probe, "ANSWER_S", PATIENCE_S)
    probe.take_typed()
    with open(terminal.inside, "rb+", buffering=0, closefd=False) as tty:
        monkeypatch.setattr(sys, "stdin", tty)
        monkeypatch.setattr(sys, "stdout", tty)
        choose_cells()
    terminal.close()
    assert probe.take_typed() == "R\x7f\x1b[A"
    assert probe.take_typed() == ""
