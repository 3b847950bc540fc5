"""Files and logs as frames of pandas."""

from __future__ import annotations

import json
import os
import re
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pyarrow as pa

from tuisim.base.errors import LogError
from tuisim.engine.runs.arrays import FloatArray
from tuisim.logs import arrow
from tuisim.logs.blocks import Block
from tuisim.logs.choices import NO_CHOICES, ReadChoices
from tuisim.logs.columns import ROW
from tuisim.logs.export import EXPORTERS, build_typed_frame, find_companion
from tuisim.logs.expressions import evaluate
from tuisim.logs.log import Log, Series
from tuisim.logs.reader import join_tables, open_log, read_companion, read_parts
from tuisim.logs.signals import Between, build_even_moments
from tuisim.logs.text_tables import read_exported_csv
from tuisim.logs.units import TEXT, TIMEDELTA
from tuisim.logs.warnings import Notes

if TYPE_CHECKING:
    import pandas as pd


def read_log(
    path: str | Path,
    *,
    time: str | None = None,
    unit: Literal["", "s", "ms", "us", "ns", "min"] = "",
    value: Sequence[str] = (),
    header: int = 0,
    table: int = 1,
    encoding: str = "",
    separator: Literal["", "comma", "semicolon", "tab", "bar", "blank"] = "",
    decimal: Literal["", ".", ","] = "",
) -> pd.DataFrame:
    """Return the table in a file.

    A file that `out=` or `tuisim log export` has written is returned as it was, to the last bit, if no other argument
    is given; only empty texts in a CSV file become missing values. A CSV or JSONL file needs the `.json` file beside it
    for this.

    Any other file, such as one of your own `to_csv`, gets an index, and so does each file if another argument is given:
    the time in seconds or, without a time, the number of the row. Dates count from the first row, times of day from
    midnight. Warnings say what was guessed or left out, and name the argument that decides.

    Args:
        path: A CSV, Parquet, JSON, JSONL, Arrow or text file.
        time: The column with the time; empty to count the rows, None to find it.
        unit: The unit of the numbers in the time column: `s`, `ms`, `us`, `ns` or `min`; empty to guess it.
        value: The columns with values. Of all other columns, only those of times, names of variables and runs are kept.
        header: The number of the line that has the names of the columns, from 1; 0 to find it. Only for a text.
        table: Which table to read if a text has several, from 1.
        encoding: The encoding of a text by its name in Python, such as `cp1252`; empty to find it.
        separator: What separates the cells of a text: `comma`, `semicolon`, `tab`, `bar` or `blank`; empty to find it.
        decimal: The decimal sign, `.` or `,`; empty to find it.

    Raises:
        LogError: the file cannot be read or has no row, there is no such column, or a choice is not allowed.
    """
    values = (value,) if isinstance(value, str) else tuple(value)
    choices = ReadChoices(time, unit, values, header, table, encoding, separator, decimal)
    source = Path(path)
    if choices == NO_CHOICES and (frame := _read_export(source)) is not None:
        return frame
    try:
        log = open_log(source, choices)
    except LogError as error:
        error.message, error.hint = _name_arguments(error.message), _name_arguments(error.hint)
        raise
    for note in log.notes:
        # Stack level 3 is the caller of `tuisim.read_log`: a wrapper, which checks its arguments, is in between.
        warnings.warn(f"{log.title}: {_name_arguments(note)}", stacklevel=3)
    layout = log.layout
    rows = log.table
    if choices.value:
        chosen = {layout.time, layout.variable, layout.run, *choices.value}
        rows = rows.select([name for name in rows.column_names if name in chosen])
    frame = build_typed_frame(rows)
    counts_rows = layout.time in (ROW, "row") and time != "row"
    return frame if counts_rows else frame.set_index(log.times_s).rename_axis("time_s")


def _name_arguments(text: str) -> str:
    """Return a text in which the options of a command are replaced by the arguments of `read_log`."""
    return re.sub(r"--(\w+)( (?=\d))?", r"\1=", text)


def _read_export(source: Path) -> pd.DataFrame | None:
    """Return the frame in a file that tuisim exported; None if it is another file."""
    exporter = EXPORTERS.get(source.suffix.lower())
    if exporter is None or not os.path.isfile(source):
        return None
    if exporter.companion and not os.path.isfile(find_companion(source)):
        return None
    notes = Notes()
    try:
        table = _read_exported(source, notes)
        if not exporter.companion and arrow.METADATA_KEY not in (table.schema.metadata or {}):
            return None
        frame = build_typed_frame(table) if exporter.companion else table.to_pandas()
    # These are raised for text that is not UTF-8 or not JSON, and by Arrow.
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise LogError(f"cannot be read: {error}", file=str(source)) from error
    if notes.texts():
        raise LogError(f"cannot be read: {'; '.join(notes.texts())}", file=str(source))
    return frame


def _read_exported(source: Path, notes: Notes) -> pa.Table:
    """Return the table in a file that tuisim exported; faults in it are added to `notes`."""
    suffix = source.suffix.lower()
    if suffix == ".csv":
        return read_exported_csv(source.read_bytes().decode())
    if suffix == ".jsonl":
        lines = Block(1, source.read_text("utf-8")).lines()
        rows = [json.loads(line) for _, line in lines]
        # Without a row, only the companion file names the columns.
        names = rows[0] if rows else read_companion(source).get("columns", ())
        return pa.table({name: _build_column(name, rows) for name in names})
    return join_tables([table for _, table in read_parts(source, notes) if table is not None])


def _build_column(name: str, rows: Sequence[Mapping[str, Any]]) -> pa.Array:
    """Return a column of exported rows as an array whose type fits all its cells; a missing number becomes NaN.

    Args:
        name: The name of the column.
        rows: The rows.
    """
    if not rows:
        return pa.nulls(0, pa.string() if name in (*TIMEDELTA, *TEXT) else pa.float64())
    column = pa.array([row[name] for row in rows])
    # A missing number or truth value becomes NaN.
    is_number = pa.types.is_null(column.type) or pa.types.is_boolean(column.type)
    return column.cast(pa.float64()) if column.null_count and is_number else column


def build_even_frame(
    all_series: Sequence[Series], period_s: float, between: Between
) -> pd.DataFrame:
    """Return the values of each series at even times, from the first sample of all to the last.

    The frame has one column for each series, with unique names.

    Args:
        all_series: The series.
        period_s: The time between two rows in seconds.
        between: The interpolation between samples.
    """
    start_s = min(float(series.time_s.min()) for series in all_series)
    stop_s = max(float(series.time_s.max()) for series in all_series)
    moments_s = build_even_moments(start_s, stop_s, period_s)
    return _build_sampled_frame(moments_s, all_series, between)


def _build_sampled_frame(
    moments_s: FloatArray, all_series: Sequence[Series], between: Between = Between.HOLD
) -> pd.DataFrame:
    """Return the values of each series at given times: one column for each series, with unique names."""
    import pandas as pd

    names = arrow.make_names_unique(["time", *(series.name for series in all_series)])
    known = [series.sample(moments_s, between) for series in all_series]
    return pd.DataFrame(dict(zip(names, [moments_s, *known], strict=True)))


def build_computed_frame(log: Log, expression: str) -> pd.DataFrame:
    """Return a log with a column for each variable, and a column `result` with the value of an expression.

    Raises:
        LogError: the expression is invalid, or names a column that does not exist.
    """
    frame = _build_wide_frame(log)
    columns = {str(name): frame[name].to_numpy(np.float64) for name in frame.columns}
    result = arrow.make_names_unique([*columns, "result"])[-1]
    return frame.assign(**{result: evaluate(expression, columns)})


def _build_wide_frame(log: Log) -> pd.DataFrame:
    """Return a log with a column for each variable; variables that share a column in the log are forward-filled."""
    import pandas as pd

    if not log.layout.variable:
        return pd.DataFrame({name: log.numbers(name) for name in log.numeric_columns})
    series = [log.series(name) for name in log.sampled_names]
    moments = np.unique(np.concatenate([member.time_s for member in series]))
    return _build_sampled_frame(moments, series)
