"""The table of a batch: one row for each run, expressions over its columns, and its summary."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, LogError, nearest
from tuisim.batch.parameters import SEED
from tuisim.logs.export import build_table_metadata
from tuisim.logs.expressions import evaluate, find_names
from tuisim.logs.signals import Summary, compute_summary
from tuisim.logs.units import parse_unit
from tuisim.tasks.goals.judgement import GOAL, GoalState, compute_points
from tuisim.tasks.task import Result, Value, VariableStatistics

if TYPE_CHECKING:
    import pandas as pd

Row = dict[str, Any]
"""The values of one run by column: texts, numbers and truth values."""

RUN = "run"
PROGRAM = "program"
POINTS = "points"
RUN_ID = "id"
POSE = ("x_mm", "y_mm", "heading_deg")
_RARE = ("waited_for", "plugged")
"""Columns of runs that a table has only if one of them has a value there."""
ENDS = ("end", "exit_code", "summary", "error_line", "time_s", *POSE, *_RARE)
"""Columns of every run after its parameters, as in `Result`."""

STATISTICS = tuple(VariableStatistics.__dataclass_fields__)
"""The columns of a sample variable are `NAME_last`, `NAME_count` and so on."""

MAX_GROUPS = 12
"""With more combinations of parameter values, a summary has the statistics of all runs together."""

_DOTTED = re.compile(r"`[^`]*`|\b[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+\b")


def build_row(result: Result, program: str, seed: int) -> Row:
    """Return the row of a run for the table of a batch.

    Args:
        result: The result of the run.
        program: The program's name; empty if all runs have the same program.
        seed: The seed of the run, whether it is a parameter or not.
    """
    row: Row = {RUN: result.index + 1}
    if program:
        row[PROGRAM] = program
    row |= {name: value for name, value in result.parameters.items() if name != SEED}
    row[SEED] = seed
    row |= {name: getattr(result, name) for name in ENDS}
    if result.judgements:
        row |= {
            f"{GOAL}{judgement.goal.name}": judgement.state is GoalState.MET
            for judgement in result.judgements
            if judgement.state is not GoalState.UNKNOWN
        }
        row[POINTS] = compute_points(result.judgements)
    if result.run_id:
        row[RUN_ID] = result.run_id
    for name, statistics in result.variables.items():
        row |= {f"{name}_{judgement}": value for judgement, value in asdict(statistics).items()}
    return row


def build_frame(rows: Iterable[Row], expressions: Mapping[str, str] | None = None) -> pd.DataFrame:
    """Return the table of the given runs, in the order of the grid.

    A variable that a run has not printed is NaN. The columns of variables come last.

    Args:
        rows: The rows of the runs, in any order.
        expressions: Expressions by the name of their column; a later one may use an earlier one. None for none.

    Raises:
        LogError: an expression is invalid, or names a column that does not exist.
    """
    import pandas as pd

    ordered = sorted(rows, key=lambda row: int(row[RUN]))
    names: dict[str, None] = {}
    for row in ordered:
        names |= dict.fromkeys(name for name in row if row[name] or name not in _RARE)
    columns = {name: _build_column([row.get(name) for row in ordered]) for name in names}
    for name, text in (expressions or {}).items():
        columns[name] = evaluate_expression(text, _move_statistics(columns), len(ordered))
    return pd.DataFrame(_move_statistics(columns))


def _move_statistics(columns: Mapping[str, Any]) -> dict[str, Any]:
    return {name: columns[name] for name in sorted(columns, key=is_statistic)}


def _build_column(values: Sequence[Any]) -> Any:
    """Return values as a column with the first type that fits all: truth value, whole number, number, text."""
    import numpy as np
    import pandas as pd

    kinds = {type(value) for value in values}
    if kinds == {bool}:
        return np.array(values, np.bool_)
    if kinds == {int}:
        return np.array(
            values, np.int64 if all(-(2**63) <= value < 2**63 for value in values) else np.float64
        )
    if kinds <= {bool, int, float, type(None)}:
        return np.array([np.nan if value is None else value for value in values], np.float64)
    return pd.Series(["" if value is None else str(value) for value in values], dtype="str")


def evaluate_expression(text: str, columns: Mapping[str, Any], length: int) -> Any:
    """Return the value of an expression in each row; names with dots need no backticks.

    A statistic of a variable that no run has printed is NaN, as is a goal if no run could be judged.

    Args:
        text: The expression.
        columns: The columns by name.
        length: The number of rows.

    Raises:
        LogError: the expression is invalid, or names another column that does not exist.
    """
    import numpy as np

    numbers = {
        name: np.asarray(column, np.float64)
        for name, column in columns.items()
        if _is_numeric(column)
    }
    written = quote_names(text, numbers)
    for name in find_names(written):
        if name not in numbers and (is_statistic(name) or name.startswith(GOAL) or name == POINTS):
            numbers[name] = np.full(length, np.nan)
    return evaluate(written, numbers)


def _is_numeric(column: Any) -> bool:
    return getattr(column, "dtype", None) is not None and column.dtype.kind in "bif"


def is_statistic(name: str) -> bool:
    """Return whether a name, such as `Light_mean`, can be that of a column of a sample variable."""
    return name.endswith(tuple(f"_{statistic}" for statistic in STATISTICS))


def quote_names(text: str, columns: Iterable[str]) -> str:
    """Return an expression with backticks around names of columns that contain dots."""
    dotted = {name for name in columns if "." in name}
    return _DOTTED.sub(lambda found: f"`{found[0]}`" if found[0] in dotted else found[0], text)


def name_goals(goals: Iterable[str]) -> list[str]:
    """Return the names of the table's columns for some goals: the goals' names with the prefix `GOAL`."""
    return [f"{GOAL}{name}" for name in goals]


def list_usual_columns(parameters: Iterable[str], goals: Iterable[str]) -> list[str]:
    """Return the names of a table's columns that are known before the first run: all but those of sample variables."""
    goal_columns = name_goals(goals)
    names = (
        RUN,
        PROGRAM,
        *parameters,
        SEED,
        *ENDS,
        *goal_columns,
        *([POINTS] if goal_columns else []),
    )
    return list(dict.fromkeys(names))


def check_expressions(
    expressions: Mapping[str, str], parameters: Iterable[str], goals: Iterable[str]
) -> None:
    """Check expressions for further columns before any run starts.

    Args:
        expressions: The expressions by the name of their column.
        parameters: The names of the parameters.
        goals: The names of the goals.

    Raises:
        ConfigError: an expression cannot be parsed, names a column that the table will not have, or has the name of a
            column that the table will have.
    """
    known = list_usual_columns(parameters, goals)
    for name, text in expressions.items():
        key = f"--expr {name}"
        if name in known or is_statistic(name) or not name.isidentifier():
            hint = "a name of letters, digits and _ that no column has and that ends in none of their suffixes"
            raise ConfigError("cannot be the name of a new column", hint, key=key)
        try:
            used = find_names(quote_names(text, known))
            # Evaluating the expression for no rows finds everything that is not allowed in it.
            evaluate_expression(
                text, {column_name: _build_column([]) for column_name in {*known, *used}}, 0
            )
        except LogError as error:
            raise ConfigError(error.message, error.hint, key=key) from None
        for column in used:
            if column not in known and not is_statistic(column):
                hint = (
                    f"{nearest(column, known)}; the last value of a printed variable is NAME_last"
                )
                raise ConfigError(f"there will be no column {column!r}", hint, key=key)
        known.append(name)


@dataclass(frozen=True, slots=True)
class ColumnSummary:
    """One line of a summary: the statistics of a column for some runs."""

    group: Mapping[str, Value]
    """The values of the parameters; empty for all runs."""
    column: str
    statistics: Summary


def build_summaries(
    frame: pd.DataFrame, parameters: Sequence[str], columns: Sequence[str]
) -> list[ColumnSummary]:
    """Return statistics of some columns for each combination of parameters.

    If there are more than `MAX_GROUPS` combinations, the statistics are those of all runs together.

    Args:
        frame: The table.
        parameters: The parameters; the seed, if it is among them, is ignored.
        columns: The names of numeric columns.
    """
    by = [name for name in parameters if name != SEED and frame[name].nunique() > 1]
    groups: list[tuple[dict[str, Value], pd.DataFrame]] = [({}, frame)]
    if by and len(frame[by].drop_duplicates()) <= MAX_GROUPS:
        groups = [
            (dict(zip(by, values, strict=True)), part)
            for values, part in frame.groupby(by, sort=False)
        ]
    return [
        ColumnSummary(group, column, compute_summary(part[column].to_numpy("float64")))
        for column in columns
        for group, part in groups
    ]


def list_result_columns(frame: pd.DataFrame, expressions: Iterable[str]) -> list[str]:
    """Return the names of a table's columns to summarize: expressions, points, pose, time and last values."""
    first = [*expressions, POINTS, *POSE, "time_s"]
    lasts = [name for name in frame.columns if name.endswith("_last")]
    return [name for name in (*first, *lasts) if name in frame.columns]


def build_metadata(frame: pd.DataFrame, batch: Mapping[str, Any]) -> dict[str, Any]:
    """Return the metadata to store with a table, by key: its columns, their units, and what identifies the batch."""
    units = {
        name: unit.words
        for name in frame.columns
        if (unit := parse_unit(_strip_statistic(name))).words
    }
    return {**build_table_metadata("batch", frame), "units": units, "batch": dict(batch)}


def _strip_statistic(name: str) -> str:
    return name.rpartition("_")[0] if is_statistic(name) else name
