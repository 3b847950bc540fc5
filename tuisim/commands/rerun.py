"""Repeats a stored run: same program, world, seed and user actions, headless, bit by bit.

What a run folder does not hold is read from its original place: the image of the mat, files that the program opens,
and modules that are installed or compiled.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import LogError, shortened
from tuisim.engine.protocol import End, RunState, Stop, Unended, UserAction
from tuisim.engine.runs.diff import RunDiff, diff_runs
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.engine.runs.run_folder import restore_program
from tuisim.engine.runs.side_files import FilesRead

if TYPE_CHECKING:
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.engine.runs.store import RunStore

CUT_OFF: frozenset[RunState] = frozenset(
    {
        End.STOPPED,
        End.KILLED,
        End.CRASHED,
        Unended.INTERRUPTED,
        Unended.RUNNING,
        End.STALLED,
        End.DISK_FULL,
    }
)
"""Ends that do not result from the program and its limits: such a run is a prefix of its re-run."""
MAX_PATH = 200
"""Characters of a path that are shown."""


def rerun(run: StoredRun, store: RunStore, **options: Any) -> RunHandle:
    """Run a stored run again, at full speed; return a handle of the new run, which has been started.

    Args:
        run: The run.
        store: Where to store the new run: not the user's store, as the user did not request another run.
        options: Fields of `RunOptions` to change, such as `hold_at`.

    Raises:
        BackgroundError: the mat no longer exists.
        LogError: the run has no recording, or its options are invalid.
    """
    return start_run(
        restore_program(run.program, run.folder),
        run.first_spec,
        replace(_build_options(run), **options),
        store,
    )


def same(run: StoredRun, again: StoredRun) -> RunDiff:
    """Return the difference between a run and its re-run; its attribute `same` is True if all bits are equal.

    Args:
        run: The run. If it was cut off, only the part up to its last record is compared. If the user has stopped it at
            a position that is known, and the rest differs, only the part up to the stop is compared.
        again: Its re-run.
    """
    if not _has_obeyed_stop(run):
        return diff_runs(run, again, prefix=run.state in CUT_OFF)
    whole = diff_runs(run, again)
    # During cleanup, the progress of threads depends on the real clock, so only the part up to the stop is compared.
    return whole if whole.same else diff_runs(run, again, prefix=True, until=run.read_stop_tick())


def list_changed_files(run: StoredRun) -> tuple[str, ...]:
    """Return a note for each file that a run has read and that has changed since, as a re-run may then differ.

    Raises:
        LogError: the list of the files is damaged.
    """
    notes = []
    for read in FilesRead.read(run.folder).files:
        now = read.read_now()
        if now is not None and read.is_same(now):
            continue
        if not read.there:
            what = "was not there, and is there now"
        else:
            what = "has changed since" if now is not None and now.there else "is gone"
        notes.append(f"a file that the program opens {what}: {shortened(read.path, MAX_PATH)}")
    return tuple(notes)


def _has_obeyed_stop(run: StoredRun) -> bool:
    """Return whether the user stopped the program, and a re-run can stop it at the same position."""
    # The summary of a run that ignored the stop and had to be killed is longer than `stopped`.
    return run.end is not None and run.end.summary == "stopped" and run.read_stop_tick() is not None


def _build_options(run: StoredRun) -> RunOptions:
    last = run.telemetry.last()
    if last is None and not run.folder.is_dir():
        raise LogError(
            f"no run {str(run.number or run.id)!r}: it has been removed", file=str(run.folder)
        )
    if last is None:
        raise LogError(
            run.telemetry.note or "has no recording: it ended before its first tick",
            file=str(run.folder),
        )
    # A run that was stopped might never end by itself, so the re-run has a time limit. The stop comes right before
    # the tick after the last, so the limit is half a tick later than that tick, which allows for rounding.
    enough_s = (last.tick + 1.5) / run.spec.profile.tick_hz
    stored = run.options
    stop_tick = run.read_stop_tick()
    stop = () if stop_tick is None else (UserAction(stop_tick, Stop()),)
    try:
        limit_s = float(stored.get("time_limit_s", 0.0))
        return RunOptions(
            time_limit_s=min(limit_s, enough_s) if limit_s else enough_s,
            stall_limit_s=float(stored.get("stall_limit_s", 0.0)),
            answers=tuple(stored.get("answers", ())),
            asks_user=bool(stored.get("asks_user", False)),
            actions=run.actions + stop,
        )
    except (TypeError, ValueError) as error:
        raise LogError(f"cannot be run again: {error}", file=str(run.folder)) from error
