"""One instant in all panels: what a step has changed, what the newest line of the output says, how the end is told."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input

from tests.app.app_help import open_lab, press_and_stand, recording_of, until, until_state
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.panels.output import Output
from tuisim.app.snapshot import RunPhase
from tuisim.base.source import Program
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

RESETS = """\
tank_drive.on_for_rotations(30, 30, 0.2)
tank_drive.left_motor.position = 0
tank_drive.on(-30, -30)
while tank_drive.left_motor.position > -100:
    print("pos:", tank_drive.left_motor.position)
tank_drive.left_motor.position = 5
tank_drive.off()
"""
PROFILES = pytest.mark.parametrize("profile", ["robolab", "ev3"])


def open_program(text: str, profile: str) -> AppSettings:
    spec = build_run_spec(Settings({"background": "Grey_bands", "profile": profile}))
    return AppSettings(spec=spec, program=Program("prog.py", text, "preloaded"), speed=0.0)


def list_left(app: LabApp) -> tuple[int, int]:
    """Return position and speed of the left motor, as the panel shows them."""
    position_deg, dps = app.run_controller.build_snapshot().list_turns()[0]
    return round(position_deg), round(dps)


def shows(output: Output, text: str) -> bool:
    return output.copy_text().text == text


async def find(pilot: Pilot[Any], app: LabApp, words: str) -> int:
    """Go to an instant, and return its tick."""
    await pilot.press("g")
    app.screen.query_one(Input).value = words
    await pilot.press("enter")
    timeline = app.run_controller.timeline
    await until(pilot, lambda: timeline.at is not None)
    assert timeline.at is not None
    return timeline.at


@pytest.mark.slow
@PROFILES
async def test_a_step_shows_the_effect_of_its_line(profile: str) -> None:
    async with open_lab(open_program(RESETS, profile)) as (pilot, app):
        shown = []
        for _ in range(4):
            await press_and_stand(pilot, "n")
            shown.append(list_left(app))
        assert shown[0] == (0, 0)
        assert shown[1][0] in (range(70, 90) if profile == "ev3" else (72,))
        assert shown[2][0] == 0 and shown[3][0] == 0
        assert profile == "ev3" or [dps for _, dps in shown] == [0] * 4


@pytest.mark.slow
async def test_a_step_back_within_a_tick_takes_back_value_and_printed_line() -> None:
    text = "print('a')\ntank_drive.left_motor.position = 9\nprint('b')\n"
    async with open_lab(open_program(text, "robolab")) as (pilot, app):
        output = app.panel_area.output
        assert output is not None
        for key, position_deg, printed in (
            ("n", 0, ""),
            ("n", 0, "a"),
            ("n", 9, "a"),
            ("N", 0, "a"),
            ("N", 0, ""),
            ("n", 0, "a"),
        ):
            await press_and_stand(pilot, key)
            await until(pilot, partial(shows, output, printed), key)
            assert list_left(app) == (position_deg, 0)


@pytest.mark.slow
@PROFILES
async def test_the_end_and_the_past_show_the_last_print_and_the_position_that_was_set(
    profile: str,
) -> None:
    async with open_lab(open_program(RESETS, profile)) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        position_deg, dps = list_left(app)
        assert position_deg in (range(-60, 6) if profile == "ev3" else (5,)) and dps == 0
        assert app.run_controller.build_snapshot().turning == ""
        tick = await find(pilot, app, "pos < -50 first")
        rows = recording_of(app).rows
        printed = rows.list_texts(rows.until(tick), 1)[0][0].text
        assert int(printed.partition(":")[2]) < -50
        chart = app.panel_area.chart
        assert chart is not None
        await until(pilot, lambda: printed.replace(":", "") in str(chart.border_subtitle))
        await pilot.press("comma")
        earlier = rows.list_texts(rows.until(tick - 1), 1)[0][0].text
        await until(pilot, lambda: earlier.replace(":", "") in str(chart.border_subtitle))
