"""Keys of the lab: what they do, why they do nothing, and what the footer and the help say of them."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import pytest
from textual.widgets import OptionList

from tests.app.app_help import LOGS, notices, open_lab, screen_text, settings, until
from tuisim.app.action import Action, fitting
from tuisim.app.actions.keys import ACTIONS, working
from tuisim.app.analyser.actions.keys import ACTIONS as ANALYSER_ACTIONS
from tuisim.app.app import LabApp
from tuisim.app.guide.screen import GuideScreen
from tuisim.app.panels import PANELS
from tuisim.app.snapshot import RunPhase, Situation
from tuisim.core.geometry import Pose

SIZES = [(80, 24), (120, 40), (200, 60)]


@pytest.mark.quick_cases("80x24")
@pytest.mark.parametrize("size", SIZES, ids=[f"{w}x{h}" for w, h in SIZES])
async def test_first_picture(size: tuple[int, int]) -> None:
    async with open_lab(LOGS, size=size) as (pilot, app):
        await until(
            pilot,
            lambda: all(
                words in screen_text(app) for words in ("World", "Instrumentation", "R run")
            ),
        )
        assert screen_text(app).count("\n") == size[1] - 1


@pytest.mark.slow
async def test_a_key_clears_the_log_as_shown_and_the_run_keeps_it() -> None:
    app = LabApp(settings(LOGS, panels_on=frozenset({"chart", "output"}), autorun=True, speed=0.0))
    async with app.run_test(size=(120, 40)) as pilot:
        await until(
            pilot, lambda: "— finished" in screen_text(app) and "[x] Colour" in screen_text(app)
        )
        await pilot.press("x")
        await until(
            pilot,
            lambda: "— finished" not in screen_text(app) and "Nothing logged" in screen_text(app),
        )
        recording = app.run_controller.timeline.recording
        assert "[x] Colour" not in screen_text(app)
        assert recording is not None
        assert any("Colour" in row.text for row in recording.rows.rows(0))


@pytest.mark.slow
async def test_resize_there_and_back() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        await until(
            pilot,
            lambda: all(words in screen_text(app) for words in ("White", "World: Grey_bands")),
        )
        before = screen_text(app)
        await pilot.resize_terminal(200, 60)
        await until(pilot, lambda: app.panel_area.shown("positioning"))
        assert all(app.panel_area.shown(panel.id) for panel in PANELS.values() if panel.sizes)
        await pilot.resize_terminal(80, 24)
        await until(pilot, lambda: not app.panel_area.shown("chart"))
        await until(pilot, lambda: screen_text(app) == before)


async def test_a_key_that_does_nothing_says_why() -> None:
    async with open_lab() as (pilot, app):
        for key, reason in (
            ("R", "No program yet: o opens one"),
            ("S", "Nothing is running: R runs the program"),
            ("space", "Nothing is running: R runs the program"),
            ("full_stop", "Nothing is running: R runs the program"),
            ("e", "No log yet: R runs the program"),
        ):
            app.clear_notifications()
            await pilot.press(key)
            assert notices(app) == [reason], key


@pytest.mark.slow
async def test_nudge() -> None:
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
            assert app.run_controller.snapshot().gyro_deg == 0, key
            await pilot.press("m")
            assert app.run_controller.pose == Pose(150, 500, 0), key


async def test_readings_follow_the_robot_at_rest() -> None:
    async with open_lab(LOGS) as (_, app):
        assert app.run_controller.snapshot().colors["left"].red == 255
        app.run_controller.place(Pose(300, 500, 0))
        assert app.run_controller.snapshot().colors["left"].red == 220


async def test_speed_steps_and_ends() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("left_square_bracket", "left_square_bracket")
        assert app.run_controller.speed == 0.25
        await pilot.press("left_square_bracket")
        assert notices(app) == ["The speed is already ¼×, the slowest"]
        await pilot.press(*["right_square_bracket"] * 6)
        assert app.run_controller.speed == 0


@pytest.mark.slow
async def test_pen_is_p_and_not_shift_p() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("P", "escape")
        after_shift_p = app.run_controller.pen_down
        await pilot.press("p")
        assert (after_shift_p, app.run_controller.pen_down) == (False, True)
        await pilot.press("x")
        assert not app.panel_area.shown("positioning")
        await pilot.press("X")
        assert app.panel_area.shown("positioning")


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


@pytest.mark.slow
async def test_choosing_a_mat_lays_it_out_with_its_start() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("b")
        mats = app.screen.query_one(OptionList)
        mats.highlighted = mats.get_option_index("Lollipop")
        await pilot.press("enter")
        await until(
            pilot,
            lambda: (
                app.run_controller.mat is not None and app.run_controller.mat.name == "Lollipop"
            ),
        )
        assert app.run_controller.pose.heading_deg == -180
        assert app.run_controller.program is not None


@pytest.mark.parametrize("width", [60, 80, 120, 200])
@pytest.mark.parametrize("state", [RunPhase.IDLE, RunPhase.RUNNING, RunPhase.PAUSED])
def test_footer_fits_and_always_shows_help_palette_and_quit(width: int, state: RunPhase) -> None:
    now = Situation(state, has_program=True, has_run=state != RunPhase.IDLE)
    shown = fitting([action for action in ACTIONS.values() if not action.why_not(now)], width, 9)
    assert [action.id for action in shown[-3:]] == ["help", "palette", "quit"]
    groups = len({action.group for action in shown})
    assert (
        sum(len(f" {a.footer_key or a.key_label} {a.footer}") for a in shown) + 2 * (groups - 1)
        <= width
    )


def test_each_line_of_the_table_is_an_action() -> None:
    for name, action in ACTIONS.items():
        assert action.title, name
        assert callable(action.do), name
        for state in (RunPhase.IDLE, RunPhase.RUNNING, RunPhase.PAUSED):
            for yes in (True, False):
                assert isinstance(action.why_not(Situation(state, yes, yes)), str), name


@pytest.mark.parametrize("table", [ACTIONS, ANALYSER_ACTIONS], ids=["app", "analyser"])
def test_each_group_is_in_one_file_that_names_it(table: Mapping[str, Action[Any, Any]]) -> None:
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


def test_keys_differ() -> None:
    keys = [key for action in ACTIONS.values() for key in action.key.split(",")]
    assert sorted(keys) == sorted(set(keys))


def test_in_the_past_the_footer_begins_with_the_ways_out() -> None:
    shown = fitting(
        [
            ACTIONS[one]
            for one in working(
                Situation(RunPhase.PAUSED, True, True, in_past=True, looks_back=True)
            )
        ],
        80,
        9,
    )
    assert [action.id for action in shown[:2]] == ["now", "branch"]


@pytest.mark.parametrize("state", RunPhase)
@pytest.mark.parametrize("looks_back", [False, True])
def test_keys_move_the_robot_unless_a_program_drives_it(state: RunPhase, looks_back: bool) -> None:
    now = Situation(state, has_program=True, has_run=True, looks_back=looks_back)
    drives = state in (RunPhase.STARTING, RunPhase.RUNNING) and not looks_back
    moves = [action for action in ACTIONS.values() if action.id.startswith("nudge-")]
    assert moves
    assert all(bool(action.why_not(now)) is drives for action in moves)
