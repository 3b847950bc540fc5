"""Open the logs that are named on the command line."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from tuisim.analysis.source import LogRequest
from tuisim.commands.echo import echo_error, tell
from tuisim.config.command_line import Arguments
from tuisim.core.sensors import columns_of
from tuisim.core.spec import RobotSpec
from tuisim.errors import ConfigError, LogError, listed
from tuisim.logs.columns import choose_columns, time_in_words
from tuisim.logs.log import Log
from tuisim.logs.reader import STDIN, log_of_runs, read_pieces, telemetry_log
from tuisim.runs.run_folder import StoredRun
from tuisim.runs.store import RunStore


def is_file(word: str) -> bool:
    """Return whether a word names a file, not a stored run: the file exists, or the word has a suffix or is `-`."""
    path = Path(word)
    # `is_file` raises if the name is too long for the file system.
    with suppress(OSError):
        if os.path.isfile(path) or path.is_fifo():
            return True
    return word == STDIN or bool(path.suffix)


def asked(arguments: Arguments) -> LogRequest:
    """Return the file or the runs that the arguments name, with the columns to use.

    Raises:
        ConfigError: a file together with another log.
    """
    words = arguments.words or ["last"]
    files = [word for word in words if is_file(word)]
    if files and len(words) > 1:
        raise ConfigError("takes one file, or runs", f"got {' '.join(words)}", key="analyse")
    file, runs = (files[0], ()) if files else ("", tuple(words))
    return LogRequest(file, runs, arguments.telemetry, arguments.time, tuple(arguments.value), arguments.unit)


def open_sources(arguments: Arguments) -> Iterator[Log]:
    """Yield the named logs: each file by itself, consecutive runs as one log.

    Raises:
        ConfigError: no log is named.
        LogError: no such run or file, or it cannot be read.
    """
    words: Sequence[str] = arguments.words
    if not words:
        raise ConfigError("no log given", "a file, `-`, or a stored run such as `last`", key=arguments.action)
    runs: list[str] = []
    for word in words:
        if is_file(word):
            yield from _open_runs(runs, arguments)
            runs = []
            yield _open_file(word, arguments)
        else:
            runs.append(word)
    yield from _open_runs(runs, arguments)


def the_source(arguments: Arguments) -> Log:
    """Return the single named log.

    Raises:
        ConfigError: none or several are named.
        LogError: it cannot be read.
    """
    logs = list(open_sources(arguments))
    if len(logs) > 1:
        raise ConfigError("takes one file, or runs", f"got {len(logs)}", key=arguments.action)
    return logs[0]


def _open_runs(words: Sequence[str], arguments: Arguments) -> Iterator[Log]:
    if not words:
        return
    store = RunStore()
    runs = [store.load_run(word) for word in words]
    for log in _logs_of(runs, arguments):
        if not log.rows:
            damage = "; ".join(log.notes)
            if log.metadata.get("table") == "telemetry":
                raise LogError("no ticks: its recording is empty or truncated", damage, file=log.title)
            hint = "a program logs by printing lines such as `Colour: 50`; --telemetry uses every tick instead"
            raise LogError("no samples", damage or hint, file=log.title)
        layout = choose_columns(log.table, arguments.time, arguments.value, arguments.unit)
        yield _with_notes(log.with_layout(layout))


def _logs_of(runs: Sequence[StoredRun], arguments: Arguments) -> list[Log]:
    """Return the samples of some runs, or the telemetry of each, where that is asked for or has what is asked for."""
    asked_for: Sequence[str] = getattr(arguments, "variable", None) or ()
    if not arguments.telemetry:
        samples = log_of_runs(runs)
        known = {name.partition(" #")[0] for name in samples.names}
        columns = [{column.name for column in columns_of(run.spec.robot)} for run in runs]
        if not asked_for or known & set(asked_for) or not all(set(asked_for) <= names for names in columns):
            return [samples]
    return [telemetry_log(run, _derived(asked_for, run.spec.robot)) for run in runs]


def _derived(names: Iterable[str], robot: RobotSpec) -> list[str]:
    """Return those of some names that are columns which telemetry has only if it is asked for them."""
    return [column.name for column in columns_of(robot) if column.of is not None and column.name in names]


def _open_file(word: str, arguments: Arguments) -> Log:
    log = None
    for loaded in read_pieces(word, arguments.time, arguments.value, arguments.unit):
        log = loaded.log or log
        if loaded.part == loaded.part:
            tell(f"reading {word}", loaded.part, 1.0)
    tell(f"{arguments.action} {word}")
    assert log is not None
    # Exports of tuisim name their time column in the metadata.
    if arguments.time is None and not log.metadata:
        hint = "--time COLUMN selects another, --time '' uses row numbers"
        echo_error(f"note: {log.title}: {time_in_words(log.layout)} ({hint})")
    return _with_notes(log)


def _with_notes(log: Log) -> Log:
    for note in log.notes:
        echo_error(f"note: {log.title}: {note}")
    return log


def names_of(log: Log, arguments: Arguments) -> tuple[str, ...]:
    """Return the chosen variables, all by default; `A` also matches `A #1` and `A #2`.

    Raises:
        LogError: there is no such variable.
    """
    wanted: Sequence[str] = arguments.variable
    with_rows = [name for name in log.names if len(log.series(name).rows)]
    if not with_rows:
        hint = f"its columns are {listed(log.table.column_names)}"
        raise LogError("no numeric column", hint, file=log.title)
    if not wanted:
        return tuple(with_rows)
    found: list[str] = []
    for word in wanted:
        matching = [name for name in with_rows if name == word or name.partition(" #")[0] == word]
        if not matching:
            raise LogError(f"no variable {word!r}", f"there are {listed(with_rows)}", file=log.title)
        found += matching
    return tuple(dict.fromkeys(found))
