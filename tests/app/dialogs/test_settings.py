"""The settings screen: what it writes, and what applies at once."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input, OptionList

from tests.app.app_help import LOGS, open_lab, screen_text, until
from tuisim.app.app import LabApp
from tuisim.app.dialogs.settings import SettingsScreen
from tuisim.app.panels.world import World
from tuisim.settings.user_config import SETTINGS, UserConfig
from tuisim.terminal.picture_options import CellSet


@asynccontextmanager
async def open_settings(
    size: tuple[int, int] = (80, 24),
) -> AsyncIterator[tuple[Pilot[Any], LabApp]]:
    """Open the app and its settings."""
    async with open_lab(LOGS, size=size) as (pilot, app):
        await pilot.press("asterisk")
        await until(pilot, lambda: isinstance(app.screen, SettingsScreen) and app.screen.is_ready)
        yield pilot, app


APPLIED: dict[str, tuple[list[str], object, Callable[[LabApp], bool]]] = {
    "app.ultrasound": (
        ["enter"],
        True,
        lambda app: any(world.show_rays for world in app.query(World)),
    ),
    "app.theme": (["enter", "wait", *"light", "enter"], "light", lambda app: app.theme == "light"),
    "app.cells": (
        ["enter", "wait", "end", "enter"],
        "ascii",
        lambda app: app.picture_mode.cells is CellSet.ASCII,
    ),
    "app.pixels": (["enter", "wait", "end", "enter"], "none", lambda app: app.pixels == "none"),
    "app.speed": (["enter", "wait", "5", "enter"], 5, lambda app: app.run_controller.speed == 5.0),
    "simulation.motornoise": (
        ["enter", "wait", "7", "enter"],
        7,
        lambda app: "next start" in screen_text(app),
    ),
}


async def change(pilot: Pilot[Any], app: LabApp, path: str) -> None:
    """Change a setting as a user does, see what it changes, and take it back."""
    keys, value, applies = APPLIED[path]
    screen = app.screen
    listed = screen.query_one(OptionList)
    listed.highlighted = listed.get_option_index(path)
    for key in keys:
        if key == "wait":
            await until(
                pilot, lambda: app.screen is not screen and getattr(app.screen, "is_ready", False)
            )
        else:
            await pilot.press(key)
    await until(pilot, lambda: UserConfig.load().written.get(path) == value, path)
    await until(pilot, lambda: applies(app), path)
    await until(pilot, lambda: app.screen is screen)
    await pilot.press("delete")
    await until(pilot, lambda: path not in UserConfig.load().written)


@pytest.mark.slow
async def test_each_changed_setting_is_written_and_takes_effect() -> None:
    async with open_settings() as (pilot, app):
        for path in APPLIED:
            await change(pilot, app, path)
        await pilot.press("escape")
        await until(pilot, lambda: len(app.screen_stack) == 1)


@pytest.mark.slow
async def test_a_wrong_value_in_the_settings_dialog_is_told_and_can_be_corrected() -> None:
    async with open_settings() as (pilot, app):
        listed = app.screen.query_one(OptionList)
        listed.highlighted = listed.get_option_index("app.fps")
        await pilot.press("enter")
        await until(pilot, lambda: bool(app.screen.query(Input)))
        await pilot.press(*"99", "enter")
        await until(
            pilot,
            lambda: "must be a whole number from 1 to 60" in " ".join(screen_text(app).split()),
        )
        assert not UserConfig.load().path.exists()
        await pilot.press("9", "enter")
        await until(pilot, lambda: UserConfig.load().written == {"app.fps": 9})


@pytest.mark.slow
@pytest.mark.parametrize("size", [(80, 24), (40, 12)], ids=str)
async def test_arrow_keys_reach_every_setting_and_each_has_its_own_explanation(
    size: tuple[int, int],
) -> None:
    async with open_settings(size) as (pilot, app):
        listed = app.screen.query_one(OptionList)
        seen = []

        def is_shown(name: str) -> bool:
            return name in screen_text(app)

        def is_selected(path: str) -> bool:
            return listed.get_option_at_index(listed.highlighted or 0).id == path

        for path, one in SETTINGS.items():
            await until(pilot, partial(is_selected, path), path)
            await until(pilot, partial(is_shown, one.name), path)
            seen.append(str(app.screen.query_one("#about").render()))
            await pilot.press("down")
        assert len(set(seen)) == len(SETTINGS)


async def test_a_file_that_is_no_toml_is_told_and_stays(tmp_path: Path) -> None:
    (tmp_path / "config.toml").write_text("[app\n")
    async with open_settings() as (pilot, app):
        listed = app.screen.query_one(OptionList)
        listed.highlighted = listed.get_option_index("app.ultrasound")
        await pilot.press("enter")
        await until(pilot, lambda: "is not TOML" in " ".join(screen_text(app).split()))
        assert (tmp_path / "config.toml").read_text() == "[app\n"
