"""Keys that come faster than screens open and close."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from textual import events
from textual.app import App
from textual.geometry import Region
from textual.screen import Screen
from textual.widgets import Input, OptionList, Static

import tuisim.app
from tests.app.app_help import LOGS, open_lab, ready, settings, until
from tests.app.monkey import at_once, key_event
from tuisim.app.app import LabApp
from tuisim.app.dialogs.chooser import Chooser
from tuisim.app.dialogs.dialog import ClosesOnce, Dialog
from tuisim.app.dialogs.palette import Palette
from tuisim.app.dialogs.question import Question
from tuisim.app.guide.screen import GuideScreen, KeyPage, Topic

IN_THE_LAB = {
    "mat": "b enter enter",
    "program": "o enter enter",
    "robot": "r pagedown enter enter",
    "panel opened and closed": "Z Z z",
    "stored run": "h enter enter escape",
    "palette": "ctrl+p enter enter escape",
    "palette before its list is there": "ctrl+p pagedown escape",
    "palette asked for twice": "ctrl+p escape ctrl+p ctrl+p escape escape",
    "two dialogs after each other": "b escape T escape escape",
    "settings": "asterisk enter enter escape escape escape",
    "settings, and a value that is wrong": "asterisk down down down down down enter x enter enter escape escape escape",
}


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.quick_cases("palette", "mat", "robot")
@pytest.mark.parametrize("keys", IN_THE_LAB.values(), ids=list(IN_THE_LAB))
async def test_keys_typed_after_a_dialog_closes_change_nothing_in_the_lab(keys: str) -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        at_once(pilot, keys.split())
        await pilot.pause(0.1)
        await until(pilot, lambda: app._input.is_idle and len(app.screen_stack) == 1)
        at_once(pilot, ["question_mark"])
        await until(pilot, lambda: isinstance(app.screen, GuideScreen))


@pytest.mark.slow
async def test_text_typed_while_a_dialog_opens_goes_into_the_dialog() -> None:
    async with open_lab(size=(80, 24)) as (pilot, app):
        at_once(pilot, "o/tmp")
        await until(pilot, lambda: isinstance(app.screen, Chooser))
        await until(pilot, lambda: [field.value for field in app.screen.query(Input)] == ["/tmp"])


@pytest.mark.slow
async def test_a_closed_screen_draws_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[object] = []
    async with LabApp(settings()).run_test(size=(80, 24)) as pilot:
        app, dialog = await ready(pilot), GuideScreen(KeyPage("Help", "", {}), Topic())
        await app.push_screen(dialog)
        await pilot.press("escape")
        await until(pilot, lambda: dialog.is_closed)
        monkeypatch.setattr(
            App, "_display", lambda app, screen, renderable: drawn.append(renderable)
        )
        app._display(dialog, "help")
        monkeypatch.undo()
    assert [what for what in drawn if what is not None] == []


async def test_keys_that_come_when_the_app_has_ended_do_no_harm() -> None:
    async with open_lab(size=(80, 24)) as (_, app):
        app.exit()
    # They are taken out of the queue when there is no screen any more.
    await app.on_event(key_event("question_mark"))
    await app.on_event(events.Paste("x"))


async def test_a_screen_that_is_still_opening_when_the_app_is_shut_down_does_no_harm() -> None:
    async with open_lab(size=(80, 24)) as (_, app):
        app.push_screen(GuideScreen(KeyPage("Help", "", {}), Topic()))
    assert app._exception is None


@pytest.mark.slow
async def test_a_click_beside_the_list_of_a_dialog_leaves_the_keys_to_the_dialog() -> None:
    async with open_lab(size=(80, 24)) as (pilot, app):
        await pilot.press("o")
        await until(pilot, lambda: isinstance(app.focused, OptionList))
        await pilot.click(offset=(1, 1))
        assert isinstance(app.focused, OptionList)


async def test_a_dialog_answered_twice_quickly_gives_its_result_once() -> None:
    given: list[str | None] = []
    async with open_lab(size=(80, 24)) as (pilot, app):
        app.push_screen(Question("", "", (("y", ""),)), given.append)
        await pilot.pause()
        at_once(pilot, ["y", "y", "enter"])
        await pilot.pause()
        await until(pilot, lambda: len(app.screen_stack) == 1)
        await pilot.pause()
    assert given == ["y"]


@pytest.mark.slow
async def test_a_click_on_a_widget_that_was_just_removed_does_nothing() -> None:
    async with open_lab(size=(80, 24)) as (pilot, app):
        text = Static("gone", id="gone")
        guide = GuideScreen(KeyPage("Help", "", {}), Topic())
        await app.push_screen(guide)
        await guide.mount(text)
        await until(pilot, lambda: guide.is_ready and text.region.area > 0)
        x, y = text.region.offset
        with app.batch_update():
            # No layout comes in between.
            await text.remove()
            await app.on_event(
                events.MouseDown(None, x, y, 0, 0, 1, False, False, False, screen_x=x, screen_y=y)
            )
        await pilot.press("escape")
        await until(pilot, lambda: len(app.screen_stack) == 1)


@pytest.mark.slow
@pytest.mark.parametrize("is_ready", [False, True])
async def test_a_screen_that_is_not_drawn_yet_does_not_hear_the_mouse(
    is_ready: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with open_lab(size=(80, 24)) as (pilot, app):
        guide, heard = GuideScreen(KeyPage("Help", "", {}), Topic()), list[events.Event]()
        await app.push_screen(guide)
        await until(pilot, lambda: guide.is_ready)
        guide.is_ready = is_ready
        monkeypatch.setattr(guide, "_forward_event", heard.append)
        click = events.MouseDown(
            None, 20, 10, 0, 0, 1, False, False, False, screen_x=20, screen_y=10
        )
        await app.on_event(click)
        assert heard == [click] * is_ready


@pytest.mark.slow
async def test_no_palette_opens_above_a_dialog() -> None:
    async with open_lab(size=(80, 24)) as (pilot, app):
        for key in ("o", "question_mark", "ctrl+s"):
            await pilot.press(key)
            await until(pilot, lambda: isinstance(app.screen, Dialog) and app.screen.is_ready, key)
            await pilot.press("ctrl+p")
            await pilot.pause()
            assert len(app.screen_stack) == 2, key
            await pilot.press("escape")
            await until(pilot, lambda: len(app.screen_stack) == 1, key)


@pytest.mark.slow
async def test_a_dialog_is_drawn_above_a_screen_that_is_not_laid_out_for_a_larger_terminal_yet() -> (
    None
):
    async with open_lab(size=(80, 24)) as (pilot, app):
        await pilot.press("o")
        await until(pilot, lambda: isinstance(app.screen, Dialog) and app.screen.is_ready)
        lines = app.screen.render_lines(Region(0, 20, 80, 30))
        assert [line.cell_length for line in lines] == [80] * 30


@pytest.mark.slow
async def test_a_click_on_the_palette_where_the_terminal_was_does_no_harm() -> None:
    async with open_lab(size=(80, 24)) as (pilot, app):
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(app.screen, Palette) and app.screen.is_ready)
        event = events.Click(
            app.screen, 0, 50, 0, 0, 1, False, False, False, screen_x=0, screen_y=50
        )
        app.screen.post_message(event)
        await pilot.pause()
        assert isinstance(app.screen, Palette)


@pytest.mark.parametrize(
    "above",
    [lambda: GuideScreen(KeyPage("Help", "", {}), Topic()), lambda: Palette((), None)],
    ids=["help", "palette"],
)
async def test_closing_a_dialog_before_it_is_built_also_closes_screens_above_it(
    above: Callable[[], Screen[None]],
) -> None:
    given: list[str | None] = []
    async with open_lab(size=(80, 24)) as (pilot, app):
        below = Question("", "", (("y", ""),))
        app.push_screen(below, given.append)
        app.push_screen(above())
        below.dismiss("y")
        await until(pilot, lambda: len(app.screen_stack) == 1)
        await pilot.pause()
    assert given == ["y"]


def _screens() -> Iterator[type[Screen[object]]]:
    for module in pkgutil.walk_packages(tuisim.app.__path__, "tuisim.app."):
        for found in vars(importlib.import_module(module.name)).values():
            if (
                isinstance(found, type)
                and issubclass(found, Screen)
                and found.__module__ == module.name
            ):
                yield found


def test_every_screen_class_is_guarded_against_closing_twice() -> None:
    assert [screen for screen in _screens() if not issubclass(screen, ClosesOnce)] == []


@pytest.mark.parametrize(
    "width, hint",
    [(40, "Enter opens · Escape closes"), (60, "Enter opens · type to search · Escape closes")],
)
async def test_a_frame_without_room_for_all_hints_still_says_how_to_close(
    width: int, hint: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Dialog, "HINT", "Enter opens · type to search · Escape closes")
    app: App[None] = App()
    async with app.run_test(size=(width, 30)) as pilot:
        dialog: Dialog[str] = Dialog()
        app.push_screen(dialog)
        await until(pilot, lambda: app.screen is dialog and dialog.is_ready)
        assert dialog.query_one(".dialog").border_subtitle == hint
