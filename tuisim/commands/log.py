"""`tuisim log`: analysis of logs in the shell.

To add a subcommand: write its function in `commands/logs/` and add a line to `SUBCOMMANDS`.
"""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any, cast

from tuisim.commands.logs.columns import add_columns
from tuisim.commands.progress import Progress
from tuisim.config.options import SwitchParser, nearest
from tuisim.errors import ConfigError
from tuisim.logs.export import LISTED

COMMON = ("time", "unit", "value", "variable", "telemetry", "json", "out")
_CHART = ("facets", "marks", "from", "to", "against", "size")


@dataclass(frozen=True, slots=True)
class Subcommand:
    """One line of `SUBCOMMANDS`."""

    does: str
    path: str
    """MODULE:FUNCTION in `commands/logs`; imported on use."""
    options: tuple[str, ...] = ()
    """Its options besides `COMMON`, from `OPTIONS`."""

    def load(self) -> Callable[[Namespace], int]:
        """Import the function."""
        module, _, function = self.path.partition(":")
        return cast("Callable[[Namespace], int]", getattr(import_module(f"tuisim.commands.logs.{module}"), function))


SUBCOMMANDS: Mapping[str, Subcommand] = {
    "summary": Subcommand("count, min, max, mean, std and quantiles of each variable", "figures:summary"),
    "bands": Subcommand("plateaus: level, name, times, width", "figures:bands"),
    "events": Subcommand("where a variable crosses --at", "figures:events", ("at", "hysteresis")),
    "derive": Subcommand("derivative, in units per second", "signals:derive"),
    "integrate": Subcommand("integral, in units times seconds", "signals:integrate", ("between",)),
    "average": Subcommand("centred rolling mean of --width samples", "signals:average", ("width",)),
    "resample": Subcommand("resample all variables every --period seconds", "signals:even", ("period", "between")),
    "calc": Subcommand("evaluate --expression over the columns", "signals:calculate", ("expression",)),
    "reckon": Subcommand("dead reckoning from the wheel encoders, and its error", "signals:reckon"),
    "diff": Subcommand("where two runs differ; exit code 1 if they do", "diff:diff"),
    "export": Subcommand("the log in another format", "signals:export"),
    "plot": Subcommand("the chart, as text, SVG or PNG", "plot:plot", _CHART),
    "report": Subcommand("program, world, chart, bands, statistics and notes on one page", "report:report"),
}
"""The subcommands of `tuisim log`, by name."""

OPTIONS: Mapping[str, Mapping[str, Any]] = {
    "at": {"type": float, "metavar": "VALUE", "help": "events: threshold"},
    "hysteresis": {"type": float, "default": 0.0, "metavar": "VALUE", "help": "events: margin around the threshold"},
    "between": {
        "choices": ("hold", "linear"),
        "default": "hold",
        "metavar": "hold|linear",
        "help": "interpolation between samples (hold)",
    },
    "width": {"type": int, "default": 5, "metavar": "N", "help": "average: window in samples, odd (5)"},
    "period": {"type": float, "metavar": "S", "help": "resample: seconds between rows"},
    "expression": {"default": "", "metavar": "TEXT", "help": "calc: such as '(left + right) / 2', see README"},
    "facets": {"action": "store_true", "default": False, "help": "plot: one chart per variable"},
    "marks": {"action": "store_true", "default": False, "help": "plot: points instead of lines"},
    "from": {"type": float, "metavar": "S", "help": "plot: first second shown"},
    "to": {"type": float, "metavar": "S", "help": "plot: last second shown"},
    "against": {"default": "", "metavar": "NAME", "help": "plot: variable or column for the x axis, instead of time"},
    "size": {"default": "", "metavar": "WxH", "help": "plot: in pixels; in characters for text"},
}
"""Options of some subcommands only, by name, with their arguments for `add_argument`."""


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim log`."""
    parser.usage = "tuisim log SUBCOMMAND LOG… [options]"
    listing = "\n".join(f"  {name:<10} {entry.does}" for name, entry in SUBCOMMANDS.items())
    parser.description = (
        "Analyse logs. A LOG is a stored run (its number, its id, `last`), a CSV, Parquet, JSONL, Arrow or text\n"
        "file, or - for the standard input.\n\nsubcommands:\n" + listing
    )
    parser.epilog = (
        "examples:\n  tuisim log bands last\n  tuisim log events log.csv --at 50 --hysteresis 5 --json\n"
        "  tuisim run prog.py | tuisim log summary -\n"
        "  tuisim log resample last --telemetry --period 0.5 --out half.parquet\n"
        "  tuisim log plot last --facets --out chart.svg\n"
        "  tuisim log report last\n"
        "  tuisim log plot last --telemetry --variable y_mm --against x_mm"
    )
    parser.add_argument("action", metavar="SUBCOMMAND", help="what to do")
    parser.add_argument("words", nargs="*", metavar="LOG", help="runs, files or -")
    parser.add_argument(
        "--variable", action="append", default=[], metavar="NAME", help="only this variable; may be repeated"
    )
    parser.add_argument("--telemetry", action="store_true", help="use the telemetry of a run instead of its samples")
    add_columns(parser)
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument(
        "--out",
        metavar="FILE",
        help=f"write the result to a file: {LISTED}; plot: .svg, .png, .txt; report: .html",
    )
    for option, declared in OPTIONS.items():
        parser.add_argument(f"--{option}", **declared)


def execute(arguments: Namespace) -> int:
    """Run the subcommand.

    Raises:
        ConfigError: no such subcommand, or an option that it does not have.
        LogError: a log cannot be read.
        ExportError: a file cannot be written.
    """
    entry = SUBCOMMANDS.get(arguments.action)
    if entry is None:
        raise ConfigError(f"no such subcommand {arguments.action!r}", nearest(arguments.action, SUBCOMMANDS), key="log")
    for option, declared in OPTIONS.items():
        if option not in entry.options and getattr(arguments, option) != declared.get("default"):
            takes = " ".join(f"--{name}" for name in (*entry.options, *COMMON))
            raise ConfigError(f"does not take --{option}", f"it takes {takes}", key=arguments.action)
    with Progress(" ".join(("log", arguments.action, *arguments.words))):
        return entry.load()(arguments)
