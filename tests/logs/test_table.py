"""The rows of a log: filtered, sorted, searched, also in stretches beside the screen."""

from __future__ import annotations

import random

import pytest

from tests.app.analyser.logs import long_log, model_of
from tuisim.analysis.model import AnalysisModel
from tuisim.base.errors import LogError
from tuisim.logs import table as rows_module
from tuisim.logs.table import TableTask


def test_a_search_of_a_table_wraps_around(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows_module, "_STRETCH", 3)
    model = model_of(long_log())
    rows = model.rows
    rows.view = rows.build_filtered_view(rows.parse_conditions("variable == Colour"))
    rows.view = rows.build_sorted_view("value", False)
    values = [rows.text(rows.row(place), "value") for place in range(len(rows))]
    assert values == [str(value) for value in range(0, 100, 10)]
    for here in random.Random(1).sample(range(10), 10):
        for wanted in ("20", "70"):
            # The x_mm of a sample is 900 less ten times its value: another row has the text as well.
            there = sorted(
                at
                for at, value in enumerate(values)
                if wanted in (value, str(900 - 10 * int(value))[:2])
            )
            onwards = next((at for at in there if at > here), there[0])
            back = next((at for at in reversed(there) if at < here), there[-1])
            assert (rows.find(wanted, here, 1), rows.find(wanted, here, -1)) == (onwards, back), (
                here,
                wanted,
            )
    assert rows.find("nowhere", 4, 1) is None


def test_a_search_of_a_table_reports_its_progress_and_can_be_stopped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(rows_module, "_STRETCH", 5)
    rows = model_of(long_log()).rows
    task = TableTask("searching …")
    assert rows.find("nowhere", 0, 1, task) is None and str(task) == "searching … 100%"
    task = TableTask("searching …", stopped=True)
    assert rows.find("nowhere", 0, 1, task) is None and task.part == 0.25


def values(model: AnalysisModel) -> list[float]:
    return [float(model.rows.text(model.rows.row(at), "value")) for at in range(len(model.rows))]


@pytest.mark.parametrize(
    "text, found",
    [
        ("variable == Colour and value > 65", [90.0, 80.0, 70.0]),
        ("variable ~ COL, time >= 8", [10.0, 0.0]),
        ("value = 5", [5.0]),
        ("variable != 'Left' and value <= 0", [0.0]),
    ],
    ids=["and", "comma", "equal", "not equal"],
)
def test_a_filter_shows_the_rows_that_meet_all_conditions(text: str, found: list[float]) -> None:
    model = model_of(long_log())
    model.rows.view = model.rows.build_filtered_view(model.rows.parse_conditions(text))
    assert values(model) == found


@pytest.mark.parametrize("text", ["value", "nothing > 3", "value > x", "> 3"])
def test_a_faulty_filter_condition_is_refused_and_keeps_all_rows(text: str) -> None:
    model = model_of(long_log())
    with pytest.raises(LogError):
        model.rows.view = model.rows.build_filtered_view(model.rows.parse_conditions(text))
    assert len(model.rows) == 20


def test_a_filtered_table_can_be_sorted() -> None:
    model = model_of(long_log())
    model.rows.view = model.rows.build_filtered_view(
        model.rows.parse_conditions("variable == Colour")
    )
    model.rows.view = model.rows.build_sorted_view("value", False)
    assert values(model) == [float(10 * at) for at in range(10)]
    model.rows.view = model.rows.build_sorted_view("value", True)
    assert values(model)[0] == 90.0
    assert model.rows.place(18) == 9
    model.rows.view = model.rows.build_sorted_view("variable", False)
    model.rows.view = model.rows.build_filtered_view(())
    assert values(model)[:2] == [90.0, 80.0]


def test_columns_of_a_table_can_be_hidden_or_kept_at_the_left() -> None:
    rows = model_of(long_log()).rows
    rows.choose(2)
    rows.freeze()
    assert (rows.columns[:2], rows.frozen, rows.chosen) == (["time", "variable"], 1, "time")
    rows.freeze()
    assert (rows.columns[0], rows.frozen) == ("time", 0)
    rows.hide()
    assert "time" not in rows.columns
    rows.show_all()
    assert rows.columns[:3] == ["variable", "value", "time"]


def test_a_search_of_a_table_goes_on_from_its_other_end() -> None:
    rows = model_of(long_log()).rows
    assert rows.find("left", 0, 1) == 1
    assert rows.find("left", 19, 1) == 1
    assert rows.find("left", 0, -1) == 19
    assert rows.find("no such text", 0, 1) is None
