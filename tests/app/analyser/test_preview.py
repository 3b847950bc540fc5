"""The dialog with the first rows of a file: each choice changes them, and opens the file so."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Select, Static

from tests.app.app_help import until
from tests.cases import cases
from tuisim.analysis.source import LogRequest, find_choices
from tuisim.app.analyser.app import Analyser, AnalyserApp
from tuisim.app.analyser.preview import PreviewDialog
from tuisim.logs.choices import NO_CHOICES, ReadChoices

FILES = {
    "header": "Lab 3\ntime;far\nseconds;metres\n" + "".join(f"{n};{300 + n}\n" for n in range(50)),
    "separator": "time;speed;burst\n" + "".join(f"{n};{5 * n};1,2,3,{n}\n" for n in range(50)),
    "decimal": "time,far\n" + "".join(f'{n},"{1 + n % 9},{100 + n}"\n' for n in range(50)),
    "time": "boot;id;light\n" + "".join(f"{20 * n};7;{n % 5}\n" for n in range(50)),
}
"""Each needs one choice."""


@asynccontextmanager
async def previewed(file: Path) -> AsyncIterator[tuple[Pilot[Any], PreviewDialog]]:
    """The analyser that shows how a file is read, before it opens."""
    async with AnalyserApp(LogRequest.restore(str(file))).run_test(size=(80, 24)) as pilot:
        await until(pilot, lambda: isinstance(pilot.app.screen, PreviewDialog))
        dialog = pilot.app.screen
        assert isinstance(dialog, PreviewDialog)
        await until(pilot, lambda: dialog.is_ready)
        assert not analyser(pilot).is_open
        yield pilot, dialog


async def open_again(file: Path) -> tuple[str, ...]:
    """Open a file that need not be asked about; return what is noted of it."""
    async with AnalyserApp(LogRequest.restore(str(file))).run_test(size=(80, 24)) as pilot:
        await until(pilot, lambda: analyser(pilot).is_open)
        return analyser(pilot).model.log.notes


def analyser(pilot: Pilot[Any]) -> Analyser:
    screen = next(one for one in pilot.app.screen_stack if isinstance(one, Analyser))
    return screen


def screen_text(pilot: Pilot[Any]) -> str:
    return "\n".join(line.text for line in pilot.app.screen._compositor.render_strips())


async def choose(pilot: Pilot[Any], dialog: PreviewDialog, key: str, downs: int) -> None:
    """Choose an entry further down, or up if negative, in the list that a key opens."""
    await pilot.press(key)
    await until(pilot, lambda: any(one.expanded for one in dialog.query(Select)))
    await pilot.press(*["down" if downs > 0 else "up"] * abs(downs), "enter")
    await until(pilot, lambda: dialog.focused is dialog.query_one("#rows"))


@pytest.mark.slow
@cases(
    "name, key, downs, before, after, choices",
    {
        "header": ("header", "h", 2, "found: line 3", " far ", ReadChoices(header=2)),
        "separator": ("separator", "s", 2, "column 4", "burst", ReadChoices(separator="semicolon")),
        "decimal": ("decimal", "d", 2, " 1100", " 1.1", ReadChoices(decimal=",")),
        "time": ("time", "t", 1, "found: row numbers", "Time boot", ReadChoices(time="boot")),
    },
)
async def test_each_choice_in_the_preview_changes_its_rows_and_how_the_file_opens(
    name: str, key: str, downs: int, before: str, after: str, choices: ReadChoices, tmp_path: Path
) -> None:
    file = tmp_path / f"{name}.csv"
    file.write_text(FILES[name])
    async with previewed(file) as (pilot, dialog):
        await until(pilot, lambda: before in screen_text(pilot))
        await choose(pilot, dialog, key, downs)
        await until(pilot, lambda: after in screen_text(pilot))
        assert "d decimal sign t time u unit" in screen_text(pilot)
        await pilot.press("enter")
        await until(pilot, lambda: analyser(pilot).is_open)
        assert analyser(pilot).request.choices == choices
    assert find_choices(str(file)) == choices
    assert "read as chosen" in (await open_again(file))[0]


@pytest.mark.slow
async def test_accepting_the_guess_opens_the_file_and_no_preview_comes_again(
    tmp_path: Path,
) -> None:
    file = tmp_path / "time.csv"
    file.write_text(FILES["time"])
    async with previewed(file) as (pilot, _):
        await pilot.press("enter")
        await until(pilot, lambda: analyser(pilot).is_open)
    assert find_choices(str(file)) == NO_CHOICES
    assert await open_again(file) == ()


async def test_escape_in_the_preview_remembers_no_choices(tmp_path: Path) -> None:
    file = tmp_path / "time.csv"
    file.write_text(FILES["time"])
    async with previewed(file) as (pilot, dialog):
        app = pilot.app
        await choose(pilot, dialog, "t", 1)
        await pilot.press("escape")
        await until(pilot, lambda: not app.is_running or app.return_code is not None)
    assert find_choices(str(file)) is None


async def shown_again(pilot: Pilot[Any]) -> PreviewDialog:
    """Ask for the dialog while the file is open."""
    await pilot.press("C")
    await until(pilot, lambda: isinstance(pilot.app.screen, PreviewDialog))
    dialog = pilot.app.screen
    assert isinstance(dialog, PreviewDialog)
    await until(pilot, lambda: dialog.is_ready)
    return dialog


@pytest.mark.slow
async def test_an_open_file_can_be_read_with_other_choices_and_with_the_former_again(
    tmp_path: Path,
) -> None:
    file = tmp_path / "time.csv"
    file.write_text(FILES["time"])
    async with previewed(file) as (pilot, _):
        await pilot.press("enter")
        await until(pilot, lambda: analyser(pilot).is_open)
        await choose(pilot, await shown_again(pilot), "h", 3)
        await pilot.press("enter")
        await until(pilot, lambda: analyser(pilot).model.log.names == ("20", "7", "1"))
        dialog = await shown_again(pilot)
        await choose(pilot, dialog, "h", -3)
        await pilot.press("escape")
        await until(pilot, lambda: dialog.is_closed)
        assert analyser(pilot).model.log.names == ("20", "7", "1")
        await choose(pilot, await shown_again(pilot), "h", -3)
        await pilot.press("enter")
        await until(pilot, lambda: analyser(pilot).model.log.names == ("boot", "id", "light"))


@pytest.mark.slow
async def test_the_preview_opens_no_file_with_choices_by_which_it_cannot_be_read(
    tmp_path: Path,
) -> None:
    file = tmp_path / "end.csv"
    file.write_text("boot;far\n0;0\n20;1\n40;2\nend;all\n")
    async with previewed(file) as (pilot, dialog):
        await choose(pilot, dialog, "h", 5)
        message = dialog.query_one("#message", Static)
        await until(pilot, lambda: message.has_class("wrong"))
        await pilot.press("enter")
        await pilot.pause()
        assert pilot.app.screen is dialog
        await choose(pilot, dialog, "h", -4)
        await until(pilot, lambda: not message.has_class("wrong"))
