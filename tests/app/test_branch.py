"""Branches: the same run again up to an instant, and then another future."""

from __future__ import annotations

from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import (
    notices,
    open_lab,
    program,
    screen_text,
    until,
    until_shown,
    until_state,
)
from tuisim.app.actions.time_travel import go_to_tick
from tuisim.app.app import LabApp
from tuisim.app.dialogs.runs import parse_branch_root
from tuisim.app.snapshot import RunPhase
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import NoiseSpec
from tuisim.engine.runs.catalogue import RunInfo
from tuisim.engine.runs.store import RunStore

DRIVES = """\
import threading, time, random
def says():
    for n in range(400):
        time.sleep(0.05)
        print('N: ' + str(n * random.random()))
threading.Thread(target=says, daemon=True).start()
while True:
    tank_drive.on(SpeedPercent(20 + colorLeft.reflected_light_intensity_pc / 5), SpeedPercent(20))
"""


@asynccontextmanager
async def open_with_a_past(ticks: int = 300) -> AsyncIterator[tuple[Pilot[Any], LabApp]]:
    """Let a program run with noise and a user who meddles."""
    async with open_lab(DRIVES, autorun=True, speed=4.0) as (pilot, app):
        await until(pilot, lambda: app.run_controller.timeline.newest > ticks // 4)
        app.run_controller.set_noise(NoiseSpec(30, 20))
        await until(pilot, lambda: app.run_controller.timeline.newest > ticks // 2)
        app.run_controller.place(Pose(500, 700, 45))
        await until(pilot, lambda: app.run_controller.timeline.newest > ticks)
        yield pilot, app


async def stop(pilot: Pilot[Any], app: LabApp) -> None:
    await pilot.press("S")
    await until_state(pilot, RunPhase.ENDED)


def telemetry(run_id: str) -> Any:
    return RunStore().load_run(run_id).telemetry.array()


Deed = Callable[[Pilot[Any], LabApp], Awaitable[object]]


async def _nudge(pilot: Pilot[Any], app: LabApp) -> None:
    await pilot.press("up")


async def _noise(pilot: Pilot[Any], app: LabApp) -> None:
    app.run_controller.set_noise(NoiseSpec(100, 0))


async def _pen(pilot: Pilot[Any], app: LabApp) -> None:
    await pilot.press("p")


async def _nothing(pilot: Pilot[Any], app: LabApp) -> None:
    await pilot.press("y")


@pytest.mark.slow
@pytest.mark.parametrize(
    "deed, kind",
    [
        (_nudge, "set_pose"),
        (_noise, "set_noise"),
        (_pen, "set_pen"),
        (_nothing, ""),
    ],
    ids=["nudge", "noise", "pen", "branch key"],
)
async def test_a_branch_has_the_same_records_as_its_run_up_to_the_branching_instant(
    deed: Deed, kind: str
) -> None:
    async with open_with_a_past() as (pilot, app):
        await stop(pilot, app)
        first = app.run_controller.run_id
        go_to_tick(app.context, 260)
        await deed(pilot, app)
        await until_shown(pilot, "Branch from 2.60 s?")
        await pilot.press("y")
        await until(
            pilot,
            lambda: app.run_controller.run_id != first and app.run_controller.timeline.newest > 300,
        )
        await stop(pilot, app)
        branch = RunStore().load_run(app.run_controller.run_id)
        old, new = telemetry(first), branch.telemetry.array()
        assert old[:260].tobytes() == new[:260].tobytes()
        assert branch.tags == ("branch-of-1", "at-2.60s")
        done = [(action.tick, action.command.kind) for action in branch.actions]
        before = [
            (a.tick, a.command.kind) for a in RunStore().load_run(first).actions if a.tick <= 260
        ]
        assert done == before + ([(260, kind)] if kind else [])
        assert any("branch of run 1 at 2.60 s" in notice for notice in notices(app))
        if not kind:
            # On a slow machine some of what the user did comes later than the branch.
            later = [
                a.tick
                for run in (RunStore().load_run(first), branch)
                for a in run.actions
                if a.tick > 260
            ]
            both = min(len(old), len(new), *later)
            assert both > 260
            assert old[:both].tobytes() == new[:both].tobytes()


@pytest.mark.slow
async def test_branching_from_a_paused_run_stores_it_and_starts_the_branch_paused() -> None:
    async with open_with_a_past() as (pilot, app):
        first = app.run_controller.run_id
        await pilot.press("space", "less_than_sign")
        await until_state(pilot, RunPhase.PAUSED)
        at = app.run_controller.timeline.at
        assert at is not None
        await pilot.press("R")
        await until_shown(pilot, "ends now and is stored")
        await pilot.press("n")
        assert app.run_controller.timeline.at == at
        await pilot.press("y")
        await until_shown(pilot, "Branch from")
        await pilot.press("y")
        await until(
            pilot,
            lambda: (
                app.run_controller.run_id != first and app.run_controller.state == RunPhase.PAUSED
            ),
        )
        assert app.run_controller.timeline.newest == at
        assert not app.run_controller.in_past
        assert RunStore().load_run(first).state == "stopped"
        await pilot.press("space")
        await until(
            pilot,
            lambda: (
                app.run_controller.state == RunPhase.RUNNING
                and app.run_controller.timeline.newest > at
            ),
        )
        await stop(pilot, app)


@pytest.mark.slow
async def test_a_branch_of_an_edited_program_says_where_it_first_differs() -> None:
    async with open_with_a_past() as (pilot, app):
        await stop(pilot, app)
        first = app.run_controller.run_id
        app.run_controller.program = program(
            DRIVES.replace("    tank_drive.on(", "    time.sleep(1)\n    tank_drive.on(")
        )
        go_to_tick(app.context, 260)
        await pilot.press("R")
        await until_shown(pilot, "The edited program")
        await pilot.press("y")
        await until(
            pilot,
            lambda: app.run_controller.run_id != first and app.run_controller.timeline.newest > 260,
        )
        await until(pilot, lambda: any("it differs from 0." in notice for notice in notices(app)))
        await stop(pilot, app)


@pytest.mark.slow
async def test_from_the_past_the_program_can_be_run_from_its_start() -> None:
    async with open_with_a_past(ticks=80) as (pilot, app):
        first = app.run_controller.run_id
        await pilot.press("less_than_sign", "R")
        await until(pilot, lambda: len(app.screen_stack) == 2)
        await pilot.press("r")
        await until(
            pilot,
            lambda: (
                app.run_controller.run_id != first and app.run_controller.state == RunPhase.RUNNING
            ),
        )
        assert not app.run_controller.in_past
        await until(pilot, lambda: app.run_controller.timeline.newest > 5)
        assert not RunStore().load_run(app.run_controller.run_id).tags
        await stop(pilot, app)


@pytest.mark.slow
async def test_a_branch_whose_program_ends_before_the_instant_says_so() -> None:
    async with open_with_a_past(ticks=100) as (pilot, app):
        await stop(pilot, app)
        first = app.run_controller.run_id
        app.run_controller.program = program("tank_drive.on_for_seconds(20, 20, 0.2)\n")
        go_to_tick(app.context, 80)
        await pilot.press("y")
        await until_shown(pilot, "Branch from")
        await pilot.press("y")
        await until(
            pilot,
            lambda: (
                app.run_controller.run_id != first and app.run_controller.state == RunPhase.ENDED
            ),
        )
        await until(
            pilot, lambda: any("of the edited program: it differs" in n for n in notices(app))
        )


@pytest.mark.slow
async def test_a_branch_is_compared_with_the_run_that_it_left() -> None:
    async with open_with_a_past() as (pilot, app):
        await stop(pilot, app)
        first = app.run_controller.run_id
        go_to_tick(app.context, 200)
        # Neither as at first nor as it was set later, which on a busy machine may be after this instant.
        app.run_controller.set_noise(NoiseSpec(5, 0))
        await until_shown(pilot, "Branch from 2.00 s?")
        await pilot.press("y")
        await until(
            pilot,
            lambda: app.run_controller.run_id != first and app.run_controller.timeline.newest > 260,
        )
        await stop(pilot, app)
        await pilot.press("equals_sign")
        await until(
            pilot,
            lambda: "Compare run 2 with" in screen_text(app) and "1 of 1 runs" in screen_text(app),
        )
        await pilot.press("enter")
        await until_shown(pilot, "first differing tick")
        assert "tick 200, 2.00 s: actions" in screen_text(app)
        assert "user actions" in screen_text(app)
        await pilot.press("enter")
        await until(pilot, lambda: app.run_controller.timeline.at == 200)


@pytest.mark.parametrize(
    "tags, number", [("branch-of-12 at-3.20s", 12), ("", None), ("best branch-of-2026x", None)]
)
def test_the_tag_of_a_branch_names_the_run_it_comes_from(tags: str, number: int | None) -> None:
    run = RunInfo(3, "id", "2026-01-02T03:04:05+00:00", "line.py", "Loop", "robolab", 0, tags=tags)
    assert parse_branch_root(run) == number
