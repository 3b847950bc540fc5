"""Options of the commands that run programs: limits and answers."""

from __future__ import annotations

from tuisim.engine.core.values import Number
from tuisim.engine.runs.handle import DEFAULT_TIME_LIMIT_S
from tuisim.settings.command_line import GroupedOption, WordType, option
from tuisim.settings.options import parse

MAX_TIME_LIMIT_S = 1e6

_LIMIT = Number(0.001, MAX_TIME_LIMIT_S)


def build_timeout_option(group: str, default_s: float = DEFAULT_TIME_LIMIT_S) -> GroupedOption:
    """Return `--timeout S`, in simulated seconds."""
    return option(
        "--timeout",
        default=default_s,
        metavar="S",
        group=group,
        type=WordType(lambda text: parse(_LIMIT, text, "--timeout")),
        help=f"Stop a run after this simulated time in seconds ({default_s:g}).",
    )


def build_input_option(group: str) -> GroupedOption:
    """Return `--input TEXT`: the answers of each run, in order."""
    return option(
        "--input",
        multiple=True,
        metavar="TEXT",
        group=group,
        help="Answer an input() of each program; may be repeated.",
    )
