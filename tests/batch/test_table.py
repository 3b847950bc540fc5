"""The table of a batch: its rows and columns, expressions over them, and its summary."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.batch.stand_in import result_of
from tests.batch.test_plan import plan, subject
from tests.cases import cases
from tuisim.base.errors import ConfigError, LogError
from tuisim.batch.table import (
    build_frame,
    build_metadata,
    build_row,
    build_summaries,
    check_expressions,
    list_result_columns,
)

NOISES = plan({"noise.motor": (0, 20), "seed": (1, 2, 13)})
ROWS = [build_row(result_of(task), "", task.spec.seed) for task in NOISES.iterate_tasks()]


def test_a_batch_table_has_one_row_for_each_run_sorted_by_number() -> None:
    frame = build_frame(reversed(ROWS))
    assert frame["run"].tolist() == [1, 2, 3, 4, 5, 6]
    assert list(frame.columns) == [
        "run",
        "noise.motor",
        "seed",
        "end",
        "exit_code",
        "summary",
        "error_line",
        "time_s",
        "x_mm",
        "y_mm",
        "heading_deg",
        "Colour_last",
        "Colour_count",
        "Colour_mean",
        "Colour_std",
        "Colour_min",
        "Colour_max",
    ]
    assert frame.equals(build_frame(ROWS))


def test_a_column_has_the_narrowest_type_and_nan_where_nothing_was_printed() -> None:
    frame = build_frame(ROWS)
    kinds = {
        name: frame[name].dtype.kind for name in ("noise.motor", "seed", "x_mm", "Colour_count")
    }
    assert kinds == {"noise.motor": "i", "seed": "i", "x_mm": "f", "Colour_count": "f"}
    assert frame["Colour_last"].isna().tolist() == [False, False, True] * 2


def test_a_batch_table_has_a_column_waited_for_only_if_a_run_waited() -> None:
    rows = [{"run": 1, "waited_for": ""}, {"run": 2, "waited_for": "a press"}]
    assert build_frame(rows)["waited_for"].tolist() == ["", "a press"]
    assert "waited_for" not in build_frame(rows[:1])


def test_the_program_is_a_column_if_there_are_several() -> None:
    (task,) = plan({}, subject("a.py")).iterate_tasks()
    assert list(build_frame([build_row(result_of(task), "a.py", 0)]).columns)[:3] == [
        "run",
        "program",
        "seed",
    ]


def test_values_of_several_types_are_written_as_text() -> None:
    frame = build_frame([{"run": 1, "robot.weight": "light"}, {"run": 2, "robot.weight": 3.5}])
    assert frame["robot.weight"].tolist() == ["light", "3.5"]


@cases(
    "text, expected",
    {
        "a pose": ("x_mm - 100", [0, 0, 0, 20, 40, 260]),
        "a parameter with a dot": ("noise.motor / 2", [0, 0, 0, 10, 10, 10]),
        "the end": ("where(exit_code > 0, -1, seed)", [1, 2, -1, 1, 2, -1]),
        "a variable that no run has printed": ("Grey_last", [math.nan] * 6),
    },
)
def test_an_expression_is_evaluated_in_each_row(text: str, expected: list[float]) -> None:
    found = build_frame(ROWS, {"new": text})["new"].tolist()
    assert found == pytest.approx(expected, nan_ok=True)


def test_an_expression_of_a_batch_can_use_an_earlier_one() -> None:
    frame = build_frame(ROWS, {"one": "seed + 1", "two": "one * 2"})
    assert frame["two"].tolist() == [4, 6, 28] * 2


@cases(
    "name, text, words",
    {
        "misspelt": ("new", "x_m + 1", "no column 'x_m'.*did you mean x_mm.*NAME_last"),
        "syntax": ("new", "x_mm +", "cannot read the expression"),
        "function": ("new", "open(1)", "no function 'open'"),
        "taken": ("x_mm", "1", "cannot be the name of a new column"),
        "not a name": ("a b", "1", "cannot be the name of a new column"),
        "a variable's": ("Colour_last", "1", "cannot be the name of a new column"),
    },
)
def test_wrong_expressions_are_found_before_anything_is_run(
    name: str, text: str, words: str
) -> None:
    with pytest.raises(ConfigError, match=f"--expr {name}: .*{words}"):
        check_expressions({name: text}, ["noise.motor", "seed"], [])


def test_expressions_over_parameters_goals_and_samples_are_accepted() -> None:
    check_expressions(
        {"a": "noise.motor + Colour_last", "b": "a + `goal_reach end`"},
        ["noise.motor"],
        ["reach end"],
    )


def test_an_expression_over_text_is_refused() -> None:
    with pytest.raises(LogError, match="no column 'end'"):
        build_frame(ROWS, {"new": "end + 1"})


def test_a_summary_has_one_line_for_each_combination_of_parameters() -> None:
    lines = build_summaries(build_frame(ROWS), NOISES.names, ["x_mm"])
    assert [(dict(line.group), line.statistics.mean) for line in lines] == [
        ({"noise.motor": 0}, 100.0),
        ({"noise.motor": 20}, pytest.approx(100 + 20 * 16 / 3)),
    ]


def test_a_summary_of_many_combinations_has_one_line_for_all_runs() -> None:
    rows: list[dict[str, Any]] = [
        {"run": run, "noise.motor": run, "x_mm": 1.0} for run in range(50)
    ]
    assert [
        dict(line.group) for line in build_summaries(build_frame(rows), ["noise.motor"], ["x_mm"])
    ] == [{}]


def test_a_summary_begins_with_what_was_computed() -> None:
    frame = build_frame(ROWS, {"error_mm": "x_mm - 100"})
    assert list_result_columns(frame, ["error_mm"]) == [
        "error_mm",
        "x_mm",
        "y_mm",
        "heading_deg",
        "time_s",
        "Colour_last",
    ]


def test_units_are_stored_with_a_table() -> None:
    units = build_metadata(build_frame([{"run": 1, "x_mm": 1.0, "far_mm_mean": 2.0, "n": 1}]), {})[
        "units"
    ]
    assert units == {"x_mm": "mm", "far_mm_mean": "mm"}
