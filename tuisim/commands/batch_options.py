"""Options of the commands that execute batches: worker processes, and which runs are stored."""

from __future__ import annotations

from typing import Any

from tuisim.engine.core.values import Whole
from tuisim.settings.command_line import GroupedOption, WordType, choice, option
from tuisim.settings.options import parse
from tuisim.tasks.task import MAX_JOBS, Keep

_WORKERS = Whole(1, MAX_JOBS)


def build_workers_option(flag: str, text: str, **how: Any) -> GroupedOption:
    """Return an option for a number of workers, whose value is 0 if the user does not give it."""
    return option(
        flag,
        default=0,
        metavar="N",
        type=WordType(lambda word: parse(_WORKERS, word, flag)),
        help=text,
        **how,
    )


def build_jobs_option(**how: Any) -> GroupedOption:
    """Return `--jobs N`."""
    return build_workers_option(
        "--jobs", "Number of worker processes (one for each processor).", **how
    )


def keep_option(usual: Keep, group: str) -> GroupedOption:
    """Return `--keep all|failed|none`, None if the user does not give it; its help names `usual` as the default."""
    return choice(
        "--keep",
        [kept_runs.value for kept_runs in Keep],
        group=group,
        help=f"Which runs to store ({usual.value}).",
    )
