"""The key that asks where a run went wrong, and the order in which it goes through the reasons."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import (
    notices,
    open_lab,
    ready,
    run_from_start,
    screen_text,
    settings,
    until,
    until_state,
)
from tests.cases import cases
from tuisim.app import reasons
from tuisim.app.actions.time_travel import go_to_tick, go_wrong
from tuisim.app.app import LabApp
from tuisim.app.notices import NoticeRow
from tuisim.app.reason_tour import ReasonTour
from tuisim.app.snapshot import RunPhase
from tuisim.engine.runs.handle import RunOptions
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.reasons.reason import Reason, ReasonKind

STRAIGHT = "tank_drive.on_for_seconds(20, 20, 1)\n"
SIZE = (120, 40)


async def ask(pilot: Pilot[None], app: LabApp, words: str) -> None:
    """Press the key; wait for a new notice with some words."""
    known = len(notices(app))
    await pilot.press("exclamation_mark")
    await until(pilot, lambda: any(words in text for text in notices(app)[known:]), words)


@pytest.mark.slow
async def test_the_key_goes_to_each_reason_and_back_to_the_end() -> None:
    text = "tank_drive.on_for_seconds(20, int(input()), 1)\nprint(colour)\n"
    async with open_lab(STRAIGHT, speed=0.0, size=SIZE) as (pilot, app):
        await run_from_start(pilot, app, STRAIGHT)
        await ask(pilot, app, "lost line found")

        def has_reasons(count: int) -> bool:
            return len(app.context.reasons.reasons) == count

        for speed, kinds in (("20", 1), ("10", 2)):
            app.run_controller.next_options = RunOptions(live=True, speed=0.0, answers=(speed,))
            await run_from_start(pilot, app, text)
            # The way of the former text is no measure, that of the same text is one.
            await until(pilot, partial(has_reasons, kinds))
        await ask(pilot, app, "1.00 s, line 2: NameError: name 'colour' is not defined")
        timeline = app.run_controller.timeline
        assert not app.run_controller.in_past
        await ask(pilot, app, "the robot left the path of run")
        assert timeline.at is not None
        assert 0 < timeline.tick < 30
        assert app.run_controller.build_snapshot().earlier_pose is not None
        await ask(pilot, app, "This is the end of the run again; ! goes to the first reason")
        assert timeline.at is None


LEAVES_THE_MAT = """\
while True:
    if colorLeft.reflected_light_intensity_pc < 101:
        tank_drive.on(SpeedPercent(60), SpeedPercent(60))
    if colorLeft.reflected_light_intensity_pc < 101:
        pass
"""


@pytest.mark.slow
async def test_the_notice_of_what_went_wrong_stays_until_a_key_does_something() -> None:
    async with LabApp(settings(STRAIGHT, speed=0.0)).run_test(
        size=SIZE, notifications=True
    ) as pilot:
        app = await ready(pilot)
        await run_from_start(pilot, app, "tank_drive.on_for_seconds(20, 20, 1)\nprint(colour)\n")

        def stays() -> bool:
            return any(row.notice.stays for row in app.query(NoticeRow))

        await ask(pilot, app, "NameError")
        await until(pilot, stays)
        await pilot.press("comma")
        await until(pilot, lambda: not stays())


@pytest.mark.slow
async def test_the_arrow_in_the_code_stays_on_the_line_of_the_reason() -> None:
    async with open_lab(LEAVES_THE_MAT, speed=0.0, size=SIZE) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: app.run_controller.build_snapshot().time_s > 20.0)
        await pilot.press("S")
        await until_state(pilot, RunPhase.ENDED)
        await until(pilot, lambda: bool(app.context.reasons.reasons))
        for reason in app.context.reasons.reasons:
            await ask(pilot, app, reason.words)
            if app.run_controller.in_past:
                await until(pilot, lambda: app.debugger.view is not None and not app.debugger.busy)
                assert app.debugger.view is not None
                assert app.debugger.current_line == reason.line
                assert app.debugger.view.paused.line == reason.line
        await pilot.press("comma")
        await until(pilot, lambda: app.run_controller.chosen_line is None)


@pytest.mark.slow
async def test_the_variables_of_the_line_that_raised_are_shown_at_the_end_of_the_run() -> None:
    mean = "def mean(a, b):\n    return a / b\n\nmean(7, 0)\n"
    async with open_lab(mean, speed=0.0, size=SIZE) as (pilot, app):
        await run_from_start(pilot, app, mean)
        await pilot.press("G")
        await ask(pilot, app, "ZeroDivisionError")
        await until(pilot, lambda: app.debugger.view is not None)
        view = app.debugger.view
        assert view is not None
        assert [(each.name, each.value) for each in view.inspected.variables] == [
            ("a", "7"),
            ("b", "0"),
        ]
        assert not app.run_controller.in_past
        assert not app.debugger.is_away


async def test_after_a_run_that_went_wrong_the_footer_names_it() -> None:
    async with open_lab(STRAIGHT, speed=0.0, size=SIZE) as (pilot, app):
        assert "! wrong?" not in screen_text(app)
        await run_from_start(pilot, app, "print(colour)\n")
        await until(pilot, lambda: "! wrong?" in screen_text(app))
        assert "│ d edit l analyse" in screen_text(app)
        assert "! goes there" in screen_text(app)


GOALS = """\
background = "Grey_bands"

[[goal]]
name = "far"
say = "Drive far."
pass = { places_mm = [[1700, 500]], within_mm = 40 }
"""


@pytest.mark.slow
async def test_missed_goals_of_the_open_goal_file_are_among_the_reasons(tmp_path: Path) -> None:
    path = tmp_path / "task_goals.toml"
    path.write_text(GOALS, encoding="utf-8")
    async with open_lab(STRAIGHT, speed=0.0, size=SIZE) as (pilot, app):
        await run_from_start(pilot, app, STRAIGHT)
        app.goals.change(GoalsFile.load(path))
        await ask(pilot, app, "a goal was missed: ")


def test_reasons_of_a_run_that_ended_while_they_were_looked_for_are_looked_for_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    runs = SimpleNamespace(
        timeline=SimpleNamespace(recording=SimpleNamespace(newest=1), at=None),
        in_run=True,
        earlier=None,
        pause=lambda: None,
    )
    document = SimpleNamespace(go_to_mistake=str)
    app = SimpleNamespace(answer=lambda _: None)
    context: Any = SimpleNamespace(runs=runs, document=document, reasons=ReasonTour(), app=app)
    searches: list[bool] = []

    def end_meanwhile(*given: Any, **_: Any) -> None:
        searches.append(runs.in_run)
        if runs.in_run:
            runs.in_run = False
            given[3](((), None))

    monkeypatch.setattr(reasons, "find", end_meanwhile)
    go_wrong(context)
    assert searches == [True, False]
    assert context.reasons.is_about(runs.timeline.recording, has_ended=True)


def test_a_press_while_a_reason_is_looked_for_says_so_and_skips_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    runs = SimpleNamespace(
        timeline=SimpleNamespace(recording=SimpleNamespace(newest=1), at=None),
        in_run=False,
        earlier=None,
        pause=lambda: None,
    )
    answers: list[str] = []
    context: Any = SimpleNamespace(
        runs=runs,
        document=SimpleNamespace(go_to_mistake=str),
        reasons=ReasonTour(),
        app=SimpleNamespace(answer=answers.append),
    )
    searches: list[Any] = []
    monkeypatch.setattr(reasons, "find", lambda *given, **_: searches.append(given[3]))
    go_wrong(context)
    go_wrong(context)
    assert len(searches) == 1
    assert answers == ["Looking for what went wrong …"] * 2


def test_an_answer_after_a_move_in_time_leaves_the_view_where_it_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    recording = SimpleNamespace(newest=1)
    runs = SimpleNamespace(
        timeline=SimpleNamespace(recording=recording, at=None),
        in_run=False,
        earlier=None,
        pause=lambda: None,
    )
    answers: list[str] = []
    moves: list[int | None] = []
    app = SimpleNamespace(
        answer=answers.append,
        notices=SimpleNamespace(release=lambda: None),
        handle_situation_change=lambda: None,
        draw=lambda force: None,
    )
    context: Any = SimpleNamespace(
        runs=runs,
        document=SimpleNamespace(go_to_mistake=str),
        debugger=SimpleNamespace(go_to_now=lambda: None),
        reasons=ReasonTour(),
        app=app,
    )
    runs.timeline.go = moves.append
    searches: list[Any] = []
    monkeypatch.setattr(reasons, "find", lambda *given, **_: searches.append(given[3]))
    go_wrong(context)
    go_to_tick(context, None)
    searches[0](((Reason(ReasonKind.LOST, 0.5, 1, "it left the line"),), None))
    assert moves == [None]
    assert answers[-1] == "1 reason found: {went-wrong} goes to the first"


WAITS = """\
from ev3dev2.button import Button
brick = Button()
while not brick.any():
    pass
"""
NEVER = """\
import time
while True:
    x = time.time()
    if x < 1 and x > 2:
        break
    time.sleep(0.1)
"""
SLEEPS = "import time\nwhile True:\n    time.sleep(9)\n"


@pytest.mark.slow
@cases(
    "text, words",
    {
        "it waits": (
            WAITS,
            "So far: 0.00 s, line 3: from here on it waits: read the brick's buttons",
        ),
        "it sleeps": (SLEEPS, "the robot stands still in line"),
        "its condition is never true": (NEVER, "x < 1 and x > 2"),
    },
)
async def test_a_program_that_goes_on_is_paused_and_it_says_what_that_waits_for(
    text: str, words: str
) -> None:
    # At full speed, a program that only sleeps would reach the limit of a run before the key is pressed.
    async with open_lab(text, speed=16.0, size=SIZE) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: app.run_controller.build_snapshot().time_s > 20.0)
        assert "! wrong?" in screen_text(app)
        await ask(pilot, app, words)
        await until_state(pilot, RunPhase.PAUSED)
        await pilot.press("S")
        await until_state(pilot, RunPhase.ENDED)


async def test_the_line_that_a_reason_names_is_shown_also_where_the_code_was_hidden() -> None:
    long = "x = 1\n" * 40 + "tank_drive.on_for_seconds(90, 90, 9)\n"
    async with open_lab(long, speed=0.0, size=(80, 24)) as (pilot, app):
        await run_from_start(pilot, app, long)
        assert not app.panel_area.is_shown("code")
        await ask(pilot, app, "line 41: the robot left the mat")
        await until(pilot, lambda: "▶41 tank_drive.on_for" in screen_text(app))
        assert app.panel_area.code is not None
        assert app.panel_area.code.cursor_line == 41
