"""The log program taken apart in a real terminal: break, step, look, go back, branch, and run on."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.app.terminals import Terminal
from tuisim.protocol import SetNoise, UserAction
from tuisim.runs.store import RunStore

pytestmark = [pytest.mark.tmux]


def held_at(text: str) -> tuple[int, str, str]:
    """Line, time and `sensor_val` in the Debug panel; line 0 if it does not say."""
    where = re.search(r"line (\d+) · ([\d.]+) s · tick \d+( past)?", text)
    value = re.search(r"sensor_val +([\d.]+)", text)
    return (int(where[1]), where[2], value[1] if value else "") if where else (0, "", "")


_IS_BUSY = re.compile(r"tick \d+ …")


def press_and_wait(terminal: Terminal, key: str, times: int) -> list[tuple[int, str, str]]:
    """Press a key so many times, each time the program stands elsewhere; return where it stood."""
    return [held_after(terminal, key) for _ in range(times)]


def held_after(terminal: Terminal, key: str) -> tuple[int, str, str]:
    """Press a key and wait until the program stands at another line."""
    before = held_at(terminal.screen())[0]
    terminal.keys(key)
    return held_at(
        terminal.until(
            lambda text: held_at(text)[0] not in (0, before) and not _IS_BUSY.search(text)
        )
    )


def hold_at_line_15(terminal: Terminal) -> None:
    """Open the log program and let a breakpoint hold it."""
    terminal.start(["log_greys"], 120, 40)
    terminal.until(lambda text: "R run" in text and "idle" in text.splitlines()[-1])
    terminal.keys("T")
    terminal.until(lambda text: "Breakpoints" in text)
    terminal.keys("1", "5", "Enter")
    terminal.until(lambda text: "● line 15" in text)
    terminal.keys("Escape")
    terminal.until(lambda text: "Breakpoints" not in text)
    terminal.keys("R")
    terminal.until(lambda text: held_at(text) == (15, "0.12", "100.0"))


def branch_with_noise(terminal: Terminal) -> None:
    """From the instant that is looked at, go on with noise and without breakpoints, to the end."""
    terminal.keys("z")
    terminal.until(lambda text: "Light ◆" in text)
    terminal.keys("3", "0", "Enter")
    terminal.until(lambda text: "Branch from 0.67 s?" in text)
    terminal.keys("y")
    terminal.until(lambda text: "paused" in text.splitlines()[-1] and "Branch from" not in text)
    terminal.until(lambda text: held_at(text)[1] == "0.67" and "past" not in text)
    terminal.keys("T")
    terminal.until(lambda text: "Breakpoints" in text)
    terminal.keys("Home", "Delete")
    terminal.until(lambda text: "None yet" in text)
    terminal.keys("Escape")
    terminal.until(lambda text: "Breakpoints" not in text)
    terminal.keys("]", "]", "]", "space")
    terminal.until(lambda text: "finished" in text.splitlines()[-1])


@pytest.mark.slow
def test_the_log_program_taken_apart(terminal: Terminal, home: Path) -> None:
    hold_at_line_15(terminal)
    steps = press_and_wait(terminal, "n", 20)
    assert [line for line, _, _ in steps[:4]] == [12, 13, 14, 15]
    assert steps[-1][2].startswith("86.27")

    back = press_and_wait(terminal, "N", 10)
    assert [line for line, _, _ in back[:4]] == [14, 13, 12, 15]
    assert back[-1][2] == "100.0"

    # The first light grey has been printed once the program is some lines on.
    terminal.keys("End")
    terminal.until(lambda text: held_at(text) == steps[-1] and " past" not in text.splitlines()[-1])
    press_and_wait(terminal, "n", 6)
    terminal.keys("Home")
    terminal.until(lambda text: "past 0.00 s" in text)
    terminal.keys("g")
    terminal.until(lambda text: "Go to" in text)
    terminal._run("send-keys", "-l", "sample Colour < 90")
    terminal.keys("Enter")
    there = terminal.until(lambda text: "past 0.67 s" in text and held_at(text)[1] == "0.67")
    assert "86.27" in held_at(there)[2]

    branch_with_noise(terminal)
    terminal.keys("q")
    terminal.until(lambda text: "EXIT 0" in text)

    branch = RunStore(home).load_run("last")
    assert "branch-of-1" in branch.tags
    noise = [action for action in branch.actions if isinstance(action.command, SetNoise)]
    assert noise[0] == UserAction(67, SetNoise(30, 0))
    printed = [row.text for row in branch.output.rows() if row.text.startswith("Colour: ")]
    assert "Colour: 86.27450980392157" in printed
    assert len(set(printed)) > 12
