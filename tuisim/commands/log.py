"""`tuisim log`: analysis of logs in the shell.

To add a subcommand: write its function in `commands/logs/` and add a line to `SUBCOMMANDS`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import cast

from tuisim.base.data_class import dataclass
from tuisim.commands.echo import Progress
from tuisim.commands.listings import COLUMN
from tuisim.logs.choices import WORDS
from tuisim.logs.export import EXPORTERS, LISTED
from tuisim.settings.command_line import (
    Arguments,
    Command,
    Group,
    GroupedOption,
    WordType,
    argument,
    choice,
    option,
)


def _replace_none(_: object, __: object, word: str | None) -> str:
    """Return the word that the user chose, or an empty text for None.

    This is the callback of an option with choices.
    """
    return word or ""


TELEMETRY = option(
    "--telemetry", is_flag=True, help="Use the telemetry of a run instead of its samples."
)
COLUMNS = (
    option("--time", metavar="COLUMN", group="Columns", help="Time column; '' uses row numbers."),
    choice(
        "--unit",
        WORDS["unit"],
        group="Columns",
        callback=_replace_none,
        help="Unit of the time column, if its name does not give it.",
    ),
    option(
        "--value",
        multiple=True,
        metavar="COLUMN",
        group="Columns",
        help="Value column; may be repeated.",
    ),
    option(
        "--header",
        type=int,
        default=0,
        metavar="LINE",
        group="Text",
        help="Line of the file with the names of the columns.",
    ),
    option(
        "--table",
        type=int,
        default=1,
        metavar="N",
        group="Text",
        help="Number of the table, if the file has several (1).",
    ),
    option(
        "--encoding",
        default="",
        metavar="NAME",
        group="Text",
        help="Encoding, such as utf-8, cp1252, gbk or shift_jis.",
    ),
    choice(
        "--separator",
        WORDS["separator"],
        group="Text",
        callback=_replace_none,
        help="Separator between the cells.",
    ),
    choice(
        "--decimal",
        WORDS["decimal"],
        group="Text",
        callback=_replace_none,
        help="Decimal sign.",
    ),
)
"""Options that say how a file is to be read."""

OPTIONS: Mapping[str, GroupedOption] = {
    "at": option("--at", type=float, metavar="VALUE", help="Threshold."),
    "when": option(
        "--when",
        type=COLUMN,
        default="",
        metavar="TEXT",
        help="Variable, operator, threshold: 'Colour < 50 +- 2'; or 'command' for commands of the program.",
    ),
    "hysteresis": option(
        "--hysteresis",
        type=float,
        default=0.0,
        metavar="VALUE",
        help="Margin around the threshold (0).",
    ),
    "between": choice(
        "--between",
        ("hold", "linear"),
        default="hold",
        help="Interpolation between samples (hold).",
    ),
    "width": option(
        "--width", type=int, default=5, metavar="N", help="Window in samples, odd (5)."
    ),
    "period": option("--period", type=float, metavar="S", help="Seconds between rows."),
    "expression": option(
        "--expression",
        type=COLUMN,
        default="",
        metavar="TEXT",
        help="Expression, such as '(left + right) / 2'.",
    ),
    "facets": option("--facets", is_flag=True, help="Draw one chart per variable."),
    "marks": option("--marks", is_flag=True, help="Draw points instead of lines."),
    "from": option("--from", type=float, metavar="S", help="Start of the time range, in seconds."),
    "to": option("--to", type=float, metavar="S", help="End of the time range, in seconds."),
    "against": option(
        "--against",
        type=COLUMN,
        default="",
        metavar="NAME",
        help="Variable or column for the x axis, instead of time.",
    ),
    "size": option(
        "--size", default="", metavar="WxH", help="Size in pixels; in characters for text."
    ),
    "variable": option(
        "--variable",
        type=COLUMN,
        multiple=True,
        metavar="NAME",
        help="Only this variable; may be repeated.",
    ),
    "telemetry": TELEMETRY,
    "json": option("--json", is_flag=True, help="Print JSON."),
    "out": option(
        "--out", metavar="FILE", type=WordType(), help=f"Write the result to a file: {LISTED}."
    ),
    "copy": option(
        "--out",
        metavar="FILE",
        type=WordType(),
        help=f"Write the log to a file: {', '.join(EXPORTERS)} or .mcap.",
    ),
    "chart": option(
        "--out",
        metavar="FILE",
        type=WordType(),
        help="Write the chart to a file: .svg, .png, .txt.",
    ),
    "page": option(
        "--out", metavar="FILE", type=WordType(), help="Write the page to this .html file."
    ),
}
"""The options of the subcommands besides `COLUMNS`; four are called `--out`."""

_TABLE = ("variable", "telemetry", "json", "out")
_FRAME = ("telemetry", "json", "out")
_PAGE = ("variable", "telemetry", "page")
_CHART = ("facets", "marks", "from", "to", "against", "size", "variable", "telemetry", "chart")


@dataclass(frozen=True, slots=True)
class Subcommand:
    """A subcommand of `tuisim log`: its help, its options and its function."""

    does: str
    path: str
    """MODULE:FUNCTION in `commands/logs`; imported on use."""
    options: tuple[str, ...] = _TABLE
    words: str = "LOG…"
    """Its logs, as the help names them."""
    more: str = ""
    """What else its help says."""

    def load(self) -> Callable[[Arguments], int]:
        """Import the subcommand's function and return it."""
        module, _, function = self.path.partition(":")
        return cast(
            "Callable[[Arguments], int]",
            getattr(import_module(f"tuisim.commands.logs.{module}"), function),
        )


SUBCOMMANDS: Mapping[str, Subcommand] = {
    "summary": Subcommand(
        "Print count, min, max, mean, std and quantiles of each variable", "tables:summary"
    ),
    "bands": Subcommand(
        "Find plateaus: level, name, times, width",
        "tables:bands",
        more="START S and STOP S are the first and the last sample of a level. WIDTH MM is the distance driven from "
        "edge to edge: from where the reading is halfway between the level before and this one, to where it is halfway "
        "to the level after. A band on which the log begins or ends is cut off; – means that an edge is not known.",
    ),
    "events": Subcommand(
        "Find where a variable crosses --at, or --when; or commands of the program",
        "tables:events",
        ("at", "when", "hysteresis", *_TABLE),
    ),
    "derive": Subcommand("Compute the derivative, in units per second", "tables:derive"),
    "integrate": Subcommand(
        "Compute the integral, in units times seconds", "tables:integrate", ("between", *_TABLE)
    ),
    "average": Subcommand(
        "Compute a centred rolling mean of --width samples", "tables:average", ("width", *_TABLE)
    ),
    "resample": Subcommand(
        "Resample each variable every --period seconds",
        "tables:even",
        ("period", "between", *_TABLE),
    ),
    "calc": Subcommand(
        "Evaluate --expression over the columns", "tables:calculate", ("expression", *_FRAME)
    ),
    "reckon": Subcommand(
        "Compare the pose by dead reckoning with the real one; --json or --out FILE for every tick",
        "tables:reckon",
        _FRAME,
    ),
    "diff": Subcommand(
        "Show where two runs differ; exit code 1 if they do", "tables:diff", ("json",), "RUN RUN"
    ),
    "export": Subcommand(
        "Write the log in another format",
        "tables:export",
        ("variable", "telemetry", "copy"),
        more="The column `run` counts the runs in the file, from 1: it is not the number of a stored run.",
    ),
    "plot": Subcommand("Draw the chart, as text, SVG or PNG", "documents:plot", _CHART),
    "report": Subcommand(
        "Write a one-page report: program, world, chart, bands", "documents:report", _PAGE
    ),
}
"""The subcommands of `tuisim log`, by name."""


def _load(name: str) -> Command:
    entry = SUBCOMMANDS[name]

    def work(**options: object) -> int:
        arguments = Arguments(action=name, **options)
        with Progress(" ".join(("log", name, *arguments.words))):
            return entry.load()(arguments)

    options = [OPTIONS[option] for option in entry.options]
    columns = () if name == "diff" else COLUMNS
    words = argument("words", entry.words, lambda: ("last",), nargs=-1)
    text = f"{entry.does}.\n\n{entry.more}".strip()
    return Command(name, callback=work, params=[words, *options, *columns], help=text)


_OTHER_WORDS = {
    **dict.fromkeys(("stats", "statistics", "stat", "describe", "mean", "info"), "summary"),
    **dict.fromkeys(("levels", "plateaus", "greys"), "bands"),
    **dict.fromkeys(("chart", "graph", "draw", "show"), "plot"),
    **dict.fromkeys(("save", "convert", "csv"), "export"),
    **dict.fromkeys(("compare", "difference"), "diff"),
    **dict.fromkeys(("smooth", "filter"), "average"),
    **dict.fromkeys(("crossings", "threshold"), "events"),
}
"""Other words for subcommands, for which a message names the right one."""

log = Group(
    "log",
    {name: entry.does for name, entry in SUBCOMMANDS.items()},
    _load,
    subcommand_metavar="COMMAND LOG… [OPTIONS]",
    instead={word: f"did you mean `tuisim log {name}`?" for word, name in _OTHER_WORDS.items()},
    help="""Analyse logs.

    A LOG is a stored run (its number, its id, `last`), a CSV, Parquet, JSONL, Arrow or text file, or - for the
    standard input.
    """,
    epilog="""\b
    Examples:
      tuisim log bands last
      tuisim log events log.csv --at 50 --hysteresis 5 --json
      tuisim log events last --when 'left_red_pc < 50'
      tuisim run prog.py | tuisim log summary -
      tuisim log resample last --telemetry --period 0.5 --out half.parquet
      tuisim log plot last --facets --out chart.svg
      tuisim log plot last --telemetry --variable y_mm --against x_mm
      tuisim log report last
    """,
)
