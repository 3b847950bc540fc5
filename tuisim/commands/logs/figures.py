"""`tuisim log summary`, `bands` and `events`."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from tuisim.analysis.events import crossings
from tuisim.commands.echo import echo_lines
from tuisim.commands.logs.results import show_rows
from tuisim.commands.logs.sources import names_of, open_sources
from tuisim.config.command_line import Arguments
from tuisim.errors import ConfigError
from tuisim.logs.bands import band_report, in_words
from tuisim.logs.signals import QUANTILES, summary_of

_QUANTILE_NAMES = tuple(f"q{100 * part:g}" for part in QUANTILES)


def summary(arguments: Arguments) -> int:
    """Print count, min, max, mean, std and quantiles of every variable."""
    rows: list[dict[str, Any]] = []
    for log in open_sources(arguments):
        for name in names_of(log, arguments):
            series = log.series(name)
            figures = asdict(summary_of(series.values))
            quantiles = dict(zip(_QUANTILE_NAMES, figures.pop("quantiles"), strict=True))
            times_s = series.time_s
            span = {"first_s": float(times_s.min()), "last_s": float(times_s.max())}
            rows.append({"log": log.title, "variable": name, **span, **figures, **quantiles})
    number = dict.fromkeys(("min", "mean", "max", "std", *_QUANTILE_NAMES), ".4g")
    show_rows(rows, arguments, {"variable": "", "count": "", "first_s": ".2f", "last_s": ".2f", **number})
    return 0


def bands(arguments: Arguments) -> int:
    """Print the plateaus of every variable: level, name, times, width."""
    rows: list[dict[str, Any]] = []
    notes = []
    for log in open_sources(arguments):
        for name in names_of(log, arguments):
            report = band_report(log, name)
            rows += [{"log": log.title, **asdict(band)} for band in report.bands]
            notes.append(in_words(report))
    formats = {
        "variable": "", "number": "", "start_s": ".2f", "stop_s": ".2f", "samples": "", "level": ".2f",
        "true_level": ".2f", "spread": ".2f", "grey": "", "width_mm": ".0f",
    }  # fmt: skip
    show_rows(rows, arguments, formats)
    if not arguments.json and not arguments.out:
        echo_lines("\n".join(notes))
    return 0


def events(arguments: Arguments) -> int:
    """Print where each variable crosses the threshold."""
    if arguments.at is None:
        raise ConfigError("at which threshold?", "such as --at 50", key="events")
    rows: list[dict[str, Any]] = []
    for log in open_sources(arguments):
        for name in names_of(log, arguments):
            series = log.series(name)
            for found in crossings(series.time_s, series.values, arguments.at, arguments.hysteresis):
                direction = "rises" if found.rising else "falls"
                row = int(series.rows[found.at])
                rows.append({"log": log.title, "variable": name, "time_s": found.time_s, "crossing": direction,
                             "value": found.value, "row": row})  # fmt: skip
    show_rows(rows, arguments, {"variable": "", "time_s": ".3f", "crossing": "", "value": ".4g", "row": ""})
    return 0
