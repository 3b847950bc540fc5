"""Events of a log, and the way to where two runs part, by keys."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.app.analyser.test_screen import opened, text_of, typed
from tests.app.app_help import LOGS, program, until
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import AnalyserApp
from tuisim.app.dialogs.runs import Differences
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.runs.handle import RunOptions, start_run
from tuisim.runs.run_folder import StoredRun
from tuisim.runs.store import RunStore


@pytest.fixture(scope="module")
def two_runs() -> list[StoredRun]:
    """One run and the same with noise."""
    spec = build_run_spec(Settings({"background": "Grey_bands"}))
    noisy = replace(spec, world=replace(spec.world, noise=replace(spec.world.noise, light=20)))
    ids = []
    for one in (spec, noisy):
        handle = start_run(program(LOGS), one, RunOptions(speed=0.0))
        handle.wait()
        ids.append(handle.run_id)
    return [RunStore().load_run(run_id) for run_id in ids]


@pytest.mark.slow
async def test_events_and_differences_by_keys(two_runs: list[StoredRun]) -> None:
    first, second = two_runs
    async with AnalyserApp(LogRequest(runs=(first.id,))).run_test(size=(120, 40)) as pilot:
        screen, model = await opened(pilot)
        await typed(pilot, "c", "=Colour < 60", "enter")
        events = model.events.found(model.log)
        assert model.row == events[0].row and "▼" in text_of(pilot) and "[Events]" in text_of(pilot)
        await pilot.press("j")
        assert (model.row, screen.pane.chosen) == (events[1].row, 1)
        await pilot.press("J", "J")
        assert model.row == events[0].row
        await typed(pilot, "D", f"={first.id}", "enter")
        assert "that is the same run" in text_of(pilot)
        await typed(pilot, f"={second.id}", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, Differences))
        await pilot.press("enter")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert model.row == 0
        await typed(pilot, "d", "=v = slope(Colour)", "enter")
        assert model.selected == "v" and "[x] v" in text_of(pilot)
