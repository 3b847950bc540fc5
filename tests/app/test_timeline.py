"""Going about in time: keys, bar, words, and what the panels show of a former instant."""

from __future__ import annotations

import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input

from tests.app.app_help import (
    ENDLESS,
    LOGS,
    notices,
    open_lab,
    recording_of,
    screen_text,
    until,
    until_shown,
    until_state,
)
from tuisim.app.app import LabApp
from tuisim.app.snapshot import RunPhase, Snapshot
from tuisim.app.timeline import Timeline, find
from tuisim.base.errors import ConfigError
from tuisim.engine.protocol import End
from tuisim.engine.runs.records import Mark

PEN = LOGS.replace("tank_drive.on", "print('off we go')\ntank_drive.on", 1)


@asynccontextmanager
async def a_run(
    text: str = LOGS, size: tuple[int, int] = (120, 40)
) -> AsyncIterator[tuple[Pilot[None], LabApp]]:
    """A run that is over, in the app."""
    async with open_lab(text, autorun=True, speed=0.0, size=size) as (pilot, app):
        await until_state(pilot, RunPhase.ENDED)
        recording = recording_of(app)
        await until(pilot, lambda: not recording.rows.take(1) and not app._last_words)
        yield pilot, app


@pytest.mark.slow
async def test_keys_go_back_and_forward_in_the_time_of_a_run() -> None:
    async with a_run() as (pilot, app):
        timeline = app.run_controller.timeline
        newest = app.run_controller.timeline.newest
        steps = [
            ("comma", newest - 1),
            ("comma", newest - 2),
            ("full_stop", newest - 1),
            ("less_than_sign", newest - 101),
            ("greater_than_sign", newest - 1),
            ("full_stop", None),
            ("home", 0),
            ("greater_than_sign", 100),
            ("end", None),
            ("less_than_sign", newest - 100),
            ("escape", None),
        ]
        for key, tick in steps:
            await pilot.press(key)
            assert timeline.at == tick, key
        await pilot.press("home", "comma")
        assert "This is the start of the run" in notices(app)


OF_NOW: dict[str, Any] = {
    "wheels": "last speeds",
    **dict.fromkeys(("next_spec", "recorded_spec", "now_pose", "program")),
}
"""What a snapshot of a former instant says of the present."""


@pytest.mark.slow
async def test_a_past_instant_shows_the_robot_and_readings_of_then() -> None:
    async with a_run(size=(200, 60)) as (pilot, app):
        recording = app.run_controller.timeline.recording
        mat = app.run_controller.mat
        assert recording and mat
        await pilot.press("g")
        app.screen.query_one(Input).value = "2 s"
        await pilot.press("enter")
        await until(pilot, lambda: app.run_controller.timeline.at == 200)
        await until(pilot, lambda: app.debugger.view is not None and not app.debugger.busy)
        assert app.debugger.view is not None
        record = recording.telemetry.record(200)
        line = app.debugger.view.paused.line
        then, _ = recording.read_instant(record, recording.spec, recording.spec.world.noise)
        expected = Snapshot(
            RunPhase.ENDED,
            End.FINISHED,
            recording.spec,
            mat.field,
            then,
            line,
            speed=0.0,
            pen_down=False,
        )
        shown = app.run_controller.build_snapshot()
        assert replace(shown, **OF_NOW, past=False, now_tick=0) == expected
        last = recording.telemetry.last()
        assert last is not None
        assert shown.now_pose == last.pose
        await until_shown(pilot, "past 2.00 s")
        printed = [row.text for row in recording.rows.rows(0) if row.tick <= 200]
        output = app.panel_area.output
        assert output is not None
        assert [row.text for row in output._past_log._rows] == printed
        assert len(printed) < len(recording.rows)
        assert app.panel_area.chart is not None
        assert app.panel_area.chart._state.cursor_s == 2.0
        await pilot.press("end")
        await until(pilot, lambda: not output._past_log.display and output._log.display)


@pytest.mark.slow
async def test_at_a_past_instant_the_pens_line_ends_where_the_robot_was() -> None:
    async with open_lab(ENDLESS, autorun=True, speed=0.0) as (pilot, app):
        app.run_controller.set_pen(True)
        await until(pilot, lambda: app.run_controller.timeline.newest > 300)
        await pilot.press("comma")
        await until_state(pilot, RunPhase.PAUSED)
        app.run_controller.timeline.go(150)
        app.draw(force=True)
        world = app.panel_area.world
        assert world is not None
        assert world._view.past_trace is not None
        recording = recording_of(app)
        drawn = [piece.xs_mm for piece in world._view.past_trace.iterate_pieces(0)]
        if drawn:
            ahead = recording.spec.robot.pen.y_mm
            assert max(float(xs[-1]) for xs in drawn) <= recording.telemetry.record(150).x_mm + abs(
                ahead
            )
        await pilot.press("end", "S")
        await until_state(pilot, RunPhase.ENDED)
        assert world._view.past_trace is None


@pytest.mark.slow
async def test_looking_back_pauses_a_running_program_and_space_plays_it_on() -> None:
    async with open_lab(ENDLESS, autorun=True, speed=4.0) as (pilot, app):
        await until(
            pilot,
            lambda: (
                app.run_controller.state == RunPhase.RUNNING
                and app.run_controller.timeline.newest > 300
            ),
        )
        await pilot.press("less_than_sign", "home")
        await until_state(pilot, RunPhase.PAUSED)
        newest = app.run_controller.timeline.newest
        assert app.run_controller.timeline.at == 0
        # Slowly, so that the past is not over before anybody looks.
        await pilot.press(*["left_square_bracket"] * 3, "space")
        await until(pilot, lambda: 0 < (app.run_controller.timeline.at or 0))
        await pilot.press("space")
        at = app.run_controller.timeline.at
        assert at is not None
        await pilot.press("full_stop")
        assert (app.run_controller.timeline.at, app.run_controller.timeline.newest) == (
            at + 1,
            newest,
        )
        await pilot.press("space")
        await until(
            pilot,
            lambda: (
                app.run_controller.state == RunPhase.RUNNING
                and app.run_controller.timeline.newest > newest
            ),
        )
        assert not app.run_controller.in_past
        await pilot.press("S")
        await until_state(pilot, RunPhase.ENDED)


@pytest.mark.slow
async def test_clicking_a_panel_while_looking_at_the_past_keeps_the_instant() -> None:
    async with a_run() as (pilot, app):
        world = app.panel_area.world
        assert world is not None
        await until(
            pilot, lambda: world.time_bar._times is not None and world.time_bar.region.width > 0
        )
        await pilot.click(world.time_bar, offset=(20, 0))
        await until(pilot, lambda: app.run_controller.in_past)
        at = app.run_controller.timeline.at
        await until(
            pilot,
            lambda: f"past {app.run_controller.timeline.time_s:.2f} s" in screen_text(app),
        )
        await pilot.click("Instrumentation", offset=(5, 1))
        assert app.run_controller.timeline.at == at


async def test_go_to_explains_words_that_name_no_instant() -> None:
    table = {
        "": "no instant",
        "tomorrow": "not an instant",
        "9999": "run has reached",
        "tick 99999": "run has reached",
        "line 99": "no line 99",
        "sample Nothing": "there are Colour",
        "sample colour": "did you mean Colour?",
        "colour": "did you mean `Colour < 50` or `sample Colour`?",
        "Colour": "did you mean `Colour < 50` or `sample Colour`?",
        "left_red": "did you mean `left_red < 50`?",
        "colour < 50": "this run has no 'colour' (did you mean Colour?)",
        "sample Colour < zero": "is not a number",
        "print [": "not a regular expression",
        "print never": "nothing printed",
        "sample Colour < -5": "no sample",
        "line 1": "does not run after",
        "tick -1": "not an instant",
        "sample Colour < 1.2.3": "is not a number",
    }
    async with a_run() as (_, app):
        app.run_controller.timeline.go(200)
        for text, answer in table.items():
            with pytest.raises(ConfigError, match=re.escape(answer)):
                find(text, app.run_controller.timeline)


@pytest.mark.slow
async def test_go_to_finds_the_instant_that_its_words_name() -> None:
    async with a_run(PEN) as (_, app):
        timeline = app.run_controller.timeline
        recording = app.run_controller.timeline.recording
        assert recording is not None
        rows = list(recording.rows.rows(0))
        dark = next(
            row.tick for row in rows if row.text.startswith("Colour: ") and float(row.text[8:]) < 90
        )
        waits = next(tick for tick in range(1, 400) if recording.telemetry.record(tick).line == 9)
        values = [
            (row.tick, float(row.text[8:])) for row in rows if row.text.startswith("Colour: ")
        ]
        changed = [tick for (_, before), (tick, value) in pairwise(values) if before != value]
        table = {
            "3.5": 350,
            " 3.5 s": 350,
            "3.5s": 350,
            "tick 120": 120,
            "start": 0,
            "end": timeline.newest,
            "sample Colour < 90": dark,
            "print off": rows[1].tick,
            "line 9": waits,
            "line 4 back": None,
            "sample back": None,
            "sample": rows[0].tick,
            "print matches off": rows[1].tick,
            "Colour < 90 first": dark,
            "sample Colour changes": changed[0],
        }
        for text, tick in table.items():
            timeline.go(0)
            if tick is None:
                with pytest.raises(ConfigError, match=re.escape("before 0.00 s")):
                    find(text, timeline)
            else:
                assert find(text, timeline) == tick, text
        newest = max(row.tick for row in rows)
        timeline.go(None)
        # At the end there is nothing after.
        assert find("sample Colour", timeline) == find("sample", timeline) == newest
        assert (
            find("sample Colour < 90 first", timeline)
            == find("first sample Colour < 90", timeline)
            == dark
        )
        assert find("sample Colour < 90", timeline, first_at_end=True) == dark
        assert find("back sample Colour", timeline, first_at_end=True) == newest
        timeline.go(dark)
        assert find("sample Colour changes back", timeline) == max(
            tick for tick in changed if tick < dark
        )
        assert find("sample Colour back", timeline) == max(r.tick for r in rows if r.tick < dark)
        assert find("sample", timeline) == min(r.tick for r in rows if r.tick > dark)


@pytest.mark.slow
async def test_commands_to_motors_are_marked_on_the_timeline_found_and_described() -> None:
    async with a_run() as (pilot, app):
        timeline = app.run_controller.timeline
        commands = recording_of(app).commands
        ticks = [commands.tick(number) for number in commands.find_events()]
        assert len(ticks) >= 2 and (ticks[0], Mark.COMMAND) in timeline.list_marks()
        stops = [commands.tick(number) for number in commands.find_events("stop")]
        timeline.go(1)
        assert find("command stop", timeline) == min(tick for tick in stops if tick > 1)
        assert find("command back", timeline) == max(tick for tick in ticks if tick < 1)
        with pytest.raises(ConfigError, match=re.escape("no command pen after 0.01 s")):
            find("command pen", timeline)
        await pilot.press("g")
        app.screen.query_one(Input).value = "command right run first"
        await pilot.press("enter")
        asked = "0.01 s, right motor C: run 525 °/s → mean 495 °/s"
        await until(pilot, lambda: asked in notices(app))


@pytest.mark.slow
async def test_go_to_finds_the_first_tick_at_which_a_columns_condition_holds() -> None:
    async with a_run() as (_, app):
        timeline = app.run_controller.timeline
        telemetry = recording_of(app).telemetry
        mat = app.run_controller.mat
        assert mat is not None
        there = next(tick for tick in range(400) if telemetry.record(tick).x_mm > 300)
        assert find("x_mm > 300 first", timeline, mat.field) == there


@pytest.mark.slow
async def test_go_to_says_what_is_wrong_and_keys_go_from_sample_to_sample() -> None:
    async with a_run() as (pilot, app):
        await pilot.press("g")
        app.screen.query_one(Input).value = "nowhere"
        await pilot.press("enter")
        await until_shown(pilot, "'nowhere' is not an instant")
        await pilot.press("escape", "home")
        recording = recording_of(app)
        ticks = sorted({row.tick for row in recording.rows.rows(0)})
        await pilot.press(
            "right_parenthesis", "right_parenthesis", "right_parenthesis", "left_parenthesis"
        )
        assert app.run_controller.timeline.at == ticks[1]


async def test_a_refusal_in_the_go_to_dialog_leaves_its_keys_in_view() -> None:
    async with a_run(size=(80, 24)) as (pilot, app):
        await pilot.press("g")
        app.screen.query_one(Input).value = "nowhere"
        await pilot.press("enter")
        await until_shown(pilot, "'nowhere' is not an instant")
        frame = app.screen.query_one(".dialog").region
        assert frame.bottom < app.size.height
        assert "enter apply" in screen_text(app).splitlines()[-1]


def test_a_timeline_without_a_run_stands_still() -> None:
    timeline = Timeline()
    timeline.go(timeline.tick - 1)
    assert (timeline.at, timeline.record(), timeline.list_marks()) == (None, None, [])
    assert not timeline.advance_playback(1.0, 1.0)
    with pytest.raises(ConfigError, match="no run yet"):
        find("1", timeline)
