"""`tuisim analyse`: the arguments of the analyser; `cli` starts it."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import dataclass

from tuisim.commands.logs.columns import add_columns
from tuisim.commands.logs.sources import is_file
from tuisim.config.options import SwitchParser
from tuisim.errors import ConfigError


@dataclass(frozen=True, slots=True)
class Asked:
    """The log to open: a file, or runs."""

    file: str
    """Empty for runs."""
    runs: tuple[str, ...]


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim analyse`."""
    parser.usage = "tuisim analyse [RUN…|FILE|-] [options]"
    parser.epilog = (
        "A RUN is given by its number, its id, or `last` (the default); several are drawn in one chart.\n"
        "A FILE is CSV, Parquet, JSONL, Arrow or text with lines such as `Colour: 98.8`; - is the standard input."
    )
    parser.add_argument("words", nargs="*", metavar="LOG", help="runs, a file, or -")
    parser.add_argument("--telemetry", action="store_true", help="use the telemetry of a run instead of its samples")
    add_columns(parser)


def asked(arguments: Namespace) -> Asked:
    """Return the file or the runs that the arguments name.

    Raises:
        ConfigError: a file together with another log.
    """
    words = arguments.words or ["last"]
    files = [word for word in words if is_file(word)]
    if files and len(words) > 1:
        raise ConfigError("takes one file, or runs", f"got {' '.join(words)}", key="analyse")
    return Asked(files[0] if files else "", () if files else tuple(words))
