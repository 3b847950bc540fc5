"""Opens logs: files, which are read piece by piece so that their beginning can be shown early, and stored runs."""

from __future__ import annotations

import json
import os
import stat
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path
from time import monotonic
from typing import Any, cast

import pyarrow as pa
import pyarrow.compute as pc

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, counted, listed
from tuisim.base.regular_file import read_regular
from tuisim.engine.runs.frames import build_telemetry_columns, describe_damage, sample_columns
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.logs import arrow
from tuisim.logs.blocks import (
    BLOCK_BYTES,
    MAGIC_BYTES,
    MAGICS,
    MAX_DOCUMENT_BYTES,
    MAX_LINE_BYTES,
    Block,
    LineCutter,
    Readable,
    unpack,
)
from tuisim.logs.choices import NO_CHOICES, ReadChoices
from tuisim.logs.columns import (
    UNIT_NAMES,
    Layout,
    choose_columns,
    describe_guessed_times,
    find_unread_time,
    is_text,
)
from tuisim.logs.export import find_companion, log_metadata
from tuisim.logs.json_rows import (
    DocumentReader,
    ObjectReader,
    build_json_reader,
    has_objects,
    is_json_start,
)
from tuisim.logs.log import Log, LogCache
from tuisim.logs.program_lines import (
    choose_reader,
    has_tuples,
    strip_brackets,
)
from tuisim.logs.text_tables import CsvReader
from tuisim.logs.time_order import (
    guess_unit_s,
    join_times,
    keep_timed_rows,
    number_runs,
    reverse_newest_first,
)
from tuisim.logs.units import TIMEDELTA
from tuisim.logs.warnings import Notes

STDIN = "-"
FIRST_BYTES = 1 << 18
"""Bytes that are read and shown first."""
_SHOW_EVERY_S = 1.0
_SHOW_SELDOM = 5.0
"""Minimum time between two updates, as a multiple of the duration of an update."""
_MAX_COMPANION_BYTES = 64 << 20
_SHOWN_LINES = 100
"""Lines from which the user chooses the heading."""
_TABLES = (".csv", ".tsv")
_JUDGED_LINES = 30
"""Lines from which the kind of a text is found."""


@dataclass(frozen=True, slots=True)
class Loaded:
    """A log while it is being read: the fraction that has been read, and the log so far."""

    part: float
    """Fraction of the file that has been read, 0 to 1; NaN if the size is unknown."""
    log: Log | None
    """The log so far, not each time; always at the end."""
    done: bool = False


def open_log(source: str | Path, choices: ReadChoices = NO_CHOICES) -> Log:
    """Return the whole log in a file.

    Args:
        source: Path of a CSV, Parquet, JSONL, Arrow or text file; `-` is the standard input.
        choices: The user's choices for reading the file.

    Raises:
        LogError: the file cannot be read, has no row, or lacks a chosen column.
    """
    last = None
    for loaded in read_pieces(source, choices):
        last = loaded.log or last
    assert last is not None
    return last


def read_beginning(path: str, choices: ReadChoices) -> Log:
    """Return the log in the first rows of a file.

    Raises:
        LogError: the file cannot be read, or has no row.
    """
    return next(loaded.log for loaded in read_pieces(path, choices) if loaded.log is not None)


def read_pieces(source: str | Path, choices: ReadChoices = NO_CHOICES) -> Iterator[Loaded]:
    """Read a log step by step.

    Yield the log so far, soon after the start and then repeatedly. The arguments are those of `open_log`.
    """
    title = _name_source(source)
    notes = Notes()
    parts: list[pa.Table] = []
    show_at = 0.0
    for part, table in read_parts(source, notes, choices):
        if table is not None:
            parts.append(table)
        now = monotonic()
        if not parts or now < show_at:
            yield Loaded(part, None)
            continue
        yield Loaded(part, _build_log(title, parts, notes, choices))
        # Building the log so far must take only a fraction of the whole time, hence the pause.
        took = monotonic() - now
        show_at = now + took + max(_SHOW_EVERY_S, _SHOW_SELDOM * took)
    if not sum(part.num_rows for part in parts):
        warnings = "; ".join(notes.texts())
        raise LogError(
            "no rows" + (f": {warnings}" if warnings else ""),
            "a log has a header and one row per sample",
            file=title,
        )
    log = _build_log(title, parts, notes, choices)
    yield Loaded(1.0, log, done=True)


def _build_log(title: str, parts: Sequence[pa.Table], notes: Notes, choices: ReadChoices) -> Log:
    table = join_times(_fill_types(join_tables(parts)))
    try:
        layout = choose_columns(table, choices)
    except LogError as error:
        raise LogError(str(error), file=title) from error
    if layout.since_first:
        unit = UNIT_NAMES[layout.unit_s]
        notes.say(
            f"the times in {layout.time!r} are {unit} since 1970: here they count from 0 at the first row"
        )
    unread = find_unread_time(table, layout) if choices.time is None else ""
    if unread:
        notes.say(f"the times in {unread!r} cannot be read: row numbers are used")
    if guess := describe_guessed_times(table, layout):
        notes.say(guess)
    metadata = arrow.read_metadata(parts[0].schema) or read_companion(Path(title))
    # These notes are about the rows so far, so they are collected again each time.
    later = Notes()
    if not (metadata or choices.unit) and (unit_s := guess_unit_s(table, layout)) is not None:
        layout = replace(layout, unit_s=unit_s)
        later.say(
            f"the times in {layout.time!r} are whole numbers in large steps: read as"
            f" {UNIT_NAMES[unit_s]} (--unit selects another)"
        )
    table, layout, times = keep_timed_rows(table, layout, later)
    if not metadata:
        if times is not None:
            table, times = reverse_newest_first(table, layout, times, later)
            table, layout = number_runs(table, layout, times, later)
        _tell_odd_columns(table, layout, unread, later)
    return Log(
        title,
        table,
        layout,
        (*notes.texts(), *later.texts()),
        notes.left_out,
        metadata,
        notes.form,
        notes.first_lines,
        _cache=LogCache(times_s=None if times is None else times.seconds),
    )


def _tell_odd_columns(table: pa.Table, layout: Layout, unread: str, notes: Notes) -> None:
    """Add notes on columns that are text, and on infinite values.

    Args:
        table: The table.
        layout: The roles of its columns.
        unread: The column with the name of a time that could not be read; empty for none.
        notes: Receives the notes.
    """
    used = (layout.time, layout.variable, layout.run, unread, *TIMEDELTA)
    texts = [
        repr(field.name) for field in table.schema if is_text(field.type) and field.name not in used
    ]
    if texts:
        notes.say(f"text, not numbers: {listed(texts)}")
    for name in layout.values:
        column = table.column(name)
        if pa.types.is_floating(column.type):
            count = pc.sum(pc.is_inf(column)).as_py() or 0
            if count:
                notes.say(
                    f"{counted(count, f'value of {name!r} is', f'values of {name!r} are')} infinite"
                )


def read_companion(path: Path) -> Mapping[str, Any]:
    """Return the metadata in the companion file of an export, by key; empty if there is no such file."""
    try:
        metadata = json.loads(
            read_regular(find_companion(path), _MAX_COMPANION_BYTES, follow_links=True)
        )
    except (OSError, ValueError, RecursionError):
        return {}
    return metadata if isinstance(metadata, dict) else {}


def join_tables(parts: Sequence[pa.Table]) -> pa.Table:
    """Return the rows of several tables as one; a column that a table lacks is empty in its rows."""
    return pa.concat_tables(parts, promote_options="permissive").unify_dictionaries()


def _fill_types(table: pa.Table) -> pa.Table:
    """Return a table in which columns without any cell have a numeric type."""
    kinds = [
        field.with_type(pa.float64()) if field.type == pa.null() else field
        for field in table.schema
    ]
    return table.cast(pa.schema(kinds, table.schema.metadata))


def read_parts(
    source: str | Path, notes: Notes, choices: ReadChoices = NO_CHOICES
) -> Iterator[tuple[float, pa.Table | None]]:
    """Read a log file in parts: yield the fraction that has been read, and the new rows, or None if there are none.

    Args:
        source: Path of the file; `-` is the standard input.
        notes: Receives warnings.
        choices: The user's choices for reading the file.

    Raises:
        LogError: the file cannot be read.
    """
    title = _name_source(source)
    try:
        if str(source) != STDIN:
            yield from _read_file(Path(source), notes, choices)
        # The standard input is None if the shell closed it.
        elif cast("Any", sys.stdin) is None:
            raise LogError("is closed", "give a file instead of -")
        else:
            yield from _read_text_parts(sys.stdin.buffer, 0, "", notes, choices)
    except LogError as error:
        raise LogError(error.message, error.hint, file=title) from error
    except FileNotFoundError as error:
        raise LogError("no such file", file=title) from error
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=title) from error


def _name_source(source: str | Path) -> str:
    return "standard input" if str(source) == STDIN else str(source)


def _read_file(
    path: Path, notes: Notes, choices: ReadChoices
) -> Iterator[tuple[float, pa.Table | None]]:
    if os.path.isdir(path):
        raise LogError("is a folder, not a log")
    mode = path.stat().st_mode
    if stat.S_ISCHR(mode) or stat.S_ISBLK(mode):
        # A device is refused, as it may have no end.
        raise LogError("is a device, not a log")
    regular = stat.S_ISREG(mode)
    with path.open("rb", buffering=0 if not regular else -1) as handle:
        head = handle.read(MAGIC_BYTES) if regular else b""
        for magic, parts in arrow.FORMATS.items():
            if head.startswith(magic):
                yield from parts(path, notes)
                return
        if regular:
            handle.seek(0)
        if (inner := unpack(head, handle, notes)) is not None:
            yield from _read_text_parts(
                inner, 0, path.with_suffix("").suffix.lower(), notes, choices
            )
        else:
            size = path.stat().st_size if regular else 0
            yield from _read_text_parts(handle, size, path.suffix.lower(), notes, choices)


def _read_text_parts(
    handle: Readable, size: int, suffix: str, notes: Notes, choices: ReadChoices
) -> Iterator[tuple[float, pa.Table | None]]:
    """Read a text in parts: yield the fraction that has been read, and the new rows, or None if there are none.

    Args:
        handle: The stream of its bytes.
        size: The number of bytes; 0 if unknown.
        suffix: Suffix of the file name in lower case, such as `.csv`.
        notes: Receives warnings.
        choices: The user's choices for reading the file.
    """
    data = handle.read(FIRST_BYTES) or b""
    _refuse_binary(data)
    is_json = data.lstrip().startswith((b"{", b"["))
    longest = MAX_DOCUMENT_BYTES if is_json else MAX_LINE_BYTES
    cutter = LineCutter(notes, longest, choices.encoding)
    reader = None
    read = len(data)
    while True:
        block = cutter.feed(data)
        part = min(1.0, read / size) if size else float("nan")
        if block is not None:
            reader = reader or _choose_reader(block, suffix, choices, notes)
            yield part, reader.read(block)
        elif data:
            yield part, None
        if not data:
            if isinstance(reader, DocumentReader | CsvReader):
                yield part, reader.finish()
            return
        data = handle.read(BLOCK_BYTES) or b""
        read += len(data)


def _refuse_binary(data: bytes) -> None:
    """Check that the first bytes of a stream do not belong to a binary format.

    Raises:
        LogError: the bytes are the beginning of a binary format.
    """
    if data.startswith((*arrow.FORMATS, *MAGICS)):
        raise LogError(
            "only text can be read from a pipe or inside a compressed file",
            "for another format, give the name of the uncompressed file",
        )


def _choose_reader(
    block: Block, suffix: str, choices: ReadChoices, notes: Notes
) -> CsvReader | ObjectReader | DocumentReader:
    notes.first_lines = list(islice(block.lines(), _SHOWN_LINES))
    lines = [line for _, line in notes.first_lines[:_JUDGED_LINES]]
    is_table = suffix in _TABLES or choices.header > 0 or choices.separator != ""
    if has_tuples(lines):
        return CsvReader(notes, choices, strip_brackets)
    if not is_table and has_objects(lines):
        return build_json_reader(notes)
    if suffix in (".jsonl", ".ndjson", ".json") or (not is_table and is_json_start(lines)):
        return DocumentReader(notes, choices)
    return choose_reader(lines, is_table, notes, choices) or CsvReader(notes, choices)


def build_log(runs: Sequence[StoredRun]) -> Log:
    """Return the samples of one or more runs as a log, which is empty if the runs have no samples.

    Raises:
        LogError: a recording is damaged.
    """
    return _build_log_from_columns("samples", runs, sample_columns(runs))


def build_telemetry_log(run: StoredRun) -> Log:
    """Return the telemetry of a run as a log.

    Raises:
        LogError: the recording is damaged, or the mat no longer exists.
    """
    return _build_log_from_columns("telemetry", [run], build_telemetry_columns(run))


def _build_log_from_columns(
    kind: str, runs: Sequence[StoredRun], columns: Mapping[str, Any]
) -> Log:
    table = arrow.build_table(columns)
    title = ", ".join(f"run {run.number or run.id}: {run.program.name}" for run in runs)
    notes = [note for run in runs for note in run.notes]
    if kind == "telemetry":
        notes += filter(None, map(describe_damage, runs))
    return Log(
        title,
        table,
        choose_columns(table),
        tuple(notes),
        metadata=log_metadata(kind, columns, runs),
        _cache=LogCache(specs={index: run.spec for index, run in enumerate(runs)}),
    )
