"""`tuisim runs`: lists, shows, exports, compares and removes stored runs."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sys
from collections.abc import Sequence
from dataclasses import asdict
from datetime import UTC, datetime, timedelta
from pathlib import Path

from tuisim.base.errors import ConfigError, LogError, counted, shortened
from tuisim.commands.echo import (
    AS_JSON,
    Progress,
    draw_table,
    echo,
    echo_error,
    echo_json,
    echo_json_head,
    echo_lines,
    echo_written,
    size,
    tell,
)
from tuisim.commands.exit_status import describe, describe_last_state, has_shown_error
from tuisim.commands.movies import movie, picture
from tuisim.commands.rerun import MAX_PATH, list_changed_files, rerun, same
from tuisim.engine.core.drift import describe_errors
from tuisim.engine.protocol import Unended
from tuisim.engine.runs.catalogue import RunInfo
from tuisim.engine.runs.diff import RunDiff
from tuisim.engine.runs.frames import describe_damage
from tuisim.engine.runs.handle import RunHandle
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.engine.runs.run_folder import StoredRun, format_end
from tuisim.engine.runs.side_files import FilesRead
from tuisim.engine.runs.store import RunStore, count_bytes
from tuisim.engine.runs.temporary import create_temporary_home
from tuisim.logs.export import EXPORTERS, LISTED, check_targets, export_samples, export_telemetry
from tuisim.settings.command_line import Group, WordType, argument, command, option
from tuisim.settings.options import list_chosen_values, read_run_values

QUICK_BYTES = 8 << 20
"""Samples are not counted in outputs longer than this."""

_AGE = re.compile(r"(\d{1,6}(?:\.\d{1,6})?)([hdw])")
_HOURS = {"h": 1, "d": 24, "w": 168}

STREAMS = {
    Stream.STDOUT: "stdout",
    Stream.STDERR: "stderr",
    Stream.SPEECH: "speech",
    Stream.INPUT: "input",
}
MAX_SUMMARY = 40
"""Maximum characters of a summary in the list."""


_runs = argument("words", "RUN…", lambda: ("last",), nargs=-1)


def _load(store: RunStore, words: Sequence[str]) -> list[StoredRun]:
    return [store.load_run(word) for word in words]


def _require_words(words: Sequence[str], action: str) -> Sequence[str]:
    if not words:
        raise ConfigError("no run given", f"see `tuisim runs {action} --help`", key=action)
    return words


_ALL_COLUMNS = 110
"""In a narrower terminal the list of runs leaves out profile, seed, samples and size."""
_FEWER = (0, 1, 2, 3, 6, 7, 10, 11)


@command(AS_JSON, name="list")
def list_runs(as_json: bool) -> int:
    """List the stored runs and their sizes."""
    store = RunStore()
    runs = store.runs()
    if as_json:
        echo_json([{**asdict(run), "bytes": count_bytes(store.folder(run.id))} for run in runs])
    elif not runs:
        echo(f"no runs yet in {store.home}")
    else:
        rows: list[tuple[object, ...]] = [
            (
                run.number,
                run.created[:19].replace("T", " "),
                run.program,
                run.background,
                run.profile,
                run.seed,
                run.end,
                format_end(run.time_s or 0),
                "" if run.samples is None else str(run.samples),
                f"{size(count_bytes(store.folder(run.id))):>8}",
                _note(run),
                run.tags,
            )
            for run in runs
        ]
        heads: tuple[str, ...] = (
            "RUN",
            "UTC",
            "PROGRAM",
            "MAT",
            "PROFILE",
            "SEED",
            "END",
            "SECONDS",
            "SAMPLES",
            "    SIZE",
            "",
            "",
        )
        if sys.stdout.isatty() and shutil.get_terminal_size().columns < _ALL_COLUMNS:
            heads = tuple(heads[index] for index in _FEWER)
            rows = [tuple(row[index] for index in _FEWER) for row in rows]
            # In such a narrow table, the date is cut to month, day, hour and minute.
            rows = [(number, str(created)[5:16], *rest) for number, created, *rest in rows]
        echo_lines(draw_table(heads, rows))
    return 0


def _note(run: RunInfo) -> str:
    """Return the summary of a run; empty if it only repeats the end, which has its own column."""
    return "" if run.summary == run.end else _cut(run.summary)


def _cut(text: str) -> str:
    return text if len(text) <= MAX_SUMMARY else text[: MAX_SUMMARY - 1] + "…"


@command(_runs, AS_JSON)
def show(words: Sequence[str], as_json: bool) -> int:
    """Show how a run ended, what it printed and when."""
    for run in _load(RunStore(), _require_words(words, "show")):
        _show(run, as_json=as_json)
    return 0


def _convert_plain(row: OutputRow) -> dict[str, object]:
    return {
        "time_s": row.time_ns / 1e9,
        "line": row.line,
        "stream": STREAMS[row.stream],
        "text": row.text,
    }


def _list_files_read(run: StoredRun) -> tuple[FilesRead, tuple[str, ...]]:
    """Return which files the program of a run has read, and notes on them.

    If the list is damaged, there are no files and a note.
    """
    try:
        return FilesRead.read(run.folder), ()
    except LogError as error:
        return FilesRead(), (str(error),)


def _show(run: StoredRun, *, as_json: bool) -> None:
    """Print a run; rows are printed while they are read, as there may be millions."""
    rows = (row for row in run.output.rows() if row.stream in STREAMS)
    if as_json:
        # `describe` reads all rows to count them, so the rows are printed first and the counts after them.
        read, _ = _list_files_read(run)
        files = {
            "files_read": [asdict(file) for file in read.files],
            "files_left_out": read.left_out,
        }
        echo_json_head(
            "output",
            map(_convert_plain, rows),
            describe(run) | {"values": read_run_values(run.spec)} | files,
        )
        return
    facts = describe(run, QUICK_BYTES)
    echo(
        f"{facts['id']} · {facts['created']} · {facts['background']} · {facts['robot']} · {facts['profile']} · "
        f"seed {facts['seed']}"
    )
    echo(describe_last_state(facts))
    if chosen := list_chosen_values(run.spec):
        echo(f"values: {', '.join(chosen)}")
    if not run.spec.world.drift.is_none:
        echo(f"drawn: {describe_errors(run.spec)}")
    if facts["arguments"]:
        echo(f"arguments: {shlex.join(facts['arguments'])}")
    read, damage = _list_files_read(run)
    for note in (*facts["notes"], *damage):
        echo(f"note: {note}")
    for file in read.files:
        what = (
            f"read ({counted(file.bytes, 'byte')})" if file.there else "looked for, and not there"
        )
        echo(f"file {what}: {shortened(file.path, MAX_PATH)}")
    if read.left_out:
        echo(f"and {counted(read.left_out, 'more file')}")
    for row in rows:
        echo(
            f"{row.time_ns / 1e9:10.3f} s  {'! ' if row.stream == Stream.STDERR else ''}{row.format_line()}"
        )
    if facts["error"] and not has_shown_error(run):
        echo_lines(facts["error"].rstrip("\n"))


@command(
    _runs,
    option(
        "--older-than", metavar="AGE", help="Remove finished runs older than this: 12h, 30d, 8w."
    ),
)
def rm(words: Sequence[str], older_than: str | None) -> int:
    """Remove runs."""
    store = RunStore()
    freed = 0
    with Progress("rm"):
        # All runs are looked up before the first one is removed; a run may be named twice.
        if older_than is None:
            run_ids = [store.find(word).id for word in _require_words(words, "rm")]
        else:
            run_ids = _find_older(store, words, older_than)
        for number, run_id in enumerate(dict.fromkeys(run_ids)):
            tell("removing runs", number, len(run_ids))
            folder = store.folder(run_id)
            target = os.path.realpath(folder) if folder.is_symlink() else ""
            freed += 0 if target else count_bytes(folder)
            store.remove(run_id)
            if target:
                echo_error(f"note: run {run_id} was a link; its target was not removed: {target}")
    if older_than is not None:
        echo(f"{counted(len(run_ids), 'run')} removed, {size(freed)}")
    return 0


def _find_older(store: RunStore, words: Sequence[str], age: str) -> list[str]:
    """Return the ids of the finished runs that are older than an age.

    Args:
        store: The store with the runs.
        words: The runs that the user has named; there must be none.
        age: The age, such as `30d`.

    Raises:
        ConfigError: the age cannot be read, or runs are named, too.
    """
    if words:
        raise ConfigError("takes no run", f"got {' '.join(words)}", key="--older-than")
    match = _AGE.fullmatch(age)
    if match is None:
        raise ConfigError(
            f"cannot be read: {age!r}",
            "hours, days or weeks, such as 12h, 30d or 8w",
            key="--older-than",
        )
    before = datetime.now(UTC) - timedelta(hours=float(match[1]) * _HOURS[match[2]])
    return [
        run.id
        for run in store.runs()
        if run.end is not Unended.RUNNING and _is_older(run.created, before)
    ]


def _is_older(created: str, moment: datetime) -> bool:
    try:
        return datetime.fromisoformat(created) < moment
    except (ValueError, TypeError):
        # A damaged run may have no date: it is not removed by its age.
        return False


@command(_runs, AS_JSON, name="rerun")
def rerun_runs(words: Sequence[str], as_json: bool) -> int:
    """Run stored runs again, and compare them with their recordings.

    Exit code: 0 if all are bit-identical, else 1.
    """
    with Progress("rerun"):
        return max(
            _rerun(run, as_json=as_json)
            for run in _load(RunStore(), _require_words(words, "rerun"))
        )


def _rerun(run: StoredRun, *, as_json: bool) -> int:
    """Run a stored run again and print whether the result is the same; return the exit code."""
    notes = list_changed_files(run)
    for note in notes:
        echo_error(f"note: {note}")
    with create_temporary_home() as home:
        scratch = RunStore(home)
        handle = rerun(run, scratch)
        what = f"rerunning run {run.number}: {run.program.name}"
        ticks = run.telemetry.count
        tell(what, 0, ticks)
        try:
            while handle.wait(RunHandle.ASK_AGAIN_S) is None:
                tell(what, handle.telemetry.count, ticks)
        finally:
            handle.close()
        tell(f"comparing run {run.number}")
        comparison = same(run, scratch.load_run(handle.run_id))
    if as_json:
        echo_json({"run": run.number, **comparison.to_plain(), "notes": list(notes)})
    else:
        echo_lines(format_diff(comparison))
    return 0 if comparison.same else 1


def format_diff(comparison: RunDiff) -> str:
    """Return the difference between two runs as readable text."""
    recording = comparison.describe_recording()
    setup = comparison.describe_setup()
    pairs = (*recording, *setup) if comparison.same else (*setup, *recording)
    lines = [f"{label}: {words}" if label else words for label, words in pairs]
    if comparison.divergence and not comparison.same:
        rows = [
            [f"{time_s:.2f}", f"{mm:.3f}", f"{deg:.3f}"]
            for time_s, mm, deg in comparison.divergence.table
        ]
        lines.append(draw_table(("SECONDS", "APART MM", "HEADING °"), rows))
    return "\n".join(lines)


@command(
    _runs,
    option(
        "--out",
        "files",
        multiple=True,
        metavar="FILE",
        type=WordType(),
        help="Export the samples; may be repeated.",
    ),
    option(
        "--telemetry",
        metavar="FILE",
        type=WordType(),
        help="Export the telemetry of a single run, one row per tick.",
    ),
    help=f"Export samples of runs, or the telemetry of one run.\n\nA FILE ends in {LISTED}.",
)
def export(words: Sequence[str], files: Sequence[str], telemetry: str | None) -> int:
    """Export samples or telemetry of runs."""
    for word in words:
        if Path(word).suffix.lower() in EXPORTERS:
            hint = f"to write this file, use --out {word}"
            raise ConfigError(f"{word} is a file, not a run", hint, key="export")
    if not words or not (files or telemetry is not None):
        hint = f"tuisim runs export RUN… --out FILE, FILE ends in {', '.join(EXPORTERS)}"
        raise ConfigError("needs a run and a file", hint, key="export")
    if telemetry is not None and len(words) > 1:
        raise ConfigError("takes one run", f"got {len(words)}", key="--telemetry")
    check_targets(target for target in (*files, telemetry) if target is not None)
    with Progress("export"):
        runs = _load(RunStore(), words)
        for note in (note for run in runs for note in run.notes):
            echo_error(f"note: {note}")
        for file in files:
            tell(f"writing {file}")
            export_samples(runs, file)
            echo_written(file)
        if telemetry is not None:
            tell(f"writing {telemetry}")
            if note := describe_damage(runs[0]):
                echo_error(f"note: {note}")
            export_telemetry(runs[0], telemetry)
            echo_written(telemetry)
    return 0


runs = Group.of(
    "runs",
    (list_runs, show, export, movie, picture, rerun_runs, rm),
    default="list",
    instead={
        **dict.fromkeys(("delete", "remove"), "did you mean `tuisim runs rm`?"),
        "report": "`tuisim log report RUN` writes it",
        "compact": "recordings are plain files; `tuisim runs rm` removes those you do not need",
    },
    help="""List, show, export, draw or remove stored runs.

    A RUN is given by its number, its id or the start of its id, its folder's path, or `last`.
    """,
)
