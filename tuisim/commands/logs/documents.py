"""`tuisim log plot` and `report`: the chart of a log in the shell or in a file, and a one-page report."""

from __future__ import annotations

import math
import shutil
from dataclasses import replace
from functools import partial
from pathlib import Path

from tuisim.analysis.chart import View, build_chart
from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.source import LogRequest, OpenedLog
from tuisim.base.errors import ConfigError, LogError, listed
from tuisim.commands.echo import echo_drawn, echo_error, echo_written
from tuisim.commands.logs.sources import build_request, choose_names, open_single
from tuisim.logs.derived import add_named_columns
from tuisim.logs.log import Log
from tuisim.pictures.charts.files import (
    CHART_FORMATS,
    find_format,
    save_chart,
)
from tuisim.settings.command_line import Arguments

_MIN_COLUMNS = 20
_ROWS = (12, 32)
"""Size of the chart in the shell: minimum width, and limits of its height."""


def plot(arguments: Arguments) -> int:
    """Draw the chart of a log: to the file `out` or, without it, as text on stdout.

    Raises:
        ConfigError: an option is invalid.
        LogError: the log cannot be read, or there is no such variable.
        ExportError: the file cannot be written.
    """
    target = Path(arguments.out) if arguments.out else None
    kind = find_format(target) if target else CHART_FORMATS[".txt"]
    size = kind.parse_size(arguments.size) if arguments.size else None
    log = open_single(arguments)
    model = _build_model(log, arguments)
    view = View(arguments.facets, arguments.marks, against=_choose_pair(log, model, arguments))
    _check_visible(model)
    if target:
        save_chart(partial(build_chart, model, view), target, size)
        echo_written(target)
    else:
        _show(model, view, size)
    hidden = [trace.name for trace in model.traces if not trace.on]
    if hidden and not arguments.variable:
        echo_error(f"note: not drawn: {listed(hidden)}; --variable NAME draws one")
    return 0


def _check_visible(model: AnalysisModel) -> None:
    ticked = model.traces.list_ticked()
    if not any(len(trace.pyramid.times_s) for trace in ticked):
        raise LogError(
            f"no numbers in {listed(trace.name for trace in ticked)}", file=model.log.title
        )
    if not any(len(trace.pyramid.select_range(*model.find_x_limits())[0]) for trace in ticked):
        low, high = model.traces.find_span_s()
        raise LogError(
            "no samples in this range",
            f"they are between {low:g} s and {high:g} s",
            file=model.log.title,
        )


def _build_model(log: Log, arguments: Arguments) -> AnalysisModel:
    """Return the analyser's model of a log, with the variables and the time range in the arguments."""
    model = AnalysisModel(OpenedLog(LogRequest(), log))
    if arguments.variable and not arguments.against:
        names = choose_names(log, arguments)
        for trace in model.traces:
            trace.on = trace.name in names
    start = getattr(arguments, "from")
    stop = arguments.to
    if start is None and stop is None:
        return model
    low, high = model.traces.find_span_s()
    low, high = low if start is None else start, high if stop is None else stop
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise ConfigError(
            f"no range from {low:g} s to {high:g} s", "--from must be less than --to", key="plot"
        )
    model.limits = low, high
    return model


def _choose_pair(log: Log, model: AnalysisModel, arguments: Arguments) -> tuple[str, str] | None:
    if not arguments.against:
        return None
    if len(arguments.variable) > 1:
        raise ConfigError(
            "draws one --variable against another",
            f"got {len(arguments.variable)}",
            key="--against",
        )
    y = arguments.variable[0] if arguments.variable else model.selected
    if y not in log.names:
        # `against` is a column of the samples, such as y_mm; of several runs, the first one's variable is drawn.
        return arguments.against, y
    model.selected = y
    return arguments.against, y


def _show(model: AnalysisModel, view: View, size: tuple[int, int] | None) -> None:
    """Print the chart, in colour if the terminal supports it."""
    from tuisim.pictures.charts.text_chart import draw_text

    terminal = shutil.get_terminal_size()
    width, height = size or (
        max(terminal.columns, _MIN_COLUMNS),
        min(max(terminal.lines - 2, _ROWS[0]), _ROWS[1]),
    )
    finer = CHART_FORMATS[".txt"].finer
    chart = build_chart(model, view, width * finer[0], height * finer[1])
    echo_drawn(lambda colors: draw_text(chart, width, height, colors=colors), width)


def report(arguments: Arguments) -> int:
    """Write the report on a log as a file and print its path.

    Raises:
        ConfigError: no log is named, or a file together with another log.
        LogError: the log cannot be read, or there is no such variable.
        ExportError: the file cannot be written.
    """
    # Imported on demand: it imports the code for pictures and movies, which a chart does not need.
    from tuisim.analysis.report import build_default_name, check_report, write_report
    from tuisim.tasks.reasons.reason import describe_reasons

    if not arguments.words:
        raise ConfigError(
            "no log given", "a file, `-`, or a stored run such as `last`", key="report"
        )
    if arguments.out:
        check_report(Path(arguments.out))
    request = build_request(arguments)
    if arguments.telemetry and len(request.runs) > 1:
        raise ConfigError("takes one run", f"got {len(request.runs)}", key="--telemetry")
    if request.runs and (arguments.time is not None or arguments.value):
        raise ConfigError(
            "are for files only", "the columns of a run are fixed", key="--time and --value"
        )
    *_, source = request.open_pieces()
    source = replace(source, log=add_named_columns(source.log, " ".join(arguments.variable)))
    names = choose_names(source.log, arguments) if arguments.variable else ()
    target = Path(arguments.out or build_default_name(source))
    write_report(source, target, names, explain=describe_reasons)
    echo_written(target)
    return 0
