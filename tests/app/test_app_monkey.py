"""Thousands of keys, clicks and sizes at random: no error, no process left behind, and `q` always ends the app."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import pytest
from textual.app import App
from textual.pilot import Pilot

from tests.app.app_help import ENDLESS, LOGS, notices, settings, until
from tests.app.monkey import is_over, leave, press_at_random
from tests.running import PATIENCE_S
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import Analyser, AnalyserApp
from tuisim.app.app import LabApp
from tuisim.app.terminal_app import TerminalApp

PRESSES = 500
AT_ONE_GO = 250
"""How often something is pressed for one seed, and at most before the app is left and opened anew."""

pytestmark = pytest.mark.slow


@pytest.fixture(autouse=True)
def _notices_stay() -> None:
    """Let notices go away here: there would be hundreds."""


@pytest.fixture(autouse=True)
def _children_of_their_own(real_start: None) -> None:
    """Start children as users do: a server that forks them would stay, as a child of this process."""


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "work"
    folder.mkdir()
    monkeypatch.chdir(folder)
    Path("prog.py").write_text(LOGS)
    Path("log.txt").write_text("".join(f"Colour: {100 - at}\nLeft: {at}\n" for at in range(100)))


def lab(turn: int) -> TerminalApp:
    return LabApp(settings((ENDLESS, LOGS)[turn % 2], autorun=True))


def analyser(turn: int) -> TerminalApp:
    return AnalyserApp(LogRequest(file="log.txt"))


def is_open(app: App[Any]) -> bool:
    if isinstance(app, LabApp):
        return app.run_controller.mat is not None
    return isinstance(app.screen, Analyser) and app.screen.is_open


def children() -> set[str]:
    return {
        pid
        for listed in Path("/proc/self/task").glob("*/children")
        for pid in listed.read_text().split()
    }


def wait_for_children(before: set[str]) -> None:
    give_up = time.monotonic() + PATIENCE_S
    while left := children() - before:
        assert time.monotonic() < give_up, f"left behind: {left}"
        for pid in left:
            # One that has ended is only waited for when the next one is started.
            os.waitpid(int(pid), os.WNOHANG)
        time.sleep(0.05)


async def one_go(pilot: Pilot[Any], rng: Random, count: int, done: list[str]) -> None:
    try:
        await until(pilot, lambda: is_over(pilot) or is_open(pilot.app))
        async for what in press_at_random(pilot, rng, count):
            done.append(what)
        await leave(pilot)
    # Whatever it is, it helps to know what was pressed.
    except BaseException as error:
        told = notices(pilot.app)
        error.add_note(
            f"after {done}, with the notices {told} and the work {list(pilot.app.workers)}"
        )
        raise


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("make", [lab, analyser])
async def test_whatever_is_pressed_the_app_bears_it_and_can_be_left(
    make: Callable[[int], TerminalApp], seed: int
) -> None:
    rng = Random(seed)
    pressed = 0
    turn = 0
    before = children()
    while pressed < PRESSES:
        done: list[str] = []
        async with make(turn).run_test(size=(120, 40), notifications=True) as pilot:
            await one_go(pilot, rng, min(AT_ONE_GO, PRESSES - pressed), done)
        wait_for_children(before)
        pressed = pressed + len(done)
        turn = turn + 1
