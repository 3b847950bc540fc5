"""The panes of the analyser as lines: table, bands, statistics, notes, runs."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from tests.app.analyser.logs import long_log, model_of
from tests.cases import for_each
from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.source import LogRequest, OpenedLog
from tuisim.app.analyser.panes import pane_lines
from tuisim.app.analyser.table_pane import build_heading, count_rows
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.logs.columns import choose_columns
from tuisim.logs.log import Log
from tuisim.logs.reader import build_log

LEVELS = (100.0, 86.27, 50.2, 0.0)


def stepped(rows: int, band_samples: int) -> pa.Table:
    values = np.array(LEVELS)[np.arange(rows) // band_samples % len(LEVELS)]
    return pa.table({"time": np.arange(rows) / 100.0, "Colour": values})


def test_of_many_bands_those_around_the_chosen_one_are_shown() -> None:
    table = stepped(12_000, 8)
    model = model_of(Log("test", table, choose_columns(table)))
    model.find_bands(model.list_unsearched())
    assert len(model.bands()) == 1500
    shown = ["".join(part for part, _ in line) for line in pane_lines("bands", model, 1250, 80, 20)]
    numbers = [int(line.split()[1]) for line in shown[1:12]]
    assert 1251 in numbers and numbers == list(range(numbers[0], numbers[0] + 11))
    assert "4 levels" in " ".join(shown)


def test_few_bands_are_all_in_sight_with_their_statistics_in_a_small_terminal() -> None:
    table = pa.table(
        {
            **dict(zip(("time", "Colour"), stepped(80, 10).columns, strict=True)),
            "x_mm": np.arange(80.0),
            "y_mm": np.zeros(80),
        }
    )
    model = model_of(Log("test", table, choose_columns(table)))
    for trace in model.traces:
        trace.on = trace.name == "Colour"
    model.find_bands(model.list_unsearched())

    head, *shown = text_of(model, "bands", 48, 9).splitlines()

    assert head.split() == ["#", "level", "name", "from", "s", "to", "s", "n", "mm", "std"]
    assert [line.split()[0] for line in shown] == [str(number) for number in range(1, 9)]
    assert shown[1].split() == ["2", "86.27", "pale", "grey", "0.10", "0.19", "10", "10", "0.00"]


def test_with_two_traces_a_narrow_pane_of_bands_has_their_levels_names_and_widths() -> None:
    table = stepped(80, 10).append_column("x_mm", pa.array(np.arange(80.0)))
    table = table.append_column("y_mm", pa.array(np.zeros(80)))
    table = table.append_column("Right", table.column("Colour"))
    model = model_of(Log("test", table, choose_columns(table)))
    for trace in model.traces:
        trace.on = trace.name in ("Colour", "Right")
    model.find_bands(model.list_unsearched())

    head, *rows = text_of(model, "bands", 46, 9).splitlines()

    assert head.split() == ["variable", "#", "level", "name", "from", "s", "mm", "…"]
    assert rows[1].split() == ["Colour", "2", "86.27", "pale", "grey", "0.10", "10"]
    assert head.index("mm") + 2 == len(rows[1].rstrip())


@pytest.mark.parametrize(
    "size, heads",
    [
        ((48, 9), ["variable count min mean max std", "variable 5 % 25 % 50 % 75 % 95 %"]),
        ((48, 3), ["variable count min mean max std …"]),
        ((100, 9), ["variable count min mean max std 5 % 25 % 50 % 75 % 95 %"]),
    ],
)
def test_figures_that_do_not_fit_beside_the_others_are_below_them(
    size: tuple[int, int], heads: list[str]
) -> None:
    table = stepped(80, 10)
    model = model_of(Log("test", table, choose_columns(table)))
    lines = text_of(model, "statistics", *size).splitlines()
    assert [" ".join(line.split()) for line in lines if "mean" in line or "95 %" in line] == heads
    assert len(lines) == 2 * len(heads)


@pytest.mark.parametrize("bands, rows", [(8, 8), (9, 8), (20, 8)])
def test_a_summary_that_does_not_fit_leaves_its_line_to_the_rows(bands: int, rows: int) -> None:
    table = stepped(10 * bands, 10)
    model = model_of(Log("test", table, choose_columns(table)))
    model.find_bands(model.list_unsearched())
    _, *shown = text_of(model, "bands", 48, 9).splitlines()
    assert [line.split()[0] for line in shown] == [str(number) for number in range(1, rows + 1)]


def text_of(model: AnalysisModel, pane: str = "table", width: int = 100, height: int = 30) -> str:
    lines = pane_lines(pane, model, 0, width, height)
    return "\n".join("".join(text for text, _ in line) for line in lines)


@for_each(width=range(1, 12))
def test_a_pane_narrower_than_its_first_column_is_not_blank(width: int) -> None:
    table = stepped(80, 10)
    model = model_of(Log("test", table, choose_columns(table)))
    model.find_bands(model.list_unsearched())
    for pane in ("bands", "statistics"):
        assert text_of(model, pane, width, 9)


def test_a_row_whose_variable_name_is_empty_is_still_shown() -> None:
    table = pa.table(
        {"variable": ["A", None, "A"], "value": [1.0, 2.0, 3.0], "time": [0.0, 1.0, 2.0]}
    )
    model = model_of(Log("test", table, choose_columns(table)))
    model.go_to_row(1)
    assert (model.trace_of_row(1).name, model.cursor_s) == ("A", 2.0)
    assert "2" in text_of(model)


def test_a_narrow_table_shows_the_chosen_column() -> None:
    model = model_of(long_log())
    model.rows.choose(5)
    assert "y_mm" in text_of(model, width=30).splitlines()[0]


@pytest.mark.parametrize(
    "pane, words",
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
    model.find_bands(model.list_unsearched())
    text = text_of(model, pane, *size)
    assert len(text.splitlines()) <= max(size[1], 3)
    if size[0] == 130:
        assert words in text


def test_decimal_points_of_a_column_stand_below_each_other() -> None:
    table = pa.table({"time": [0.08, 0.1, 0.125], "Colour": [100, 86, 50]})
    lines = text_of(model_of(Log("test", table, choose_columns(table)))).splitlines()[1:4]
    assert len({line.index(".") for line in lines}) == 1
    assert (
        len(
            {
                line.index(level) + len(level)
                for line, level in zip(lines, ("100", " 86", " 50"), strict=True)
            }
        )
        == 1
    )


def test_an_empty_log_says_what_else_there_is() -> None:
    log = long_log()
    model = model_of(type(log)("none", log.table.slice(0, 0), log.layout))
    assert "T shows the telemetry" in text_of(model)


def test_the_column_run_of_stored_runs_is_headed_nth_run(run: StoredRun) -> None:
    opened = OpenedLog(LogRequest(), build_log((run,)), (run,))
    assert build_heading(AnalysisModel(opened), "run") == "nth run"
    assert build_heading(model_of(opened.log), "run") == "run"


def test_the_border_says_what_the_column_index_counts(run: StoredRun) -> None:
    opened = OpenedLog(LogRequest(), build_log((run,)), (run,))
    assert count_rows(AnalysisModel(opened)).startswith("index: s since the first sample")
    assert count_rows(model_of(opened.log)).endswith("rows")


@for_each(height=range(6, 12))
def test_a_sentence_below_the_rows_is_not_cut_within_its_only_line(height: int) -> None:
    table = stepped(60, 20)
    model = model_of(Log("test", table, choose_columns(table)))
    model.find_bands(model.list_unsearched())
    lines = text_of(model, "bands", 48, height).splitlines()
    assert not lines[-1].endswith("…") or lines[-2].startswith("Colour:")
    assert "pal …" not in lines[-1]
