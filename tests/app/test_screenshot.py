"""Screenshots: the key, the palette and dialogs; what the files show, and where they cannot be written."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from xml.etree import ElementTree

import pytest
from PIL import Image

from tests.app.app_help import notices, open_lab, until
from tuisim.app.app import LabApp
from tuisim.app.screenshot import collect_cells
from tuisim.terminal.cell_image import CELL_PX

GREY = (128, 128, 128)
"""A band of the mat."""


def words_in(path: Path) -> str:
    """The text in an SVG file, without spaces."""
    return "".join(
        "".join(node.itertext())
        for node in ElementTree.parse(path).iter("{http://www.w3.org/2000/svg}text")
    )


def said_by(app: LabApp, text: str) -> bool:
    return text in notices(app)


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLORTERM", "truecolor")


@pytest.mark.slow
async def test_the_screenshot_key_saves_the_screen_and_names_the_files(tmp_path: Path) -> None:
    async with open_lab(size=(100, 30)) as (pilot, app):
        await until(
            pilot, lambda: any(look.ink == GREY for row in collect_cells(app) for _, look in row)
        )
        for number, key in enumerate(("I", "f12"), 1):
            await pilot.press(key)
            said = f"Saved tuisim-{number}.svg and tuisim-{number}.png in {tmp_path}"
            await until(pilot, partial(said_by, app, said))
    assert "Instrumentation" in words_in(tmp_path / "tuisim-2.svg")
    with Image.open(tmp_path / "tuisim-1.png") as picture:
        assert picture.size == (100 * CELL_PX[0], 30 * CELL_PX[1])
        colors = {color for _, color in picture.convert("RGB").getcolors(1 << 24) or ()}
    assert {(255, 255, 255), GREY, (0, 0, 0)} <= colors


@pytest.mark.slow
async def test_a_screenshot_shows_a_dialog_and_the_screen_below_it(tmp_path: Path) -> None:
    async with open_lab(size=(100, 30)) as (pilot, app):
        await pilot.press("b")
        await until(pilot, lambda: len(app.screen_stack) == 2)
        await pilot.press("f12")
        await until(pilot, lambda: (tmp_path / "tuisim-1.png").exists())
    assert {
        word
        for word in ("Grey_bands", "Lollipop", "World")
        if word in words_in(tmp_path / "tuisim-1.svg")
    } == {
        "Grey_bands",
        "Lollipop",
        "World",
    }


@pytest.mark.slow
async def test_a_screenshot_taken_from_the_palette_does_not_show_the_palette(
    tmp_path: Path,
) -> None:
    async with open_lab(size=(100, 30)) as (pilot, app):
        await pilot.press("ctrl+p", *"screenshot")
        await until(pilot, lambda: len(app.screen_stack) == 2)
        await pilot.press("enter")
        await until(pilot, lambda: (tmp_path / "tuisim-1.png").exists())
    assert "Saveascreenshot" not in words_in(tmp_path / "tuisim-1.svg")


@pytest.mark.slow
async def test_a_screenshot_that_cannot_be_written_says_why(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gone = tmp_path / "gone"
    monkeypatch.setattr(Path, "cwd", lambda: gone)
    async with open_lab(size=(100, 30)) as (pilot, app):
        await pilot.press("I")
        await until(
            pilot,
            lambda: (
                f"cannot write {gone / 'tuisim-1.svg'}: there is no folder {gone}" in notices(app)
            ),
        )
