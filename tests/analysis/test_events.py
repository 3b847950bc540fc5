"""Events of a log, statistics between two cursors, and the way to where two runs part."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.app.analyser.logs import long_log, model_of, wide_log
from tests.app.analyser.test_screen import opened, text_of, typed
from tests.app.app_help import LOGS, program, until
from tuisim.analysis.chart import event_marks
from tuisim.analysis.events import events_of, thresholds_of
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import AnalyserApp
from tuisim.app.analyser.panes import PANES, pane_lines
from tuisim.app.dialogs.runs import Differences
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.errors import LogError
from tuisim.runs.handle import RunOptions, start_run
from tuisim.runs.run_folder import StoredRun
from tuisim.runs.store import RunStore

# `Colour` falls by 10 a second from 90, `Left` rises by 1.
FOUND = {
    "below": ("Colour < 45", [("Colour", False, 4.5, 10)]),
    "the other way": ("Colour > 45", []),
    "both ways": ("Colour = 45", [("Colour", False, 4.5, 10)]),
    "several": ("Colour < 75, Left > 0.5", [("Left", True, 0.5, 3), ("Colour", False, 1.5, 4)]),
    "too near": ("Colour = 5 +- 50", []),
    "nothing": ("", []),
}


@pytest.mark.parametrize(("text", "events"), FOUND.values(), ids=FOUND)
def test_where_variables_cross_a_value(text: str, events: list[tuple[str, bool, float, int]]) -> None:
    log = long_log()
    found = events_of(log, thresholds_of(text, log))
    assert [(event.variable, event.rising, event.time_s, event.row) for event in found] == events


@pytest.mark.parametrize(("text", "said"), [("Colour", "no threshold"), ("Color < 5", "no variable 'Color'")])
def test_what_is_no_threshold(text: str, said: str) -> None:
    with pytest.raises(LogError, match=said):
        thresholds_of(text, long_log())


def test_events_stand_where_they_are_in_the_chart_and_in_the_pane() -> None:
    model = model_of(long_log(runs=2))
    model.events.thresholds = thresholds_of("Colour < 45", model.log)
    assert [event.variable for event in model.events.found(model.log)] == ["Colour #1", "Colour #2"]
    # The second run takes twice the time, until both are laid over each other at the event.
    assert event_marks(model, (0.0, 18.0), 19) == "    ▼    ▼         "
    model.align("Colour < 45")
    assert event_marks(model, (-9.0, 9.0), 19).strip() == "▼"
    pane = PANES["events"]
    assert list(pane.rows(model)[0]) == ["Colour #1", "below", "4.500", "–", "40", "11", "45"]
    grown = model_of(long_log(runs=3))
    grown.restore(model)
    assert len(grown.events.found(grown.log)) == 3


def test_statistics_count_what_is_between_the_cursors() -> None:
    model = model_of(long_log())
    model.mark_s = 2.0
    model.go_to_moment(4.0)
    found = model.summary("Colour")
    assert (found.count, found.min, found.max) == (3, 50.0, 70.0)
    assert "Between 2.000 and 4.000" in "".join(
        part[0] for line in pane_lines("statistics", model, 0, 99, 9) for part in line
    )
    model.mark_s = None
    assert model.summary("Colour").count == 10


def test_columns_that_do_not_fit_are_left_out_whole() -> None:
    lines = pane_lines("statistics", model_of(wide_log(100)), 0, 40, 9)
    assert [line[0][0] for line in lines] == [line[0][0][:40] for line in lines]


@pytest.fixture(scope="module")
def two_runs() -> list[StoredRun]:
    """One run and the same with noise."""
    spec = build_run_spec(Settings(background="Grey_bands"))
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
