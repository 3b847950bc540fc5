from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pytest

from tests.app.analyser.logs import long_log, model_of, wide_log
from tuisim.analysis.model import Model
from tuisim.analysis.source import LogRequest, Note, OpenedLog, notes_of_file, read_notes, write_notes
from tuisim.analysis.table import conditions_of
from tuisim.app.analyser.panes import pane_lines
from tuisim.errors import LogError
from tuisim.logs.columns import Layout, guess_columns
from tuisim.logs.log import Log


def text_of(model: Model, pane: str = "table", width: int = 100, height: int = 30) -> str:
    lines = pane_lines(pane, model, 0, width, height)
    return "\n".join("".join(text for text, _ in line) for line in lines)


def values(model: Model) -> list[float]:
    return [float(model.rows.text(model.rows.row(at), "value")) for at in range(len(model.rows))]


# The cursor


def test_the_cursor_goes_along_the_selected_variable() -> None:
    model = model_of(long_log())
    model.go_to_time(3.2)
    assert (model.row, model.time_of(model.row)) == (6, 3.0)
    model.select(1)
    model.step(1)
    assert (model.row, model.trace_of_row(model.row).name) == (7, "Left")
    model.step(1)
    assert (model.row, model.time_of(model.row)) == (9, 4.0)


def test_a_row_belongs_to_its_own_run() -> None:
    model = model_of(long_log(runs=2))
    assert (model.trace_of_row(0).name, model.run_of(0)) == ("Colour #1", 0)
    assert (model.trace_of_row(39).name, model.run_of(39), model.time_of(39)) == ("Left #2", 1, 18.0)


def test_zoom_keeps_the_cursor_and_pan_stays_inside() -> None:
    model = model_of(wide_log(10_001))
    model.go_to_time(8.0)
    model.zoom(0.5)
    low, high = model.x_limits()
    assert (high - low, low <= 8.0 <= high) == (5.0, True)
    for _ in range(20):
        model.pan(0.25)
    assert model.x_limits() == (5.0, 10.0)
    model.go_to_time(1.0)
    model.follow_cursor()
    assert model.x_limits() == (0.0, 5.0)
    model.zoom(2.0)
    assert model.limits is None


@pytest.mark.parametrize(
    ("way", "place"), [("time", 18.0), ("distance", 900.0), ("Colour < 45", 9.0)], ids=["time", "distance", "event"]
)
def test_runs_are_laid_over_each_other(way: str, place: float) -> None:
    model = model_of(long_log(runs=2))
    model.go_to_row(38)
    model.align(way)
    assert model.cursor_s == pytest.approx(place)
    model.selected = "Colour #2"
    model.go_to_time(place)
    assert model.row == 38
    assert model.time_of(38) == 18.0


@pytest.mark.parametrize("way", ["speed", "Colour < -5", "Nothing > 1"])
def test_what_runs_cannot_be_aligned_by_is_said(way: str) -> None:
    with pytest.raises(LogError):
        model_of(long_log(runs=2)).align(way)


def test_a_variable_along_another() -> None:
    model = model_of(long_log())
    assert model.along("x_mm").tolist() == [100.0 * at for at in range(10)]
    assert model.along("Left").tolist() == [float(at) for at in range(10)]
    with pytest.raises(LogError, match="no variable 'z_mm'"):
        model.along("z_mm")


def test_a_log_without_numbers_is_refused() -> None:
    table = pa.table({"a": ["x", "y"]})
    with pytest.raises(LogError, match="no numeric column"):
        model_of(Log("test", table, Layout()))


def test_a_row_without_the_name_of_its_variable_is_shown_all_the_same() -> None:
    table = pa.table({"variable": ["A", None, "A"], "value": [1.0, 2.0, 3.0], "time": [0.0, 1.0, 2.0]})
    model = model_of(Log("test", table, guess_columns(table)))
    model.go_to_row(1)
    assert (model.trace_of_row(1).name, model.cursor_s) == ("A", 2.0)
    assert "2" in text_of(model)


# The table


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("variable == Colour and value > 65", [90.0, 80.0, 70.0]),
        ("variable ~ COL, time >= 8", [10.0, 0.0]),
        ("value = 5", [5.0]),
        ("variable != 'Left' and value <= 0", [0.0]),
    ],
    ids=["and", "comma", "equal", "not equal"],
)
def test_rows_that_fulfil_all_conditions(text: str, found: list[float]) -> None:
    model = model_of(long_log())
    model.rows.filter(tuple(conditions_of(text, model.rows.columns)))
    assert values(model) == found


@pytest.mark.parametrize("text", ["value", "nothing > 3", "value > x", "> 3"])
def test_a_condition_that_is_none_is_said(text: str) -> None:
    model = model_of(long_log())
    with pytest.raises(LogError):
        model.rows.filter(tuple(conditions_of(text, model.rows.columns)))
    assert len(model.rows) == 20


def test_sorting_goes_with_a_filter() -> None:
    model = model_of(long_log())
    model.rows.filter(tuple(conditions_of("variable == Colour", model.rows.columns)))
    model.rows.sort("value", False)
    assert values(model) == [float(10 * at) for at in range(10)]
    model.rows.sort("value", True)
    assert values(model)[0] == 90.0
    assert model.rows.place(18) == 9
    model.rows.sort("variable", False)
    model.rows.filter(())
    assert values(model)[:2] == [90.0, 80.0]


def test_columns_are_hidden_and_kept_at_the_left() -> None:
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


def test_search_goes_round() -> None:
    rows = model_of(long_log()).rows
    assert rows.find("left", 0, 1) == 1
    assert rows.find("left", 19, 1) == 1
    assert rows.find("left", 0, -1) == 19
    assert rows.find("no such text", 0, 1) is None


def test_a_narrow_table_shows_the_chosen_column() -> None:
    model = model_of(long_log())
    model.rows.choose(5)
    assert "y_mm" in text_of(model, width=30).splitlines()[0]


# Panes


@pytest.mark.parametrize(
    ("pane", "words"),
    [
        ("table", "Colour"),
        ("bands", "stays at a level"),
        ("statistics", "mean"),
        ("notes", "No notes yet"),
        ("runs", "This log is a file"),
    ],
)
@pytest.mark.parametrize("size", [(20, 1), (48, 9), (130, 40)], ids=str)
def test_every_pane_fits_its_size(pane: str, words: str, size: tuple[int, int]) -> None:
    model = model_of(long_log())
    model.find_bands(model.unsearched())
    text = text_of(model, pane, *size)
    assert len(text.splitlines()) <= max(size[1], 3)
    if size[0] == 130:
        assert words in text


def test_an_empty_log_says_how_to_make_one() -> None:
    log = long_log()
    model = model_of(type(log)("none", log.table.slice(0, 0), log.layout))
    assert "print('Colour: '" in text_of(model)


# Notes


def test_notes_are_kept_with_a_file(tmp_path: Path, home: Path) -> None:
    file = tmp_path / "log.csv"
    file.write_text("time,value\n0,1\n")
    opened = OpenedLog(LogRequest(file=str(file)), long_log())
    model = Model(opened)
    model.add_note("second", 2.0, 3.0, "Colour", 0)
    model.add_note("first", 1.0, 1.0, "", 0)
    assert [note.text for _, note in Model(opened).notes] == ["first", "second"]
    file.write_text("time,value\n0,1\n1,2\n")
    assert len(Model(opened).notes) == 2
    model.drop_note(*model.notes[0])
    assert [note.text for _, note in Model(opened).notes] == ["second"]
    assert [path.parent for path in home.rglob("*.jsonl")] == [home / "notes"]


def test_a_log_from_a_pipe_keeps_no_notes() -> None:
    with pytest.raises(LogError, match="cannot be kept"):
        model_of(long_log()).add_note("text", 0.0, 0.0, "", 0)


def test_damaged_notes_are_said_with_their_row(tmp_path: Path) -> None:
    place = tmp_path / "notes.jsonl"
    write_notes(place, [Note("ü\nx", 0.5, 1.5, "Colour")])
    assert read_notes(place) == (Note("ü\nx", 0.5, 1.5, "Colour"),)
    place.write_bytes(place.read_bytes() + b"{}\n")
    with pytest.raises(LogError, match="not a note") as caught:
        read_notes(place)
    assert "2" in str(caught.value)


def test_notes_of_a_missing_file_are_said(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot be read"):
        notes_of_file(tmp_path / "none.csv")
