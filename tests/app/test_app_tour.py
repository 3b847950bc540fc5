"""README's tour, typed key by key at 80 × 24 on a slow machine."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from tests.app.terminals import SLOWLY, Terminal
from tests.conftest import ROOT

pytestmark = [pytest.mark.tmux, pytest.mark.slow]

README = (ROOT / "README.md").read_text(encoding="utf-8")
TOUR = README.partition("## A tour")[2].partition("\n## ")[0]
ROWS = re.findall(r"^\| ([^|]*[`a][^|]*) \| (.*) \|$", TOUR, re.MULTILINE)
_POSITION = r" x +(-?\d+)"
_TMUX = {"space": "Space", "end": "End", "escape": "Escape", "then": ""}


def ends(word: str) -> Callable[[str], bool]:
    return lambda text: word in text.splitlines()[-1]


def shows(*words: str) -> Callable[[str], bool]:
    return lambda text: all(word in text for word in words)


SEEN: dict[str, Callable[[str], bool]] = {
    "R": ends("running"),
    "space": lambda text: ends("paused")(text) or ends("running")(text) or ends("finished")(text),
    ",": ends("past"),
    "<": ends("past"),
    "end": lambda text: not ends("past")(text),
    "n": shows("D Code: my_program.py", "G Debug", "▶ "),
    "c": shows("c Chart"),
    "b": shows("white", "grey"),
    "q": shows("W World"),
    "d": ends("esc done"),
    "escape": lambda text: not ends("esc done")(text),
}
"""What is on the screen after a key."""


def keys_of(row: tuple[str, str]) -> Iterator[str]:
    """The keys of one row: those to press, and those that the explanation names."""
    pressed, does = row
    yield from ["Right"] if pressed == "arrows" else re.findall(r"`([^`]+)`", pressed)
    yield from re.findall(r"`([^`]+)`", does)


def x_mm(text: str) -> float:
    found = re.search(_POSITION, text)
    assert found, text
    return float(found[1])


def _is_at(wanted_mm: float, text: str) -> bool:
    return abs(x_mm(text) - wanted_mm) < 0.1


def test_the_tour_can_be_typed(terminal: Terminal, tmp_path: Path) -> None:
    program = re.search(r"```python\n(.*?)```", TOUR, re.DOTALL)
    assert program
    assert [row[0] for row in ROWS][-2:] == ["`d`", "arrows"]
    (tmp_path / "my_program.py").write_text(program[1])
    terminal.start(["my_program.py"], 80, 24, code=SLOWLY)
    terminal.until(shows("W World", "R run"))
    for row in ROWS:
        if row[0] == "arrows":
            # Without code, chart and debugger there is room for the position among the readings.
            # The first press of a key focuses the panel.
            terminal.keys("D", "D", "c", "c", "G", "G")
            terminal.until(
                lambda text: (
                    not re.search("D Code|c Chart|G Debug", text)
                    and re.search(_POSITION, text) is not None
                )
            )
        before = terminal.screen()
        for key in keys_of(row):
            terminal.keys(_TMUX.get(key, key))
            if key in SEEN:
                terminal.until(SEEN[key])
        if row[0] == "`n`":
            terminal.until(ends("finished"))
        if row[0] == "`d`":
            # Once more, as it says: this leaves the code.
            terminal.keys("Escape")
            terminal.until(ends("export"))
        if row[0] == "arrows":
            terminal.until(partial(_is_at, x_mm(before) + 10))
    terminal.keys("q")
    terminal.until(shows("EXIT 0"))
