"""Recent work to continue: unsaved texts, programs that have run, and runs."""

from __future__ import annotations

import time
from collections.abc import Iterator
from datetime import datetime
from enum import StrEnum
from pathlib import Path

from tuisim.app.editor.text_file import is_protected, list_drafts
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.base.folders import home_folder
from tuisim.engine.runs.catalogue import RunInfo
from tuisim.engine.runs.run_folder import read_run_file
from tuisim.engine.runs.store import RunStore

_RUNS_READ = 20
"""Number of the newest runs that are read for their programs."""
_MOST = 5
_MOST_OF_KIND = 3
"""Entries: each has a number beside the four ways to begin, and all are in sight at 80x24."""


class Kind(StrEnum):
    """The type of a piece of recent work: an unsaved text (draft), a program or a run."""

    DRAFT = "draft"
    PROGRAM = "program"
    RUN = "run"


@dataclass(frozen=True, slots=True)
class Recent:
    """A piece of recent work that the user may continue: an unsaved text, a program or a run."""

    kind: Kind
    word: str
    """Path of a program, empty for one without a file; id of a run."""
    name: str
    title: str


def list_recent(new_name: str) -> list[Recent]:
    """Return recent work that the user may continue, the most likely first. This reads files.

    Args:
        new_name: Name for a program without a file.
    """
    own_drafts = [draft for draft in list_drafts() if not draft.path or _is_own(draft.path)][
        :_MOST_OF_KIND
    ]
    unsaved = [
        Recent(
            Kind.DRAFT,
            draft.path,
            Path(draft.path or new_name).name,
            f"Not saved, edited {_format_time(draft.written_s)}{_name_folder(draft.path)}",
        )
        for draft in own_drafts
    ]
    try:
        runs = RunStore().runs()[: -_RUNS_READ - 1 : -1]
    except LogError:
        return unsaved
    known = {draft.path for draft in own_drafts}
    programs = [
        Recent(Kind.PROGRAM, path, Path(path).name, f"Ran {when}{_name_folder(path)}")
        for path, when in _list_programs(runs)
        if path not in known
    ]
    replays = [
        Recent(
            Kind.RUN,
            run.id,
            f"Run {run.number}",
            f"{run.program} on {Path(run.background).name}, {_describe_run(run)}",
        )
        for run in runs
        if run.ticks
    ]
    texts = [*unsaved, *programs[:_MOST_OF_KIND]]
    # Room is left for the last run, which is always listed.
    texts = texts[: _MOST - len(replays[:1])]
    return [*texts, *replays[:_MOST_OF_KIND]][:_MOST]


def _list_programs(runs: list[RunInfo]) -> Iterator[tuple[str, str]]:
    """Yield the path of each of the user's programs that still exists, and the time of its last run."""
    store = RunStore()
    seen = set()
    for run in runs:
        try:
            program = read_run_file(store.folder(run.id)).get("program")
        except LogError:
            # The run was removed or is damaged: leave it out here, since the list of runs reports that.
            continue
        path = program.get("path") if isinstance(program, dict) else None
        if (
            isinstance(path, str)
            and path not in seen
            and _is_own(path)
            and not is_protected(Path(path))
        ):
            seen.add(path)
            yield path, _describe_run(run)


def _is_own(path: str) -> bool:
    """Return whether a program still exists, and does not belong to a lesson."""
    try:
        return Path(path).is_file() and not Path(path).is_relative_to(home_folder())
    except (OSError, ValueError):
        return False


def _name_folder(path: str) -> str:
    """Return in words the folder of a program; empty for a program without a file."""
    folder = str(Path(path).parent)
    home = str(Path.home())
    short = f"~{folder.removeprefix(home)}" if folder.startswith(home) else folder
    return f", in {short}" if path else ""


def _describe_run(run: RunInfo) -> str:
    try:
        return _format_time(datetime.fromisoformat(run.created).timestamp())
    except ValueError:
        return run.created[:16]


def _format_time(seconds: float) -> str:
    """Return a time, in seconds since 1970, as date and time; if it is of today, without the date."""
    then = time.localtime(seconds)
    is_today = then[:3] == time.localtime()[:3]
    return time.strftime("at %H:%M" if is_today else "on %d %b %H:%M", then)
