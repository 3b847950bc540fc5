"""Options of the commands that run programs: limits, answers, worker processes, and which runs are stored."""

from __future__ import annotations

from typing import Any

from tuisim.engine.core.values import Number, Whole
from tuisim.engine.runs.handle import DEFAULT_TIME_LIMIT_S
from tuisim.settings.command_line import GroupedOption, choice, option
from tuisim.settings.shared_options import build_type
from tuisim.tasks.task import MAX_JOBS, Keep

MAX_TIME_LIMIT_S = 1e6

_LIMIT = Number(0.001, MAX_TIME_LIMIT_S)


def build_timeout_option(group: str, default_s: float = DEFAULT_TIME_LIMIT_S) -> GroupedOption:
    """Return the option `--timeout S`, in simulated seconds."""
    return option(
        "--timeout",
        default=default_s,
        metavar="S",
        group=group,
        type=build_type(_LIMIT, "--timeout"),
        help=f"Stop a run after this simulated time in seconds ({default_s:g}).",
    )


def build_input_option(group: str) -> GroupedOption:
    """Return the option `--input TEXT`: the answers to `input()` in each run, in order."""
    return option(
        "--input",
        multiple=True,
        metavar="TEXT",
        group=group,
        help="Answer an input() of each program; may be repeated.",
    )


_WORKERS = Whole(1, MAX_JOBS)


def build_workers_option(flag: str, text: str, **how: Any) -> GroupedOption:
    """Return an option for a number of workers, whose value is 0 if the user does not give it."""
    return option(
        flag,
        default=0,
        metavar="N",
        type=build_type(_WORKERS, flag),
        help=text,
        **how,
    )


def build_jobs_option(**how: Any) -> GroupedOption:
    """Return the option `--jobs N`."""
    return build_workers_option(
        "--jobs", "Number of worker processes (one for each processor).", **how
    )


def keep_option(usual: Keep, group: str) -> GroupedOption:
    """Return the option `--keep all|failed|none`, which is None if the user does not give it.

    Args:
        usual: The default, for the help.
        group: The heading of the option in the help.
    """
    return choice(
        "--keep",
        [kept_runs.value for kept_runs in Keep],
        group=group,
        help=f"Which runs to store ({usual.value}).",
    )
