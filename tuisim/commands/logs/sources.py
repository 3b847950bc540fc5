"""Open the logs that are named on the command line."""

from __future__ import annotations

import os
from collections.abc import Container, Iterator, Sequence
from contextlib import suppress
from dataclasses import fields
from pathlib import Path

from tuisim.analysis.source import LogRequest
from tuisim.base.errors import ConfigError, LogError, among, listed
from tuisim.commands.echo import echo_error, tell
from tuisim.engine.core.columns import find_column_name
from tuisim.engine.core.sensors import list_column_names, list_columns
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.logs.choices import ReadChoices
from tuisim.logs.derived import add_named_columns
from tuisim.logs.expressions import find_names
from tuisim.logs.log import Log
from tuisim.logs.reader import STDIN, build_log, build_telemetry_log, read_pieces
from tuisim.logs.units import drop_run
from tuisim.settings.command_line import Arguments


def is_file(word: str) -> bool:
    """Return whether a word names a file, not a stored run: the file exists, or the word has a suffix or is `-`."""
    path = Path(word)
    # `is_fifo` raises if the name is too long for the file system.
    with suppress(OSError):
        if os.path.isfile(path) or path.is_fifo():
            return True
    return word == STDIN or bool(path.suffix)


def build_request(arguments: Arguments) -> LogRequest:
    """Return the file or the runs that the arguments name, with the columns to use.

    Raises:
        ConfigError: a file is named together with another log.
    """
    words = arguments.words or ["last"]
    files = [word for word in words if is_file(word)]
    if files and len(words) > 1:
        hint = f"got {' '.join(words)}; the key R of the analyser compares a file with runs"
        raise ConfigError("takes one file, or runs", hint, key="analyse")
    choices = build_choices(arguments)
    if files:
        return LogRequest.restore(files[0], choices)
    return LogRequest("", tuple(words), arguments.telemetry, choices)


def build_choices(arguments: Arguments) -> ReadChoices:
    """Return the choices in the arguments for reading a log, such as its time column."""
    names = (field.name for field in fields(ReadChoices))
    words = {name: getattr(arguments, name) for name in names}
    return ReadChoices(**{**words, "value": tuple(arguments.value)})


def open_sources(arguments: Arguments) -> Iterator[Log]:
    """Yield the logs that the arguments name: each file as a log, and consecutive runs together as one log.

    Raises:
        ConfigError: no log is named.
        LogError: a run or file does not exist, or cannot be read.
    """
    words: Sequence[str] = arguments.words
    if not words:
        raise ConfigError(
            "no log given", "a file, `-`, or a stored run such as `last`", key=arguments.action
        )
    runs: list[str] = []
    for word in words:
        if is_file(word):
            yield from _open_runs(runs, arguments)
            runs = []
            yield _open_file(word, arguments)
        else:
            runs.append(word)
    yield from _open_runs(runs, arguments)


def open_single(arguments: Arguments) -> Log:
    """Return the only log that the arguments name.

    Raises:
        ConfigError: no log is named, or several.
        LogError: the log cannot be read.
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
    for log in _read_runs(runs, arguments):
        if not log.rows:
            damage = "; ".join(log.notes)
            if log.metadata.get("table") == "telemetry":
                raise LogError(
                    "no ticks: its recording is empty or truncated", damage, file=log.title
                )
            hint = "a program logs by printing lines such as `Colour: 50`; --telemetry uses every tick instead"
            raise LogError("no samples", damage or hint, file=log.title)
        yield _prepare_log(log.choose(build_choices(arguments)), arguments)


def _read_runs(runs: Sequence[StoredRun], arguments: Arguments) -> list[Log]:
    """Return the samples of runs as one log, or the telemetry of each run.

    The telemetry is returned for `--telemetry`, and if all names in the arguments are columns of telemetry, not
    samples.
    """
    if arguments.telemetry:
        _name_columns(arguments, (), runs)
        return list(map(build_telemetry_log, runs))
    samples = build_log(runs)
    known = {drop_run(name) for name in samples.names}
    asked_for = _name_columns(arguments, known, runs)
    is_telemetry = bool(asked_for) and all(
        asked_for.isdisjoint(known) and asked_for.issubset(list_column_names(run.spec))
        for run in runs
    )
    return list(map(build_telemetry_log, runs)) if is_telemetry else [samples]


def _name_columns(
    arguments: Arguments, known: Container[str], runs: Sequence[StoredRun]
) -> set[str]:
    """Replace short names among the variables in the arguments by the full names of telemetry columns.

    Args:
        arguments: The arguments, which are changed.
        known: Names of samples: a variable with such a name is not replaced.
        runs: The runs that have the columns.

    Returns:
        The names of all columns that the arguments name.
    """
    run = runs[0].spec
    words: Sequence[str] = getattr(arguments, "variable", None) or ()
    arguments.variable = tuple(
        word if word in known else find_column_name(word, list_columns(run)) or word
        for word in words
    )
    expression = getattr(arguments, "expression", "")
    return {*arguments.variable, *(find_names(expression) if expression else ())}


def _open_file(word: str, arguments: Arguments) -> Log:
    log = None
    request = LogRequest.restore(word, build_choices(arguments))
    for loaded in read_pieces(word, request.choices):
        log = loaded.log or log
        if loaded.part == loaded.part:
            tell(f"reading {word}", loaded.part, 1.0)
    tell(f"{arguments.action} {word}")
    assert log is not None
    log = request.mark(log)
    # Exports of tuisim name their time column in the metadata.
    if arguments.time is None and not log.metadata:
        hint = "--time COLUMN selects another, --time '' uses row numbers"
        echo_error(f"note: {log.title}: {log.layout.describe_time()} ({hint})")
    return _prepare_log(log, arguments)


def _prepare_log(log: Log, arguments: Arguments) -> Log:
    """Print the notes on a log; return the log with the additional columns that the arguments name."""
    # A summary prints the notes itself, as its last lines.
    if arguments.action != "summary":
        for note in log.notes:
            echo_error(f"note: {log.title}: {note}")
    words = [getattr(arguments, name, "") for name in ("expression", "against")]
    return add_named_columns(log, " ".join((*words, *(getattr(arguments, "variable", None) or ()))))


def choose_names(log: Log, arguments: Arguments) -> tuple[str, ...]:
    """Return the variables that the arguments choose, all by default; `A` also chooses `A #1` and `A #2`.

    Raises:
        LogError: there is no such variable.
    """
    variables: Sequence[str] = arguments.variable
    with_rows = log.sampled_names
    if not with_rows:
        hint = f"its columns are {listed(log.table.column_names)}"
        raise LogError("no numeric column", hint, file=log.title)
    if not variables:
        return with_rows
    names: list[str] = []
    for word in variables:
        matching = [name for name in with_rows if name == word or drop_run(name) == word]
        if not matching:
            run = log.find_spec()
            columns = () if run is None else list_column_names(run)
            raise LogError(f"no variable {word!r}", among(word, with_rows, columns), file=log.title)
        names += matching
    return tuple(dict.fromkeys(names))
