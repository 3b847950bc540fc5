"""The tables of `tuisim log`: figures and signals computed from a log, as text, as JSON, or in a file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, fields, replace
from math import isnan
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tuisim.analysis.events import (
    THRESHOLD_FORM,
    CommandChoice,
    EventChoice,
    Threshold,
    parse_event,
)
from tuisim.base.errors import ConfigError, LogError, counted
from tuisim.commands.echo import (
    CsvOut,
    echo,
    echo_error,
    echo_json,
    echo_json_list,
    echo_lines,
    echo_table,
    echo_wrapped,
    echo_written,
    replace_infinite,
    tell,
)
from tuisim.commands.logs.sources import choose_names, is_file, open_single, open_sources
from tuisim.engine.core.conditions import Operator
from tuisim.engine.runs.arrays import FloatArray
from tuisim.engine.runs.command_events import CommandIndex
from tuisim.logs import signals
from tuisim.logs.bands import Band, BandReport, build_band_report
from tuisim.logs.csv_cells import write_csv
from tuisim.logs.derived import build_reckoned_series
from tuisim.logs.export import build_table_metadata, check_target, export_frame, export_log
from tuisim.logs.frames import build_computed_frame, build_even_frame
from tuisim.logs.log import Series
from tuisim.logs.mcap_export import POSE, SUFFIX, export_mcap, load_writer
from tuisim.settings.command_line import Arguments

if TYPE_CHECKING:
    import pandas as pd

_FIGURE = "figure"
"""In place of a format spec: as the analyser shows numbers."""
_QUANTILE_NAMES = tuple(f"q{100 * part:g}" for part in signals.QUANTILES)


def summary(arguments: Arguments) -> int:
    """Print count, min, max, mean, std and quantiles of every variable."""
    rows: list[dict[str, Any]] = []
    notes: list[str] = []
    for log in open_sources(arguments):
        notes += [f"note: {log.title}: {note}" for note in log.notes]
        for name in choose_names(log, arguments):
            series = log.series(name)
            figures = asdict(signals.compute_summary(series.values))
            quantiles = dict(zip(_QUANTILE_NAMES, figures.pop("quantiles"), strict=True))
            times_s = series.time_s[np.isfinite(series.values)]
            ends_s = (times_s.min(), times_s.max()) if len(times_s) else (np.nan, np.nan)
            span = dict(zip(("first_s", "last_s"), map(float, ends_s), strict=True))
            rows.append({"log": log.title, "variable": name, **span, **figures, **quantiles})
            if arguments.json:
                rows[-1]["notes"] = log.notes
    number = dict.fromkeys(("min", "mean", "max", "std", *_QUANTILE_NAMES), _FIGURE)
    show_rows(
        rows, arguments, {"variable": "", "count": "", "first_s": ".2f", "last_s": ".2f", **number}
    )
    if not arguments.json:
        for note in notes:
            echo_error(note)
    return 0


def bands(arguments: Arguments) -> int:
    """Print the plateaus of every variable: level, name, times, width."""
    reports: list[BandReport] = []
    titles: list[str] = []
    for log in open_sources(arguments):
        for name in choose_names(log, arguments):
            reports.append(build_band_report(log, name))
            titles += [log.title] * len(reports[-1].bands)
    found = [band for report in reports for band in report.bands]
    formats = {
        "variable": "",
        "number": "",
        "start_s": ".2f",
        "stop_s": ".2f",
        "samples": "",
        **({"strays": ""} if any(band.strays for band in found) else {}),
        "level": ".2f",
        **({"true_level": ".2f"} if any(report.has_true_levels for report in reports) else {}),
        "spread": ".2f",
        "grey": "",
        "width_mm": "",
    }
    columns: dict[str, Sequence[Any]] = {
        field.name: list(map(attrgetter(field.name), found)) for field in fields(Band)
    }
    is_table = not arguments.json and not arguments.out
    if is_table:
        columns["width_mm"] = [f"{band.describe_width():>8}" for band in found]
    show_columns({"log": titles, **columns}, arguments, formats)
    if is_table:
        for report in reports:
            echo_wrapped(report.describe())
    return 0


def events(arguments: Arguments) -> int:
    """Print where each variable crosses the threshold, or which commands the programs of runs sent."""
    threshold = _parse_threshold_option(arguments)
    if isinstance(threshold, CommandChoice):
        return _show_commands(arguments, threshold.words)
    if threshold.name:
        arguments.variable = (threshold.name,)
    rows: list[dict[str, Any]] = []
    for log in open_sources(arguments):
        for name in choose_names(log, arguments):
            series = log.series(name)
            for crossing in threshold.find_crossings(series):
                direction = "rises" if crossing.rising else "falls"
                rows.append(
                    {
                        "log": log.title,
                        "variable": name,
                        "time_s": crossing.time_s,
                        "crossing": direction,
                        "value": crossing.value,
                        # Rows are counted from 1, as in the analyser.
                        "row": int(series.rows[crossing.sample]) + 1,
                    }
                )
    show_rows(
        rows,
        arguments,
        {"variable": "", "time_s": ".3f", "crossing": "", "value": _FIGURE, "row": ""},
    )
    return 0


def _show_commands(arguments: Arguments, words: str) -> int:
    """Print the commands that the programs of runs sent to motors and sensors.

    Args:
        arguments: The arguments, which name the runs.
        words: The words to search for in the commands.

    Raises:
        ConfigError: a log is a file, or no run is named.
        LogError: there is no such run.
    """
    if not arguments.words or any(map(is_file, arguments.words)):
        raise ConfigError("only runs have commands", "a stored run such as `last`", key="events")
    # Imported on demand: no other figures need stored runs.
    from tuisim.engine.runs.store import RunStore

    store = RunStore()
    rows = []
    for run in map(store.load_run, arguments.words):
        index = CommandIndex(run)
        index.read_all()
        for number in index.find_events(words):
            rows.append({"run": run.number, **asdict(index.event(number))})
    formats = {"part": "", "time_s": ".3f", "count": "", "last_s": ".3f", "asked": "", "came": ""}
    show_rows(rows, arguments, formats)
    return 0


def _parse_threshold_option(arguments: Arguments) -> EventChoice:
    """Return what `--when` or `--at` searches a log for: a threshold that a variable crosses, or commands.

    A threshold of `--at` has the variable "", which stands for every variable.

    Raises:
        ConfigError: both options are given, or none, or the text of `--when` is no threshold.
    """
    if bool(arguments.when) is (arguments.at is not None):
        raise ConfigError(
            "takes one threshold", "such as --at 50, or --when 'Colour < 50'", key="events"
        )
    if not arguments.when:
        return Threshold("", Operator.EQUAL, repr(arguments.at), hysteresis=arguments.hysteresis)
    if arguments.variable:
        raise ConfigError("names the variable already", "leave --variable out", key="--when")
    choice = parse_event(arguments.when)
    if choice is None:
        raise ConfigError(f"{arguments.when!r} is not a threshold", THRESHOLD_FORM, key="--when")
    if isinstance(choice, CommandChoice):
        return choice
    return replace(choice, hysteresis=choice.hysteresis or arguments.hysteresis)


def _print_each(arguments: Arguments, column: str, change: Callable[[Series], FloatArray]) -> int:
    """Print or write the chosen variables of a log as a long frame with one more column.

    Args:
        arguments: The arguments, which choose the log and the variables.
        column: The name of the column.
        change: Returns the column's values for one variable.
    """
    import pandas as pd

    log = open_single(arguments)
    parts = []
    for name in choose_names(log, arguments):
        series = log.series(name)
        columns = {
            "time": series.time_s,
            "variable": name,
            "value": series.values,
            column: change(series),
        }
        parts.append(pd.DataFrame(columns))
    show_frame(pd.concat(parts, ignore_index=True), arguments)
    return 0


def derive(arguments: Arguments) -> int:
    """Print or write the derivative of each variable, in units per second."""
    return _print_each(
        arguments,
        "derivative",
        lambda series: signals.compute_derivative(series.time_s, series.values),
    )


def integrate(arguments: Arguments) -> int:
    """Print or write the integral of each variable, in units times seconds."""
    return _print_each(
        arguments,
        "integral",
        lambda s: signals.compute_integral(s.time_s, s.values, arguments.between),
    )


def average(arguments: Arguments) -> int:
    """Print or write the centred rolling mean of each variable."""
    return _print_each(
        arguments,
        "average",
        lambda series: signals.compute_moving_average(series.values, arguments.width),
    )


def even(arguments: Arguments) -> int:
    """Print or write every variable resampled at a fixed period, one column each."""
    log = open_single(arguments)
    if arguments.period is None:
        raise ConfigError("no period given", "such as --period 0.1", key="resample")
    all_series = [log.series(name) for name in choose_names(log, arguments)]
    show_frame(build_even_frame(all_series, arguments.period, arguments.between), arguments)
    return 0


def calculate(arguments: Arguments) -> int:
    """Print or write the log with a column computed from an expression."""
    if not arguments.expression:
        raise ConfigError(
            "no expression given", "such as --expression '(left + right) / 2'", key="calc"
        )
    log = open_single(arguments)
    show_frame(build_computed_frame(log, arguments.expression), arguments)
    return 0


def reckon(arguments: Arguments) -> int:
    """Print the error of the pose by dead reckoning from the wheel encoders; or print or write that pose at every tick.

    Raises:
        LogError: the log is no telemetry, or is empty.
    """
    arguments.telemetry = True
    log = open_single(arguments)
    computed = {series.name: series.values for series in build_reckoned_series(log)}
    frame = log.table.select(["time", *POSE]).to_pandas().assign(**computed)
    if arguments.out or arguments.json:
        show_frame(frame, arguments)
        return 0
    if frame.empty:
        raise LogError("has no ticks", file=log.title)
    end = frame.iloc[-1]
    worst = frame.loc[frame["error_mm"].idxmax()]
    real, reckoned = ([end[f"{of}{name}"] for name in POSE] for of in ("", "reckoned_"))
    error = [number - other for number, other in zip(reckoned, real, strict=True)]
    # The error of the heading is reduced to -180 to 180 degrees.
    error = [round(number, 2) + 0.0 for number in (*error[:2], (error[2] + 180.0) % 360.0 - 180.0)]
    rows = [("real", *real), ("reckoned", *reckoned), ("error", *error)]
    formats = dict(zip(("at_the_end", *POSE), ("", ".2f", ".2f", ".2f"), strict=True))
    show_rows([dict(zip(formats, row, strict=True)) for row in rows], arguments, formats)
    echo(
        f"dead reckoning: {end['error_mm']:.2f} mm off at the end, at most {worst['error_mm']:.2f} mm, "
        f"at {worst['time']:.2f} s"
    )
    return 0


def export(arguments: Arguments) -> int:
    """Write the log, or some of its variables, to a file in another format."""
    if not arguments.out:
        raise ConfigError("no file given", "such as --out log.parquet", key="export")
    if Path(arguments.out).suffix.lower() == SUFFIX:
        _export_mcap(arguments)
        return 0
    check_target(arguments.out, (SUFFIX,))
    log = open_single(arguments)
    chosen = log.select_variables(choose_names(log, arguments)) if arguments.variable else log.table
    export_log(log, chosen, arguments.out)
    echo_written(arguments.out)
    return 0


def _export_mcap(arguments: Arguments) -> None:
    target = Path(arguments.out)
    load_writer()
    log = open_single(arguments)
    names = choose_names(log, arguments)
    has_pose = not arguments.variable or set(POSE) <= set(arguments.variable)
    infinite = export_mcap(
        log, names, target, lambda part: tell(f"writing {target}", part, 1.0), has_pose=has_pose
    )
    if infinite:
        values = counted(infinite, "value is", "values are")
        echo_error(f"note: {target}: {values} infinite, which JSON does not have: left out")
    echo_written(target)


def diff(arguments: Arguments) -> int:
    """Print where two stored runs differ; return 0 if they are the same, else 1.

    Raises:
        ConfigError: the arguments do not name two runs.
        LogError: there is no such run, or a run is damaged.
    """
    words = arguments.words
    if len(words) != 2:
        raise ConfigError("takes two runs", f"got {len(words)}", key="diff")
    # Imported on demand: no other command here needs stored runs.
    from tuisim.commands.runs import format_diff
    from tuisim.engine.runs.diff import diff_runs
    from tuisim.engine.runs.store import RunStore

    store = RunStore()
    difference = diff_runs(*map(store.load_run, words))
    if arguments.json:
        echo_json(difference.to_plain())
    else:
        echo_lines(format_diff(difference))
    return 0 if difference.same else 1


# Output


def show_rows(
    rows: Sequence[Mapping[str, Any]], arguments: Arguments, formats: Mapping[str, str]
) -> None:
    """Print or write rows that all have the same keys; `arguments` and `formats` are those of `show_columns`."""
    show_columns(
        {name: [row[name] for row in rows] for name in (rows[0] if rows else ())},
        arguments,
        formats,
    )


def show_columns(
    columns: Mapping[str, Sequence[Any]], arguments: Arguments, formats: Mapping[str, str]
) -> None:
    """Print or write columns of the same length.

    Args:
        columns: Values by the name of the column.
        arguments: `json` and `out` select the format.
        formats: Columns of the table, and their format specs, such as `.2f`, or `_FIGURE`.
    """
    if not any(map(len, columns.values())):
        columns = dict.fromkeys(formats, ())
    if arguments.out:
        import pandas as pd

        write_frame(pd.DataFrame(columns), arguments)
    elif arguments.json:
        rows = zip(*columns.values(), strict=True)
        echo_json_list(replace_infinite(dict(zip(columns, row, strict=True))) for row in rows)
    else:
        heads = [name.upper().replace("_", " ") for name in formats]
        echo_table(
            heads,
            [_format_cells(columns[name], how) for name, how in formats.items()],
            [_are_numbers(columns[name]) for name in formats],
        )


def show_frame(frame: pd.DataFrame, arguments: Arguments) -> None:
    """Print or write a frame: to a file, as JSON lines, or as CSV on stdout."""
    if arguments.out:
        write_frame(frame, arguments)
    elif arguments.json:
        _print_json(frame)
    else:
        write_csv(frame, CsvOut())


def _print_json(frame: pd.DataFrame) -> None:
    """Print each row as a JSON object with numbers in full precision, which `DataFrame.to_json` does not keep."""
    names = [str(name) for name in frame.columns]
    for cells in zip(*(frame[name].tolist() for name in frame.columns), strict=True):
        echo_json(replace_infinite(dict(zip(names, cells, strict=True))))


def write_frame(frame: pd.DataFrame, arguments: Arguments) -> None:
    """Write a frame to the file `out`; the suffix selects the format."""
    check_target(arguments.out)
    export_frame(frame, arguments.out, build_table_metadata(arguments.action, frame))
    echo_written(arguments.out)


def _are_numbers(column: Sequence[Any]) -> bool:
    return len(column) > 0 and all(isinstance(item, int | float) for item in column)


def _format_cells(column: Sequence[Any], format_spec: str) -> list[str]:
    """Return the texts of a column's cells; a missing number is an empty text."""
    if not format_spec:
        return list(map(str, column))
    cells = []
    for item in column:
        if not isinstance(item, float):
            cells.append(str(item))
        elif isnan(item):
            cells.append("")
        else:
            cells.append(
                signals.format_figure(item) if format_spec == _FIGURE else format(item, format_spec)
            )
    return cells
