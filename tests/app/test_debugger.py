"""Stepping, breaks and looks in the app, now and in the past."""

from __future__ import annotations

from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input, OptionList, Static

from tests.app.app_help import (
    notices,
    open_lab,
    press_and_stand,
    program_of,
    ready,
    screen_text,
    settings,
    until,
    until_typing,
)
from tuisim.app.app import LabApp
from tuisim.app.dialogs.question import BranchQuestion
from tuisim.app.kept_breaks import StoredBreaks, keep, load_kept
from tuisim.app.panels.chart import Chart
from tuisim.app.snapshot import RunPhase
from tuisim.engine.breakpoints import parse_breakpoints
from tuisim.engine.protocol import Inspected

COUNTS = """\
import time
total = 0
for i in range(50):
    total = total + i
    time.sleep(0.05)
    print('Total: ' + str(total))
print('done')
"""
CALLS = """\
import time
def outer(n):
    local = n + 1
    inner(local)
    return local

def inner(m):
    time.sleep(0.1)
    return m

outer(1)
print('done')
"""


def line(app: LabApp) -> int:
    assert app.debugger.view is not None
    return app.debugger.view.paused.line


def looked(app: LabApp) -> Inspected:
    assert app.debugger.view is not None
    return app.debugger.view.inspected


def values(app: LabApp) -> dict[str, str]:
    return {one.name: one.value for one in looked(app).variables}


def cursor_to(app: LabApp, line: int) -> None:
    """Put the cursor of the code panel on a line, counted from 1."""
    assert app.panel_area.code is not None
    app.panel_area.code._area.move_cursor((line - 1, 0))


async def stands(pilot: Pilot[Any], app: LabApp, at: int) -> None:
    """Wait until the program stands at a line and has been looked at."""
    await until(
        pilot, lambda: app.debugger.view is not None and line(app) == at and not app.debugger.busy
    )


async def press(pilot: Pilot[Any], app: LabApp, key: str, *lines: int) -> None:
    """Press a key again and again; it leads to these lines."""
    for at in lines:
        await press_and_stand(pilot, key)
        await stands(pilot, app, at)


def drawn(app: LabApp) -> str:
    panel = app.panel_area.debug
    return "\n".join("".join(text for text, _ in row) for row in (panel._lines if panel else ()))


@pytest.mark.slow
async def test_stepping_starts_at_the_first_line_and_shows_line_and_variables() -> None:
    async with open_lab(COUNTS) as (pilot, app):
        await press(pilot, app, "n", 1, 2, 3, 4, 5)
        assert values(app) == {"total": "0", "i": "0"}
        assert app.run_controller.build_snapshot().line == 5
        assert app.panel_area.is_shown("debug")
        await press(pilot, app, "n", 6, 3, 4)
        assert values(app)["i"] == "1"
        await until(pilot, lambda: "line 4" in drawn(app))


@pytest.mark.slow
async def test_a_stepped_print_is_seen_where_the_output_gives_way_to_the_variables() -> None:
    async with open_lab(COUNTS, size=(80, 24)) as (pilot, app):
        await press(pilot, app, "n", 1, 2, 3, 4, 5, 6, 3)
        debug = app.panel_area.debug
        assert debug is not None
        assert not app.panel_area.is_shown("output")
        await until(pilot, lambda: debug.border_subtitle == "printed Total: 0")
        await press(pilot, app, "n", 4, 5, 6, 3)
        await until(pilot, lambda: debug.border_subtitle == "printed Total: 1")
        await press(pilot, app, "N", 6, 5)
        await until(pilot, lambda: debug.border_subtitle == "printed Total: 0")
        await pilot.press("O")
        await until(pilot, lambda: not debug.border_subtitle)


@pytest.mark.slow
async def test_quick_presses_of_the_step_key_are_all_counted() -> None:
    async with open_lab(COUNTS) as (pilot, app):
        await pilot.press(*"nnnnn")
        await stands(pilot, app, 5)
        await until(pilot, lambda: "line 5" in drawn(app))
        await pilot.press(*"nnn")
        await stands(pilot, app, 4)
        assert values(app) == {"total": "0", "i": "1"}
        await pilot.press("N")
        await pilot.press(*"nnnn")
        # One of them leads back to now, and the others on from there.
        await stands(pilot, app, 3)
        await until(pilot, lambda: not app.debugger.is_away)
        assert values(app) == {"total": "1", "i": "1"}


@pytest.mark.slow
async def test_stepping_back_a_line_shows_its_values_again() -> None:
    async with open_lab(COUNTS) as (pilot, app):
        await press(pilot, app, "n", 1, 2, 3, 4, 5, 6, 3, 4, 5, 6)
        assert values(app)["total"] == "1"
        await press(pilot, app, "N", 5, 4)
        assert values(app)["total"] == "0"
        assert app.debugger.looks_back
        await until(pilot, lambda: "past" in drawn(app))
        await press(pilot, app, "n", 5)
        assert values(app)["total"] == "1"
        await pilot.press("end")
        await until(pilot, lambda: not app.debugger.looks_back and app.debugger.view is not None)
        assert line(app) == 6
        await press(pilot, app, "n", 3)


@pytest.mark.slow
async def test_looking_at_an_earlier_line_keys_ask_for_a_branch_and_move_no_robot() -> None:
    async with open_lab(COUNTS) as (pilot, app):
        await press(pilot, app, "n", 1, 2, 3)
        await press(pilot, app, "N", 2)
        assert app.debugger.looks_back and not app.run_controller.in_past
        pose = app.run_controller.pose
        app.panel_area.focus_world()
        await pilot.press("a")
        await until(pilot, lambda: isinstance(app.screen, BranchQuestion))
        assert app.run_controller.pose == pose


@pytest.mark.slow
@pytest.mark.parametrize("key", ["n", "u"], ids=["a line on", "on to the end of the program"])
async def test_resuming_from_a_past_line_stops_at_the_present_one(home: object, key: str) -> None:
    async with open_lab(COUNTS) as (pilot, app):
        await press(pilot, app, "n", 1, 2, 3, 4, 5, 6)
        await press(pilot, app, "N", 5)
        await until(pilot, lambda: "past" in drawn(app))
        await press(pilot, app, key, 6)
        assert not app.debugger.is_away
        await until(pilot, lambda: "past" not in drawn(app) and "…" not in drawn(app))
        await press(pilot, app, "n", 3)


@pytest.mark.slow
async def test_steps_go_into_calls_and_out_of_them() -> None:
    async with open_lab(CALLS) as (pilot, app):
        await press(pilot, app, "n", 1, 2, 7, 11)
        await press(pilot, app, "s", 3, 4, 8)
        assert [frame.function for frame in looked(app).stack] == ["inner", "outer", "<module>"]
        assert values(app) == {"m": "2"}
        await pilot.press("tab")
        assert app.panel_area.debug is not None
        app.panel_area.debug.focus()
        await pilot.press("right")
        await until(pilot, lambda: values(app) == {"n": "1", "local": "2"})
        await pilot.press("u")
        await stands(pilot, app, 5)


@pytest.mark.slow
async def test_a_breakpoint_pauses_the_run_and_is_stored_with_the_program() -> None:
    async with open_lab(COUNTS) as (pilot, app):
        # It belongs to a line that the user sees: the first press goes to the code.
        await pilot.press("t")
        assert not app.debugger.breaks
        cursor_to(app, 5)
        await pilot.press("t")
        assert [one.text for one in app.debugger.breaks] == ["5"]
        assert "Breakpoint on line 5, where the cursor is" in notices(app)
        await pilot.press("R")
        await stands(pilot, app, 5)
        assert any("Break 5" in text for text in notices(app))
        await pilot.press("space")
        await until(pilot, lambda: app.debugger.view is not None and values(app).get("i") == "1")
        await pilot.press("t", "space")
        await until(pilot, lambda: not app.run_controller.in_run)
        await pilot.press("t")
    async with open_lab(COUNTS) as (pilot, app):
        await until(pilot, lambda: [one.text for one in app.debugger.breaks] == ["5"])


async def test_a_breakpoint_on_the_current_line_needs_no_code_in_sight() -> None:
    async with open_lab(COUNTS, size=(80, 24)) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: app.run_controller.build_snapshot().line >= 3)
        await press_and_stand(pilot, "space")
        current = app.debugger.current_line
        assert not app.panel_area.is_shown("code")
        await pilot.press("t")
        assert [one.text for one in app.debugger.breaks] == [str(current)]
        assert f"Breakpoint on line {current}, the current one" in notices(app)
        assert not app.panel_area.is_shown("code")


@pytest.mark.slow
async def test_the_footer_offers_what_is_needed_while_the_code_is_read() -> None:
    async with open_lab(COUNTS, size=(80, 24)) as (pilot, app):
        await press(pilot, app, "n", 1, 2)
        assert app.panel_area.find_focused_panel() == "code"
        shown = str(app.key_footer.render())
        assert "N line back" in shown
        assert "u out" in shown
        # Where there is room for more.
        await pilot.resize_terminal(200, 60)
        await until(pilot, lambda: "L to cursor" in str(app.key_footer.render()))


@pytest.mark.slow
async def test_breaks_and_watches_are_listed_added_switched_and_deleted() -> None:
    async with open_lab(COUNTS) as (pilot, app):
        await pilot.press("T")
        await pilot.pause()
        field = app.screen.query_one(Input)
        for text in ("4 if i ==", "99", "sample Total > 5", "4 if i == 3"):
            field.value = text
            await pilot.press("enter")
            message = str(app.screen.query_one("#message", Static).render())
            assert ("line 99 does not exist (the program has 7 lines)" in message) is (text == "99")
        assert "no expression" not in str(app.screen.query_one("#message", Static).render())
        assert [one.text for one in app.debugger.breaks] == ["sample Total > 5", "4 if i == 3"]
        app.screen.query_one(OptionList).focus()
        await pilot.press("home", "space")
        assert app.debugger.breaks[0].disabled
        await pilot.press("delete", "escape")
        assert [one.written() for one in app.debugger.breaks] == ["4 if i == 3"]
        await pilot.press("w")
        await pilot.pause()
        app.screen.query_one(Input).value = "total * 2"
        await pilot.press("enter", "escape", "R")
        await stands(pilot, app, 4)
        assert values(app) == {"total": "3", "i": "3"}
        assert [(watch.text, watch.value) for watch in looked(app).watches] == [("total * 2", "6")]


@pytest.mark.slow
async def test_variables_of_any_past_instant_are_shown() -> None:
    async with open_lab(COUNTS, speed=0.0) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: app.run_controller.state == "ended")
        # Beside the code also without the debug panel.
        app.run_controller.timeline.go(21)
        await until(pilot, lambda: app.debugger.view is not None and not app.debugger.busy)
        assert values(app) == {"total": "10", "i": "4"}
        await pilot.press("G")
        app.run_controller.timeline.go(42)
        await until(
            pilot, lambda: values(app) == {"total": "36", "i": "8"} and not app.debugger.busy
        )
        await until(pilot, lambda: "sleeps until 0.45 s" in drawn(app))
        app.run_controller.timeline.go(7)
        await until(pilot, lambda: values(app) == {"total": "1", "i": "1"})
        await press(pilot, app, "n", 6)
        assert app.run_controller.timeline.at == 10
        await pilot.press("L")
        await until(pilot, lambda: not app.debugger.busy)
        await pilot.press("end")
        await until(pilot, lambda: app.debugger.view is None)


@pytest.mark.slow
async def test_selecting_a_sample_shows_the_line_that_printed_it_in_code_and_debugger() -> None:
    async with open_lab(COUNTS, speed=0.0) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: app.run_controller.state == "ended")
        await pilot.press("G")
        app.run_controller.timeline.go(20)
        await stands(pilot, app, 5)
        app.panel_area.post_message(Chart.CursorMoved(0.2, "Total"))
        await stands(pilot, app, 6)
        snapshot = app.run_controller.build_snapshot()
        assert (snapshot.instant.tick, snapshot.line, line(app)) == (20, 6, 6)
        await until(pilot, lambda: "line 6" in drawn(app))
        # From there it goes on.
        await press(pilot, app, "n", 3)
        assert app.run_controller.build_snapshot().line == 3


@pytest.mark.slow
async def test_run_to_the_cursor_starts_the_program() -> None:
    async with open_lab(COUNTS) as (pilot, app):
        cursor_to(app, 6)
        await pilot.press("L")
        await stands(pilot, app, 6)
        await pilot.press("S")
        await until(pilot, lambda: not app.run_controller.in_run)


@pytest.mark.slow
async def test_breakpoints_are_stored_also_while_no_panel_shows_the_program() -> None:
    app = LabApp(settings(COUNTS, panels_off=("code", "controls")))
    keep(program_of(app).path, StoredBreaks(parse_breakpoints(("4",)), ("total",)))
    async with app.run_test(size=(80, 24)) as pilot:
        await ready(pilot)
        await until(pilot, lambda: bool(app.debugger.breaks))
        assert (app.panel_area.code, app.debugger.watches) == (None, ("total",))
        app.debugger.set_breaks(parse_breakpoints(("4", "6")))
        assert load_kept(program_of(app).path).breaks == app.debugger.breaks
        await pilot.press("D")
        await until(pilot, lambda: app.panel_area.code is not None)
        assert [one.text for one in app.debugger.breaks] == ["4", "6"]


@pytest.mark.slow
async def test_editing_begins_where_the_program_is_paused() -> None:
    async with open_lab(COUNTS, size=(80, 24)) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: app.run_controller.build_snapshot().state is RunPhase.RUNNING)
        await pilot.press("space")
        await until(pilot, lambda: app.run_controller.build_snapshot().state is RunPhase.PAUSED)
        # A panel that is opened has seen nothing of the run.
        assert not app.panel_area.is_shown("code")
        await pilot.press("d")
        await until_typing(pilot)
        assert app.panel_area.code is not None
        assert app.panel_area.code.cursor_line == app.run_controller.build_snapshot().line > 1


@pytest.mark.slow
async def test_a_step_back_has_the_time_of_its_tick() -> None:
    text = "import time\ntime.sleep(0.0199)\nx = 1\ntime.sleep(1)\ny = 2\n"
    async with open_lab(text, speed=0.0) as (pilot, app):
        await press(pilot, app, "n", 1, 2, 3, 4)
        await press(pilot, app, "N", 3)
        assert app.debugger.view is not None
        paused = app.debugger.view.paused
        snapshot = app.run_controller.build_snapshot()
        assert paused.tick == snapshot.instant.tick
        assert paused.time_ns / 1e9 == snapshot.time_s


@pytest.mark.slow
async def test_a_breakpoint_without_a_line_is_told_of_before_it_pauses_a_run() -> None:
    opened = settings(COUNTS)
    async with open_lab(opened) as (pilot, app):
        assert app.panel_area.code is not None
        app.debugger.set_breaks(parse_breakpoints(("4", "time 3.5")))
        await until(pilot, lambda: "2 breakpoints: T" in screen_text(app))
        app.debugger.set_breaks(parse_breakpoints(("4", "# time 3.5")))
        await until(pilot, lambda: "2 breakpoints" not in screen_text(app))
    async with open_lab(opened, size=(80, 24)) as (pilot, app):
        app.debugger.set_breaks(parse_breakpoints(("time 3.5",)))
        await pilot.press("R")
        await until(pilot, lambda: "1 breakpoint: T" in notices(app))
