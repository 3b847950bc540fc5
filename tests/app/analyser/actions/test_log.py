"""Events of a log, and the way to where two runs part, by keys."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.app.analyser.test_screen import open_analyser, text_of, typed
from tests.app.app_help import LOGS, program, until
from tuisim.analysis.events import CommandRow
from tuisim.app.analyser.chart import draw_event_marks
from tuisim.app.analyser.panes import PANES
from tuisim.app.dialogs.runs import Differences
from tuisim.engine.core.spec import NoiseSpec
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore


@pytest.fixture
def noisy(run: StoredRun) -> StoredRun:
    """The same run with noise."""
    spec = replace(run.spec, world=replace(run.spec.world, noise=NoiseSpec(light=20)))
    handle = start_run(program(LOGS), spec, RunOptions(speed=0.0))
    handle.wait()
    return RunStore().load_run(handle.run_id)


async def test_commands_to_motors_are_listed_as_events(run: StoredRun) -> None:
    async with open_analyser(runs=(run.id, run.id)) as (pilot, screen, model):
        await typed(pilot, "c", "=command right, Colour < 60", "enter")
        events = model.events.list_events(model.log)
        asked = [event for event in events if isinstance(event, CommandRow)]
        assert 2 * len(asked) > len(events) > len(asked)
        assert {event.event.part for event in asked} == {"right motor C"}
        assert model.row == events[0].row and "╷" in text_of(pilot)
        assert "right motor C #1" in text_of(pilot) and asked[0].event.asked in text_of(pilot)
        assert {cells[1] for cells in PANES["events"].rows(model)} == {"", "falls"}
        selected = model.selected
        screen.choose(events.index(asked[-1]))
        assert (model.row, model.selected) == (asked[-1].row, selected)
        model.align("distance")
        assert draw_event_marks(model, model.find_x_limits(), 40).count("╷") >= 1


@pytest.mark.slow
async def test_keys_find_events_go_between_them_and_compare_with_another_run(
    run: StoredRun, noisy: StoredRun
) -> None:
    async with open_analyser(runs=(run.id,)) as (pilot, screen, model):
        await typed(pilot, "c", "=Colour < 60", "enter")
        events = model.events.list_events(model.log)
        assert model.row == events[0].row and "▼" in text_of(pilot) and "[Events]" in text_of(pilot)
        await pilot.press("j")
        assert (model.row, screen.pane.chosen) == (events[1].row, 1)
        await pilot.press("J", "J")
        assert model.row == events[0].row
        await typed(pilot, "D", f"={run.id}", "enter")
        assert "that is the same run" in text_of(pilot)
        await typed(pilot, f"={noisy.id}", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, Differences))
        await pilot.press("enter")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert model.row == 0
        await typed(pilot, "d", "=v = slope(Colour)", "enter")
        assert model.selected == "v" and "[x] v" in text_of(pilot)
