"""Work on long logs, beside the screen; newer work takes the place of older."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.app.analyser.logs import long_log, model_of
from tests.app.analyser.test_screen import opened, text_of, typed
from tests.app.app_help import until
from tuisim.analysis import table as rows_module
from tuisim.analysis.model import Model
from tuisim.analysis.source import LogRequest
from tuisim.analysis.table import TableTask, conditions_of
from tuisim.app.analyser import screen as screen_module
from tuisim.app.analyser.app import AnalyserApp

STEPS: list[tuple[list[str], Callable[[Model], bool]]] = [
    (["F", "=value < 50 and name == a", "enter"], lambda model: len(model.rows) == 50),
    (["o"], lambda model: model.rows.view.sorted_by == "time"),
    (["U", "o"], lambda model: model.rows.view.sorted_by == "time" and len(model.rows) == 200),
    (["o"], lambda model: model.rows.view.descending and model.rows.row(0) == 199),
    (["U", "slash", "=77", "enter"], lambda model: model.row == 154),
    (["d", "=v = slope(a)", "enter"], lambda model: model.selected == "v"),
    (["c", "=a > 50", "enter"], lambda model: model.row == 100),
]


@pytest.mark.slow
async def test_long_logs_are_worked_on_beside_the_screen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(screen_module, "AT_ONCE", 0)
    lines = (f"{at / 10},{'ab'[at % 2]},{at // 2}" for at in range(200))
    file = tmp_path / "log.csv"
    file.write_text("\n".join(("time,name,value", *lines)) + "\n")
    async with AnalyserApp(LogRequest(file=str(file))).run_test(size=(120, 40)) as pilot:
        screen, _ = await opened(pilot)
        await until(pilot, lambda: screen.is_open and screen.model.opened.done)
        model = screen.model
        assert model is not None
        for keys, so in STEPS:
            await typed(pilot, *keys)
            await until(pilot, lambda: screen.job is None)
            assert so(model), keys
        await typed(pilot, "slash", "=nowhere at all", "enter")
        await until(pilot, lambda: any("was not found" in told.message for told in pilot.app._notifications))
        old, new = TableTask("older"), TableTask("newer")
        screen.begin(old)
        screen.begin(new)
        assert old.stopped and "newer" in text_of(pilot)
        screen.end(old, lambda: pytest.fail("the result of older work was taken"))
        screen.end(new, lambda: model.go_to_row(3))
        assert model.row == 3 and screen.job is None
        screen.begin(old)
        await pilot.press("U")
        assert screen.job is None


def test_a_search_goes_round_in_stretches(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows_module, "_STRETCH", 3)
    model = model_of(long_log())
    rows = model.rows
    rows.view = rows.filtered(tuple(conditions_of("variable == Colour", rows.columns)))
    rows.view = rows.sorted("value", False)
    values = [rows.text(rows.row(place), "value") for place in range(len(rows))]
    assert values == [str(value) for value in range(0, 100, 10)]
    for here in random.Random(1).sample(range(10), 10):
        for wanted in ("20", "70"):
            # The x_mm of a sample is 900 less ten times its value: another row has the text as well.
            there = sorted(at for at, value in enumerate(values) if wanted in (value, str(900 - 10 * int(value))[:2]))
            onwards = next((at for at in there if at > here), there[0])
            back = next((at for at in reversed(there) if at < here), there[-1])
            assert (rows.find(wanted, here, 1), rows.find(wanted, here, -1)) == (onwards, back), (here, wanted)
    assert rows.find("nowhere", 4, 1) is None


def test_a_search_tells_how_far_it_is_and_can_be_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows_module, "_STRETCH", 5)
    rows = model_of(long_log()).rows
    task = TableTask("searching …")
    assert rows.find("nowhere", 0, 1, task) is None and str(task) == "searching … 100%"
    task = TableTask("searching …", stopped=True)
    assert rows.find("nowhere", 0, 1, task) is None and task.part == 0.25
