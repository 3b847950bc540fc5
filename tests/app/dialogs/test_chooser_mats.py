"""The mat picker: pictures, and images of one's own."""

from __future__ import annotations

from pathlib import Path
from threading import Event
from typing import Any

import pytest
from PIL import Image
from textual.pilot import Pilot
from textual.widgets import Input, OptionList, Static

from tests.app.app_help import LOGS, message_of, notices, open_lab, settings, until
from tests.running import PATIENCE_S
from tuisim.app.app import AppSettings
from tuisim.app.dialogs.chooser import MatPicker
from tuisim.base.errors import TuisimError
from tuisim.settings.options import Settings
from tuisim.terminal.cell_view import PixelView


@pytest.mark.slow
@pytest.mark.parametrize("size", [(80, 24), (120, 40)], ids=["80x24", "120x40"])
async def test_the_dialog_for_mats_shows_a_picture_of_the_selected_mat(
    size: tuple[int, int],
) -> None:
    async with open_lab(LOGS, size=size) as (pilot, app):
        await pilot.press("b")
        view = app.screen.query_one(PixelView)
        # The view gets its height after the dialog; before, a picture may have another shape.
        await until(
            pilot,
            lambda: (
                view._cells.shape[0] == view.size.height == getattr(view.styles.height, "value", 0)
            ),
        )
        bands = view._cells.copy()
        assert view.region.bottom < size[1]
        mats = app.screen.query_one(OptionList)
        mats.highlighted = mats.get_option_index("Rainbow_bands")
        await until(
            pilot, lambda: view._cells.shape == bands.shape and bool((view._cells != bands).any())
        )
        assert "Seven coloured bands" in str(app.screen.query_one("#title", Static).render())
        # All of the dialog can be seen.
        field = app.screen.query_one(Input)
        assert field.region.height == 1
        assert app.screen.query_one(".dialog").region.contains_region(mats.region)


@pytest.mark.parametrize("key", ["b", "r"])
async def test_the_input_field_is_above_the_list_of_mats_or_robots(key: str) -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        await pilot.press(key)
        await until(pilot, lambda: bool(app.screen.query(OptionList)))
        listed = app.screen.query_one(OptionList)
        await until(pilot, lambda: bool(listed.region))
        assert app.screen.query_one(Input).region.y < listed.region.y


async def test_the_dialog_for_mats_never_shows_the_picture_of_a_mat_selected_before(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    go_on = Event()
    decode = MatPicker._decode

    def wait(picker: MatPicker, name: str, *rest: Any) -> Any:
        if name == "Rainbow_bands":
            assert go_on.wait(PATIENCE_S)
        return decode(picker, name, *rest)

    monkeypatch.setattr(MatPicker, "_decode", wait)
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("b")
        view = app.screen.query_one(PixelView)
        await until(pilot, lambda: bool(view._strips))
        mats = app.screen.query_one(OptionList)
        mats.highlighted = mats.get_option_index("Rainbow_bands")
        await until(pilot, lambda: not view._strips)
        title = app.screen.query_one("#title", Static)
        assert str(title.render()).endswith(" · loading …")
        go_on.set()
        await until(pilot, lambda: bool(view._strips))
        assert "loading" not in str(title.render())


async def test_the_scroll_bar_of_a_list_is_at_its_edge() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        await pilot.press("b")
        await until(pilot, lambda: bool(app.screen.query(OptionList)))
        listed = app.screen.query_one(OptionList)
        await until(pilot, lambda: listed.show_vertical_scrollbar)
        bar = app.screen.find_widget(listed.vertical_scrollbar)
        assert bar.region.right == listed.region.right


async def test_a_word_of_a_description_finds_its_mats() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        await pilot.press("b")
        await until(pilot, lambda: bool(app.screen.query(OptionList)))
        app.screen.query_one(Input).value = "track"
        listed = app.screen.query_one(OptionList)
        await until(pilot, lambda: listed.option_count == 2)
        assert {option.id for option in listed.options} == {"Loop", "Two_shapes"}


async def test_words_that_no_mat_has_leave_no_preview() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        await pilot.press("b")
        await until(pilot, lambda: bool(app.screen.query(PixelView)))
        view, title = app.screen.query_one(PixelView), app.screen.query_one("#title", Static)
        await until(pilot, lambda: bool(view._strips))
        # The list empties before it has told that another mat is highlighted.
        field = app.screen.query_one(Input)
        field.value = "rainbow"
        field.value = "rainbowx"
        await until(pilot, lambda: "nothing here" in str(message_of(app)))
        await pilot.pause()
        assert not view._strips
        assert not str(title.content)


async def enter_path(pilot: Pilot[None], path: Path) -> None:
    """Begin to type a path, which turns to the field, and give the rest at once."""
    await pilot.press("slash")
    pilot.app.screen.query_one(Input).value = str(path)
    await pilot.press("enter")


@pytest.mark.slow
@pytest.mark.parametrize("content", [None, "no picture"], ids=["missing", "text"])
async def test_choosing_a_file_that_is_no_image_keeps_the_mat_and_says_why(
    content: str | None, tmp_path: Path
) -> None:
    path = tmp_path / "none.png"
    if content:
        path.write_text(content)
    async with open_lab(LOGS) as (pilot, app):
        before = app.run_controller.next_run
        await pilot.press("b")
        await pilot.pause()
        await enter_path(pilot, path)
        await until(
            pilot, lambda: any("none.png" in told for told in (*notices(app), message_of(app)))
        )
        await until(pilot, lambda: app.run_controller.next_run == before)
        assert app.loader.mat_is_ready
        assert app.run_controller.build_snapshot().colors["left"].rgb == (255, 255, 255)


def with_mats(folder: Path | None) -> AppSettings:
    return settings(
        LOGS,
        settings=Settings(
            {"background": "Grey_bands", "mats": None if folder is None else str(folder)}
        ),
    )


async def choose(pilot: Pilot[None], name: str) -> None:
    """Choose a mat in the picker by its name."""
    await pilot.press("b")
    await pilot.pause()
    listed = pilot.app.screen.query_one(OptionList)
    listed.highlighted = listed.get_option_index(name)
    listed.focus()
    await pilot.press("enter")


@pytest.mark.slow
@pytest.mark.parametrize("named", [False, True], ids=["usual folder", "--mats"])
async def test_mats_of_ones_own_are_listed_by_name(named: bool, home: Path, tmp_path: Path) -> None:
    folder = tmp_path / "pics" if named else home / "backgrounds"
    folder.mkdir(parents=True)
    Image.new("RGB", (300, 200), (200, 0, 0)).save(folder / "FLL2018.jpg", quality=100)
    async with open_lab(with_mats(folder if named else None)) as (pilot, app):
        await choose(pilot, "FLL_2018_Into_Orbit")
        picture = str(folder / "FLL2018.jpg")
        await until(
            pilot,
            lambda: (
                app.run_controller.next_run.spec.world.background == picture
                and app.loader.mat_is_ready
            ),
        )
        assert app.run_controller.next_run.spec.world.start.x_mm == 150


@pytest.mark.slow
async def test_a_folder_of_mats_that_is_gone_is_told(tmp_path: Path) -> None:
    folder = tmp_path / "pics"
    folder.mkdir()
    async with open_lab(with_mats(folder)) as (pilot, app):
        folder.rmdir()
        await pilot.press("b")
        await until(
            pilot, lambda: any("there is no such folder" in notice for notice in notices(app))
        )


@pytest.mark.slow
async def test_a_path_to_nothing_has_no_preview() -> None:
    async with open_lab(with_mats(None)) as (pilot, _):
        await pilot.press("b")
        title = pilot.app.screen.query_one("#title", Static)
        await until(pilot, lambda: bool(str(title.content)))
        await pilot.press(*"/no/such.png")
        await until(pilot, lambda: not str(title.content))


@pytest.mark.slow
async def test_a_mat_picture_decoded_while_the_dialog_closes_is_dropped() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("b")
        await until(pilot, lambda: bool(app.screen.query(PixelView)))
        picker = app.screen
        assert isinstance(picker, MatPicker)
        await until(pilot, lambda: bool(picker._pictures))
        key, picture = next(iter(picker._pictures.items()))
        await picker.query(PixelView).remove()
        picker._show_decoded((picker._shown, key[1]), picture)
        picker._report(picker._shown, TuisimError("no picture"))
