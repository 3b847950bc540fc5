"""Signals computed from a log: derivative, rolling mean, integral, resampling, expressions, dead reckoning, export."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tuisim.commands.logs.results import show_frame
from tuisim.commands.logs.sources import names_of, the_source
from tuisim.config.command_line import Arguments
from tuisim.errors import ConfigError
from tuisim.logs.arrow import numbers_of, unique_names
from tuisim.logs.columns import is_numeric
from tuisim.logs.derived import reckoned_series
from tuisim.logs.export import check_target, export_log
from tuisim.logs.expressions import evaluate
from tuisim.logs.log import Log, LogTable, Series
from tuisim.logs.signals import Between, derivative, even_moments, integral, known_at, moving_average
from tuisim.runs.arrays import FloatArray

if TYPE_CHECKING:
    import pandas as pd


def _each(arguments: Arguments, column: str, change: Callable[[Series], FloatArray]) -> int:
    """Output a long frame with one more column, computed per variable."""
    import pandas as pd

    log = the_source(arguments)
    parts = []
    for name in names_of(log, arguments):
        series = log.series(name)
        columns = {"time": series.time_s, "variable": name, "value": series.values, column: change(series)}
        parts.append(pd.DataFrame(columns))
    show_frame(pd.concat(parts, ignore_index=True), arguments)
    return 0


def derive(arguments: Arguments) -> int:
    """Output the derivative of each variable, in units per second."""
    return _each(arguments, "derivative", lambda series: derivative(series.time_s, series.values))


def integrate(arguments: Arguments) -> int:
    """Output the integral of each variable, in units times seconds."""
    return _each(arguments, "integral", lambda s: integral(s.time_s, s.values, arguments.between))


def average(arguments: Arguments) -> int:
    """Output the centred rolling mean of each variable."""
    return _each(arguments, "average", lambda series: moving_average(series.values, arguments.width))


def even(arguments: Arguments) -> int:
    """Output every variable resampled at a fixed period, one column each."""
    log = the_source(arguments)
    if arguments.period is None:
        raise ConfigError("which period?", "such as --period 0.1", key="resample")
    all_series = [log.series(name) for name in names_of(log, arguments)]
    start = min(float(series.time_s.min()) for series in all_series)
    stop = max(float(series.time_s.max()) for series in all_series)
    moments = even_moments(start, stop, arguments.period)
    show_frame(_sampled_at(moments, all_series, arguments.between), arguments)
    return 0


def _sampled_at(moments_s: FloatArray, all_series: Sequence[Series], between: Between = Between.HOLD) -> pd.DataFrame:
    """Return the values of each series at given times: one column each, with unique names."""
    import pandas as pd

    names = unique_names(["time", *(series.name for series in all_series)])
    columns = [moments_s, *(known_at(series.time_s, series.values, moments_s, between) for series in all_series)]
    return pd.DataFrame(dict(zip(names, columns, strict=True)))


def calculate(arguments: Arguments) -> int:
    """Output the log with a column computed from an expression."""
    if not arguments.expression:
        raise ConfigError("which expression?", "such as --expression '(left + right) / 2'", key="calc")
    log = the_source(arguments)
    frame = wide_frame(log)
    columns = {str(name): frame[name].to_numpy(np.float64) for name in frame.columns}
    result = unique_names([*columns, "result"])[-1]
    show_frame(frame.assign(**{result: evaluate(arguments.expression, columns)}), arguments)
    return 0


def wide_frame(log: Log) -> pd.DataFrame:
    """Return a log in wide format: one column per variable; rows of a long log are forward-filled."""
    import pandas as pd

    if not log.layout.variable:
        numeric = [n for n in log.table.column_names if is_numeric(log.table.schema.field(n).type)]
        return pd.DataFrame({name: numbers_of(log.table.column(name)) for name in numeric})
    series = [one for one in map(log.series, log.names) if len(one.rows)]
    moments = np.unique(np.concatenate([one.time_s for one in series]))
    return _sampled_at(moments, series)


def reckon(arguments: Arguments) -> int:
    """Output the pose by dead reckoning from the wheel encoders, and its error."""
    arguments.telemetry = True
    log = the_source(arguments)
    computed = {series.name: series.values for series in reckoned_series(log)}
    frame = log.table.select(["time", "x_mm", "y_mm", "heading_deg"]).to_pandas()
    show_frame(frame.assign(**computed), arguments)
    return 0


def export(arguments: Arguments) -> int:
    """Write the log, or some of its variables, in another format."""
    if not arguments.out:
        raise ConfigError("to which file?", "such as --out log.parquet", key="export")
    check_target(arguments.out)
    log = the_source(arguments)
    export_log(log, _chosen_part(log, arguments), arguments.out)
    return 0


def _chosen_part(log: Log, arguments: Arguments) -> LogTable:
    """Return the rows of the chosen variables; of a wide log, their columns and those that are not variables."""
    if not arguments.variable:
        return log.table
    names = names_of(log, arguments)
    rows = np.unique(np.concatenate([log.series(name).rows for name in names]))
    part = log.table if len(rows) == log.rows else log.table.take(rows)
    if log.layout.variable:
        return part
    wanted = {name.partition(" #")[0] for name in names}
    return part.select([name for name in part.column_names if name in wanted or name not in log.layout.values])
