"""The settings panel: a form over the plan of the next run."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input, OptionList

from tests.app.app_help import (
    ENDLESS,
    LOGS,
    message_of,
    notices,
    open_lab,
    screen_text,
    until,
    until_shown,
    until_state,
)
from tuisim.app.app import LabApp
from tuisim.app.form import Choice, Row
from tuisim.app.setup.next_run import change_robot
from tuisim.app.snapshot import RunPhase
from tuisim.settings.robots import ROBOTS, RobotChoice


@asynccontextmanager
async def open_settings(text: str = LOGS, **more: Any) -> AsyncIterator[tuple[Pilot[Any], LabApp]]:
    """Open the app with its settings shown."""
    async with open_lab(text, **more) as (pilot, app):
        await pilot.press("Z")
        await until(pilot, lambda: isinstance(app.focused, Choice))
        yield pilot, app


def row(app: LabApp, field: str) -> Row:
    return next(row for row in app.query(Row) if row.field == field)


async def enter(pilot: Pilot[Any], field: str, text: str) -> None:
    app = pilot.app
    assert isinstance(app, LabApp)
    entry = row(app, field).entry
    entry.focus()
    entry.value = text
    await pilot.press("enter")
    await pilot.pause()


@pytest.mark.slow
@pytest.mark.parametrize(
    "size", [(80, 24), (120, 40), (200, 60)], ids=["80x24", "120x40", "200x60"]
)
async def test_the_settings_form_opens_with_the_robots_values(size: tuple[int, int]) -> None:
    async with open_settings(size=size) as (pilot, app):
        assert "‹ Default_Robot ›" in screen_text(app)
        assert row(app, "wheel_spacing_mm").entry.value == "180"
        assert row(app, "left.port").entry.value == "in2"
        assert [
            panel
            for panel in app.panel_area.panels
            if app.panel_area.panels[panel].has_class("-focused")
        ] == ["settings"]
        # Letters are still keys of the app.
        await pilot.press("Z")
        assert not app.panel_area.is_shown("settings")
        assert app.focused is app.panel_area.world


@pytest.mark.slow
async def test_a_value_typed_into_the_robots_form_changes_the_next_run_at_once() -> None:
    async with open_settings() as (pilot, app):
        await enter(pilot, "left.x_mm", "-100")
        assert app.run_controller.spec.robot.color_sensors[0].x_mm == -100
        assert row(app, "preset").entry.value == "Default_Robot, edited"
        await enter(pilot, "ultrasonic.used", "on")
        await until(pilot, lambda: app.run_controller.build_snapshot().ultrasonic_mm is None)
        await pilot.press("ctrl+n")
        await until(pilot, lambda: row(app, "preset").entry.value == "Default_Robot")
        assert app.run_controller.build_snapshot().ultrasonic_mm is not None


@pytest.mark.slow
async def test_a_settings_value_is_checked_and_taken_also_when_its_field_is_left() -> None:
    async with open_settings() as (pilot, app):
        before = app.run_controller.next_run
        await enter(pilot, "wheel_diameter_mm", "999")
        assert "must be a number from 1 to 500" in screen_text(app)
        assert app.run_controller.next_run == before
        await enter(pilot, "wheel_diameter_mm", "60")
        assert "must be" not in screen_text(app)
        assert app.run_controller.next_run.spec.robot.wheel_diameter_mm == 60

        entry = row(app, "back_mm").entry
        entry.focus()
        entry.value = "-99"
        await pilot.press("tab")
        await until(pilot, lambda: app.run_controller.next_run.spec.robot.back_mm == -99)

        app.loader.try_change(lambda plan: change_robot(plan, "Default_Robot"))
        choice = row(app, "preset").entry
        assert isinstance(choice, Choice)
        await until(pilot, lambda: choice.value == "Default_Robot")
        names = [*ROBOTS]
        for _ in range(3):
            choice.action_step(1)
        await pilot.pause()
        wanted = names[names.index("Default_Robot") + 3 - len(names)]
        await until(pilot, lambda: app.run_controller.next_run.spec.robot.name == wanted)


@pytest.mark.slow
async def test_arrow_keys_step_through_the_choices_of_the_settings_form() -> None:
    async with open_settings() as (pilot, app):
        await pilot.press("right")
        await until(pilot, lambda: app.run_controller.next_run.spec.robot.name == "Small_Robot")
        await pilot.press(*["left"] * 4)
        await until(
            pilot, lambda: app.run_controller.next_run.spec.robot.name == "Sensor_Diameter_Config"
        )
        # New diameters have to be prepared; until then nothing starts.
        await until(pilot, lambda: app.loader.mat_is_ready)
        assert app.run_controller.mat is not None
        assert app.run_controller.mat.key[2] == {30, 10}
        assert app.run_controller.pose.x_mm == 150


@pytest.mark.slow
async def test_settings_are_not_changed_during_a_run() -> None:
    async with open_settings(ENDLESS, autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.RUNNING)
        await enter(pilot, "wheel_diameter_mm", "60")
        assert "Not available during a run: S stops it" in screen_text(app)
        assert app.run_controller.next_run.spec.robot.wheel_diameter_mm == 56
        await pilot.press("escape", "S")
        await until_state(pilot, RunPhase.ENDED)
        await enter(pilot, "wheel_diameter_mm", "60")
        assert app.run_controller.spec.robot.wheel_diameter_mm == 60


@pytest.mark.slow
async def test_a_robot_is_saved_edited_and_loaded_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    async with open_settings() as (pilot, app):
        await enter(pilot, "wheel_diameter_mm", "77")
        await pilot.press("ctrl+b")
        app.screen.query_one(Input).value = "mine.toml"
        await pilot.press("enter")
        await until(pilot, lambda: len(app.screen_stack) == 1)
        assert RobotChoice.load("mine.toml").spec.wheel_diameter_mm == 77
        await pilot.press("escape", "r")
        robots = app.screen.query_one(OptionList)
        robots.highlighted = robots.get_option_index("Small_Robot")
        await pilot.press("enter")
        await until(pilot, lambda: app.run_controller.next_run.spec.robot.name == "Small_Robot")
        await pilot.press("r")
        robots = app.screen.query_one(OptionList)
        robots.highlighted = robots.get_option_index(str(tmp_path / "mine.toml"))
        await pilot.press("enter")
        await until(pilot, lambda: app.run_controller.next_run.spec.robot.wheel_diameter_mm == 77)
        assert row(app, "preset").entry.value == "mine.toml"


@pytest.mark.slow
async def test_a_wrong_robot_file_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "bad.toml").write_text("wheels = 3\n")
    monkeypatch.chdir(tmp_path)
    async with open_lab(LOGS) as (pilot, app):
        before = app.run_controller.next_run
        await pilot.press("r")
        entry = app.screen.query_one(Input)
        entry.focus()
        entry.value = "bad.toml"
        await pilot.press("enter")
        await until(pilot, lambda: "bad.toml: wheels: no such key" in message_of(app))
        assert app.run_controller.next_run == before


@pytest.mark.slow
async def test_a_profile_is_chosen_and_seen_in_the_controls() -> None:
    async with open_lab(LOGS, panels_on=frozenset({"controls"})) as (pilot, app):
        await pilot.press("F")
        profiles = app.screen.query_one(OptionList)
        profiles.highlighted = profiles.get_option_index("ev3")
        await pilot.press("enter")
        await until_shown(pilot, "ev3, seed 0")
        assert app.run_controller.next_run.spec.world.solid


async def test_what_a_robots_file_has_that_means_nothing_here_is_said(tmp_path: Path) -> None:
    (tmp_path / "mine.json").write_text('{"owner": "Ann"}')
    async with open_lab() as (pilot, app):
        app.loader.try_change(lambda plan: change_robot(plan, str(tmp_path / "mine.json")))
        await until(
            pilot,
            lambda: sum("ignored unknown keys: owner" in notice for notice in notices(app)) == 1,
        )


@pytest.mark.slow
async def test_a_long_value_is_seen_from_its_beginning_and_escape_closes_the_panel() -> None:
    async with open_settings(size=(80, 24)) as (pilot, app):
        await pilot.press("down")
        await until(pilot, lambda: app.focused is row(app, "name").entry)
        await until_shown(pilot, "Name        Default_")
        await pilot.press("escape")
        await until(pilot, lambda: not app.panel_area.is_shown("settings"))
