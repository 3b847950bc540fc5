"""Asking what the columns of a foreign table mean."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import until
from tests.cases import cases
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import Analyser, AnalyserApp
from tuisim.app.analyser.columns import ColumnsDialog
from tuisim.logs.choices import ReadChoices
from tuisim.logs.reader import open_log


@pytest.fixture
def foreign(tmp_path: Path) -> Path:
    """A table whose names do not tell what is time."""
    path = tmp_path / "foreign.csv"
    path.write_text(
        "boot;id;light;far\n" + "".join(f"{20 * n};7;{n % 5};{300 + n}\n" for n in range(50))
    )
    return path


@cases(
    "text, sure",
    {
        "a column that rises": ("boot,light\n0,1\n20,2\n", False),
        "two columns of which none rises": ("b,light\n3,1\n2,2\n", False),
        "time by name": ("t_ms,light\n0,1\n20,2\n", True),
        "nothing to choose from": ("light\n3\n2\n", True),
        "a log of ours": ("time,variable,value\n0,A,1\n1,A,2\n", True),
        "beside names and values": ("boot,name,value\n0,A,1\n3,A,2\n", False),
        "names and values only": ("name,value\nA,1\nA,2\n", True),
        "printed lines": ("Colour: 3\nColour: 4\n", True),
    },
)
def test_what_is_doubtful(text: str, sure: bool, tmp_path: Path) -> None:
    path = tmp_path / ("log.txt" if ": " in text else "log.csv")
    path.write_text(text)
    assert open_log(path).layout.sure is sure


async def asked(pilot: Pilot[Any]) -> Analyser:
    await until(pilot, lambda: isinstance(pilot.app.screen, ColumnsDialog))
    screen = pilot.app.screen_stack[-2]
    assert isinstance(screen, Analyser)
    return screen


@pytest.mark.slow
async def test_a_doubtful_table_is_asked_about_and_drawn_as_told(foreign: Path) -> None:
    async with AnalyserApp(LogRequest(str(foreign))).run_test(size=(80, 24)) as pilot:
        screen = await asked(pilot)
        assert screen.is_open and screen.model.log.layout.unit_s == 1.0
        # The first column is time, in ms; the second is of no interest.
        await pilot.press("t", "u", "down", "space", "enter")
        await until(pilot, lambda: pilot.app.screen is screen)
        log = screen.model.log
        assert (log.layout.time, log.layout.values, log.layout.unit_s) == (
            "boot",
            ("light", "far"),
            1e-3,
        )
        assert log.series("far").time_s[-1] == pytest.approx(0.98)
        # Where no robot was, the log has all the room.
        assert not screen.world.display
        await pilot.press("C")
        await asked(pilot)
        await pilot.press("t", "down", "down", "space", "down", "space", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, ColumnsDialog), "nothing to draw"
        await pilot.press("up", "t", "down", "space", "enter")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert (screen.model.log.layout.time, screen.model.log.names) == ("light", ("far",))


@pytest.mark.parametrize("leave", ["escape", "enter"])
async def test_the_guess_may_stay(leave: str, foreign: Path) -> None:
    async with AnalyserApp(LogRequest(str(foreign))).run_test(size=(80, 24)) as pilot:
        screen = await asked(pilot)
        await pilot.press(leave)
        await until(pilot, lambda: pilot.app.screen is screen)
        assert screen.is_open and screen.model.log.names == ("boot", "id", "light", "far")


async def test_what_was_named_in_the_shell_is_not_asked_about(foreign: Path) -> None:
    wanted = LogRequest(str(foreign), choices=ReadChoices(time="boot", value=("light",), unit="ms"))
    async with AnalyserApp(wanted).run_test(size=(80, 24)) as pilot:
        await until(
            pilot, lambda: isinstance(pilot.app.screen, Analyser) and pilot.app.screen.is_open
        )
        screen = pilot.app.screen
        assert isinstance(screen, Analyser)
        assert screen.model.log.series("light").time_s[1] == pytest.approx(0.02)
