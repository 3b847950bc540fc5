"""Keys of the lab: what they do, why they do nothing, and what the footer and the help say of them."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import pytest

from tests.app.app_help import LOGS, notices, open_lab, screen_text, until
from tests.cases import for_each
from tuisim.app.action import Action, fit_actions
from tuisim.app.actions.keys import ACTIONS, list_working
from tuisim.app.analyser.actions.keys import ACTIONS as ANALYSER_ACTIONS
from tuisim.app.guide.screen import GuideScreen
from tuisim.app.snapshot import RunPhase, Situation
from tuisim.engine.core.geometry import Pose


async def test_a_key_that_does_nothing_says_why() -> None:
    async with open_lab() as (pilot, app):
        for key, reason in (
            ("R", "No program yet: o opens one"),
            ("S", "Nothing is running: o opens a program, R runs it"),
            ("space", "Nothing is running: o opens a program, R runs it"),
            ("full_stop", "Nothing is running: o opens a program, R runs it"),
            ("comma", "No run yet: o opens a program, R runs it"),
            ("e", "No log yet: o opens a program, R runs it"),
        ):
            app.clear_notifications()
            await pilot.press(key)
            assert notices(app) == [reason], key


@pytest.mark.slow
async def test_arrow_keys_move_and_turn_the_robot() -> None:
    async with open_lab(LOGS) as (pilot, app):
        for key, pose in (
            ("left", Pose(140, 500, 0)),
            ("up", Pose(150, 510, 0)),
            ("shift+right", Pose(151, 500, 0)),
            ("shift+down", Pose(150, 499, 0)),
            ("ctrl+left", Pose(150, 500, 5)),
            ("ctrl+right", Pose(150, 500, -5)),
            ("a", Pose(150, 500, 5)),
            ("f", Pose(150, 500, -5)),
        ):
            await pilot.press(key)
            assert app.run_controller.pose == pose, key
            assert app.run_controller.build_snapshot().gyro_deg == 0, key
            await pilot.press("m")
            assert app.run_controller.pose == Pose(150, 500, 0), key


async def test_placing_the_resting_robot_elsewhere_updates_its_sensor_readings() -> None:
    async with open_lab(LOGS) as (_, app):
        assert app.run_controller.build_snapshot().colors["left"].red == 255
        app.run_controller.place(Pose(300, 500, 0))
        assert app.run_controller.build_snapshot().colors["left"].red == 220


async def test_speed_keys_change_the_speed_by_steps_and_stop_at_the_slowest() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("left_square_bracket", "left_square_bracket")
        assert app.run_controller.speed == 0.25
        await pilot.press("left_square_bracket")
        assert notices(app) == ["The speed is already ¼×, the slowest"]
        await pilot.press(*["right_square_bracket"] * 6)
        assert app.run_controller.speed == 0


@pytest.mark.slow
async def test_p_moves_the_pen_and_shift_p_does_not() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("P", "escape")
        after_shift_p = app.run_controller.pen_down
        await pilot.press("p")
        assert (after_shift_p, app.run_controller.pen_down) == (False, True)
        await pilot.press("x")
        assert not app.panel_area.is_shown("positioning")
        await pilot.press("X")
        assert app.panel_area.is_shown("positioning")


@pytest.mark.slow
async def test_help_lists_every_key() -> None:
    async with open_lab(size=(150, 240)) as (pilot, app):
        await pilot.press("question_mark")
        assert isinstance(app.screen, GuideScreen)
        await until(pilot, lambda: ACTIONS["run"].title in screen_text(app))
        text = screen_text(app)
        for action in ACTIONS.values():
            assert action.id.startswith("nudge") or action.title in text
        await pilot.press("escape")
        assert not isinstance(app.screen, GuideScreen)


@pytest.mark.parametrize("table", [ACTIONS, ANALYSER_ACTIONS], ids=["app", "analyser"])
def test_each_group_of_actions_is_defined_in_one_file_of_its_name(
    table: Mapping[str, Action[Any, Any]],
) -> None:
    functions = {
        (action.group, getattr(action.do, "func", action.do).__module__)
        for action in table.values()
    }
    # Methods of a screen, and the few functions in the table's file, are in no group's file.
    pairs = {
        (group, name)
        for group, name in functions
        if ".actions." in name and not name.endswith(".keys")
    }
    assert len({group for group, _ in pairs}) == len(pairs)
    assert [pair for pair in pairs if pair[0] not in (sys.modules[pair[1]].__doc__ or "")] == []


def test_no_key_has_two_actions() -> None:
    keys = [key for action in ACTIONS.values() for key in action.key.split(",")]
    assert sorted(keys) == sorted(set(keys))


def test_in_the_past_the_footer_begins_with_the_ways_out() -> None:
    shown = fit_actions(
        [
            ACTIONS[one]
            for one in list_working(
                Situation(RunPhase.PAUSED, True, True, in_past=True, looks_back=True)
            )
        ],
        80,
        9,
    )
    assert [action.id for action in shown[:2]] == ["now", "branch"]


@for_each(state=RunPhase, looks_back=[False, True])
def test_keys_move_the_robot_unless_a_program_drives_it(state: RunPhase, looks_back: bool) -> None:
    now = Situation(state, has_program=True, has_run=True, looks_back=looks_back)
    drives = state in (RunPhase.STARTING, RunPhase.RUNNING) and not looks_back
    moves = [action for action in ACTIONS.values() if action.id.startswith("nudge-")]
    assert moves
    assert all(bool(action.why_not(now)) is drives for action in moves)


async def test_ctrl_r_runs_the_program_also_outside_the_editor() -> None:
    async with open_lab("print('Colour: 1')\n", speed=0.0) as (pilot, app):
        await pilot.press("ctrl+r")
        await until(pilot, lambda: app.run_controller.state is RunPhase.ENDED)
