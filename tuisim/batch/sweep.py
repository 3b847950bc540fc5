"""Runs a plan on the processes of this machine, or on a Dask cluster: the rows of its runs, as they finish.

The rows are collected in a file while a batch runs, so that an interrupted one can go on."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Self

from tuisim.base.atomic import replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, ExportError, TuisimError, counted
from tuisim.batch.plan import Plan
from tuisim.batch.table import (
    PROGRAM,
    RUN,
    RUN_ID,
    ColumnSummary,
    Row,
    build_frame,
    build_metadata,
    build_row,
    build_summaries,
    is_statistic,
    list_result_columns,
    list_usual_columns,
)
from tuisim.logs.export import export_frame
from tuisim.tasks.pool import run_many
from tuisim.tasks.task import Result, Task

if TYPE_CHECKING:
    import pandas as pd

SUFFIX = ".part"
MEASURED = "measured"
"""The key of what identifies metrics and columns of a batch."""


def find_partial(target: Path) -> Path:
    """Return the path of the file with the finished rows of a batch, in the folder of its table."""
    return target.with_name(target.name + SUFFIX)


class PartialTable:
    """A file with the finished rows of a batch: a line that identifies the batch, then one JSON line for each row.

    Args:
        path: The file.
        identity: What identifies the batch, see `Plan.build_identity`.
    """

    def __init__(self, path: Path, identity: Mapping[str, Any]) -> None:
        self._path, self._identity = path, dict(identity)
        self._file: BinaryIO | None = None

    def rows(self) -> dict[int, Row]:
        """Return the rows of an interrupted batch by the index of their task; empty if there is no file.

        The result is also empty if the file has other metrics, since the finished runs cannot be measured again.

        Raises:
            ConfigError: the file is of another batch, or cannot be read.
        """
        try:
            head, *lines = self._path.read_bytes().split(b"\n")
        except FileNotFoundError:
            return {}
        except OSError as error:
            raise ConfigError(f"cannot be read: {error.strerror}", file=str(self._path)) from None
        stored = _decode_line(head)
        unmeasured = {**self._identity, MEASURED: None}
        if not isinstance(stored, dict) or {**stored, MEASURED: None} != unmeasured:
            hint = "programs, parameters, goals or limits differ; to start again, remove it"
            raise ConfigError("is of another batch", hint, file=str(self._path))
        if stored != self._identity:
            return {}
        # The last line of a killed process may be incomplete.
        rows = [row for line in lines if isinstance(row := _decode_line(line), dict) and RUN in row]
        return _select_started(rows)

    def open(self, rows: Mapping[int, Row]) -> Self:
        """Create the file with some finished rows, and return this object; close it with `close` or `remove`.

        Raises:
            ExportError: the file cannot be written.
        """
        try:
            with replacing(self._path, durable=False) as handle:
                handle.writelines(_encode_row(row) for row in (self._identity, *rows.values()))
            self._file = self._path.open("ab")
        except OSError as error:
            raise ExportError(f"cannot write {self._path}: {error.strerror or error}") from error
        return self

    def add(self, row: Row) -> None:
        """Append a row of the batch to the file.

        Raises:
            ExportError: the row cannot be written.
        """
        assert self._file is not None
        try:
            self._file.write(_encode_row(row))
            self._file.flush()
        except OSError as error:
            raise ExportError(f"cannot write {self._path}: {error.strerror or error}") from error

    def close(self) -> None:
        """Close the file, and keep it for `--resume`."""
        if self._file is not None:
            # `add` has already reported errors of writing.
            with suppress(OSError):
                self._file.close()
            self._file = None

    def remove(self) -> None:
        """Close and remove the file of finished rows.

        Raises:
            ExportError: the file cannot be removed.
        """
        self.close()
        try:
            self._path.unlink(missing_ok=True)
        except OSError as error:
            raise ExportError(f"cannot remove {self._path}: {error.strerror or error}") from error


def has_batch(path: Path, identity: Mapping[str, Any]) -> bool:
    """Return whether a file is the table of the batch with this identity, from `Plan.build_identity`."""
    from tuisim.logs.reader import open_log

    try:
        return open_log(path).metadata.get("batch") == identity
    except TuisimError:
        return False


def read_rows(path: Path, identity: Mapping[str, Any], columns: Iterable[str]) -> dict[int, Row]:
    """Return the rows of a complete table by the index of their task; empty if the table belongs to another batch.

    Args:
        path: The file of the table.
        identity: What identifies the batch, from `Plan.build_identity`.
        columns: The columns to read, in addition to the columns of sample variables.
    """
    from tuisim.logs.frames import read_log

    try:
        frame = read_log(path) if has_batch(path, identity) else None
    except TuisimError:
        return {}
    if frame is None or len(frame) != identity["runs"]:
        return {}
    usual = {*columns, RUN_ID}
    usual_frame = frame[[name for name in frame.columns if name in usual or is_statistic(name)]]
    rows: list[Row] = [
        # Missing statistics of variables are left out of a row; a missing text is an empty one.
        {
            str(name): _read(str(name), value)
            for name, value in row.items()
            if value == value or name in usual
        }
        for row in usual_frame.to_dict("records")
    ]
    # Rows are numbered again, as a table of Python's `experiment` has the numbers of the run store instead.
    rows = [{**row, RUN: number} for number, row in enumerate(rows, start=1)]
    return _select_started(rows)


def _read(name: str, value: Any) -> Any:
    """Return a cell of a stored table with its original type; None for NaN.

    A whole number is stored as a float if other cells of its column are empty.

    Args:
        name: The name of the column.
        value: The stored value.
    """
    if value != value:
        return None
    return int(value) if name.endswith("_count") and isinstance(value, float) else value


def _select_started(rows: Iterable[Row]) -> dict[int, Row]:
    """Return rows by the index of their task; without runs that could not be started, so that they are tried again."""
    return {int(row[RUN]) - 1: row for row in rows if row.get("end")}


def _encode_row(row: Mapping[str, Any]) -> bytes:
    return json.dumps(row, ensure_ascii=True).encode() + b"\n"


def _decode_line(line: bytes) -> object:
    try:
        return json.loads(line)
    except (ValueError, RecursionError):
        return None


@dataclass(frozen=True, slots=True)
class Workers:
    """The processes that execute the tasks of a batch: on this machine, or on a cluster."""

    jobs: int = 0
    """Number of local worker processes; 0 is one for each processor."""
    scheduler: str = ""
    """Address of a Dask scheduler, such as `tcp://host:8786`; empty for none."""
    dask_workers: int = 0
    """Number of workers of a Dask cluster on this machine; 0 for none."""

    def run(self, tasks: Iterable[Task]) -> Generator[Result]:
        """Execute tasks, and yield their results as they finish; see `run_many` and `run_on_cluster`."""
        if not self.scheduler and not self.dask_workers:
            return run_many(tasks, self.jobs)
        # Imported on demand: Dask need not be installed.
        from tuisim.batch.cluster import run_on_cluster

        return run_on_cluster(tasks, self.scheduler, self.dask_workers)


def is_interrupted(out: Path) -> bool:
    """Return whether there are finished rows of an interrupted batch for a table.

    Args:
        out: The file of the table.
    """
    return os.path.exists(find_partial(out))


class Sweep:
    """The execution of a plan: the rows of the finished runs, and the table of these.

    Args:
        plan: The plan.
        expressions: Further columns of the table, by name.
        out: The file of the table; None for none.
        version: Version of tuisim: only the version that began a batch can resume it.
        resumes: Whether to resume an interrupted batch.

    Attributes:
        rows: The finished rows, by the index of the task.

    Raises:
        ConfigError: there is an interrupted batch that is not to be resumed, or its rows are of another batch.
        ExportError: the rows cannot be written.
    """

    def __init__(
        self,
        plan: Plan,
        expressions: Mapping[str, str],
        out: Path | None = None,
        version: str = "",
        *,
        resumes: bool = False,
        measured: Sequence[str] = (),
    ) -> None:
        self._plan = plan
        self._expressions = expressions
        self._out = out
        self.rows: dict[int, Row] = {}
        self._identity: dict[str, Any] = {}
        """What identifies the batch in its files; empty if none are written."""
        self._partial: PartialTable | None = None
        if out is not None:
            self._identity = plan.build_identity()
            if measured:
                self._identity[MEASURED] = [*measured]
            self._partial = self._open_partial(out, version, resumes)

    def _open_partial(self, out: Path, version: str, resumes: bool) -> PartialTable:
        path = find_partial(out)
        partial = PartialTable(path, {"version": version, **self._identity})
        if resumes:
            columns = list_usual_columns(self._plan.names, [goal.name for goal in self._plan.goals])
            self.rows = partial.rows() or read_rows(out, self._identity, columns)
        elif os.path.exists(path):
            hint = "--resume continues it; to start again, remove the file"
            raise ConfigError("holds the rows of an interrupted batch", hint, file=str(path))
        return partial.open(self.rows)

    def run(
        self,
        workers: Workers,
        on_row: Callable[[Row], None] = lambda _: None,
        measure: Callable[[Result], Row] = lambda _: {},
        due: Iterator[int] | None = None,
    ) -> None:
        """Execute the tasks that have no row yet, and block until all are done.

        An interrupt stops the running tasks and is raised again; finished rows are kept.

        Args:
            workers: The processes that execute the tasks.
            on_row: Called with each new row.
            measure: Returns further columns of a run by name.
            due: The indices of the tasks; None for all. If the iterator has stopped, its `next` is called again after
                further results.

        Raises:
            ConfigError, HostError: there is no such cluster, or the connection to it is lost.
            ExportError: the rows cannot be written.
            LogError: the folder for the recordings cannot be created.
        """
        plan = self._plan
        several = len(self._plan.subjects) > 1
        # The set is a copy, since `rows` grows while the tasks are iterated.
        every = plan.iterate_tasks(frozenset(self.rows))
        tasks = every if due is None else map(plan.task, due)
        try:
            # Closing the results stops the tasks that are running.
            with closing(workers.run(tasks)) as results:
                for result in results:
                    label = plan.find_subject(result.index).label if several else ""
                    row = build_row(result, label, plan.find_seed(result.index)) | measure(result)
                    self.rows[result.index] = row
                    if self._partial is not None:
                        self._partial.add(row)
                    on_row(row)
        except KeyboardInterrupt as error:
            if self._out is not None:
                done = f"{counted(len(self.rows), 'run')} done, in {find_partial(self._out)}"
                error.add_note(f"{done}; the same call goes on")
            raise
        finally:
            if self._partial is not None:
                self._partial.close()

    def build_frame(self, indices: Iterable[int] | None = None) -> pd.DataFrame:
        """Return the table of the finished runs, or of the finished runs with some indices.

        Raises:
            LogError: an expression is invalid, or names a column that does not exist.
        """
        rows = [self.rows[index] for index in (self.rows if indices is None else indices)]
        return build_frame(rows, self._expressions if rows else {})

    @property
    def replaces(self) -> bool:
        """Whether the table will replace an existing file that is not the table of this batch."""
        out = self._out
        return out is not None and os.path.exists(out) and not has_batch(out, self._identity)

    def export(self, frame: pd.DataFrame) -> None:
        """Write the table to the file `out`.

        Raises:
            ExportError: the file cannot be written.
        """
        if self._out is not None:
            export_frame(frame, self._out, build_metadata(frame, self._identity))

    def finish(self) -> None:
        """Remove the file with the rows, which only an interrupted batch needs.

        Raises:
            ExportError: the file cannot be removed.
        """
        if self._partial is not None:
            self._partial.remove()

    def summarize(self, frame: pd.DataFrame) -> list[ColumnSummary]:
        """Return statistics of the result columns for each combination of parameters.

        If there are too many combinations, the statistics are those of all runs together.
        """
        parameters = [*([PROGRAM] if PROGRAM in frame.columns else []), *self._plan.names]
        return build_summaries(frame, parameters, list_result_columns(frame, self._expressions))
