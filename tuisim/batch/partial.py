"""The file that collects the rows of a batch while it runs, so that an interrupted one can go on."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO, Self

from tuisim.base.atomic import replacing
from tuisim.base.errors import ConfigError, ExportError, TuisimError
from tuisim.batch.table import RUN, RUN_ID, Row, is_statistic

SUFFIX = ".part"


def find_partial(target: Path) -> Path:
    """Return the file for the finished rows of a batch, beside the table that it will become."""
    return target.with_name(target.name + SUFFIX)


class PartialTable:
    """A file with the finished rows of a batch: JSON lines after a line that identifies the batch.

    Args:
        path: The file.
        identity: What identifies the batch, see `Plan.build_identity`.
    """

    def __init__(self, path: Path, identity: Mapping[str, Any]) -> None:
        self._path, self._identity = path, dict(identity)
        self._file: BinaryIO | None = None

    def rows(self) -> dict[int, Row]:
        """Return the rows of an earlier batch by the index of their task; empty if there is no file.

        Raises:
            ConfigError: the file is of another batch, or cannot be read.
        """
        try:
            head, *lines = self._path.read_bytes().split(b"\n")
        except FileNotFoundError:
            return {}
        except OSError as error:
            raise ConfigError(f"cannot be read: {error.strerror}", file=str(self._path)) from None
        if _decode_line(head) != self._identity:
            hint = "it needs the same programs, parameters, goals, limits and columns; to start again, remove it"
            raise ConfigError("is of another batch", hint, file=str(self._path))
        # The last line of a killed process may be incomplete.
        rows = [row for line in lines if isinstance(row := _decode_line(line), dict) and RUN in row]
        return _select_started(rows)

    def open(self, rows: Mapping[int, Row]) -> Self:
        """Begin a file, with some finished rows; close it with `close` or `remove`.

        Raises:
            ExportError: it cannot be written.
        """
        try:
            with replacing(self._path, durable=False) as handle:
                handle.writelines(_encode_row(row) for row in (self._identity, *rows.values()))
            self._file = self._path.open("ab")
        except OSError as error:
            raise ExportError(f"cannot write {self._path}: {error.strerror or error}") from error
        return self

    def add(self, row: Row) -> None:
        """Append a row.

        Raises:
            ExportError: it cannot be written.
        """
        assert self._file is not None
        try:
            self._file.write(_encode_row(row))
            self._file.flush()
        except OSError as error:
            raise ExportError(f"cannot write {self._path}: {error.strerror or error}") from error

    def close(self) -> None:
        """Close the file, and leave it for `--resume`."""
        if self._file is not None:
            # Errors of writing have been reported by `add`.
            with suppress(OSError):
                self._file.close()
            self._file = None

    def remove(self) -> None:
        """Close and remove the file.

        Raises:
            ExportError: it cannot be removed.
        """
        self.close()
        try:
            self._path.unlink(missing_ok=True)
        except OSError as error:
            raise ExportError(f"cannot remove {self._path}: {error.strerror or error}") from error


def read_rows(path: Path, identity: Mapping[str, Any], columns: Iterable[str]) -> dict[int, Row]:
    """Return the rows of a complete table by the index of their task; empty if the table is not that of the batch.

    Args:
        identity: What identifies the batch.
        columns: The columns of rows besides those of sample variables; further columns of the table are left out.
    """
    from tuisim.logs.frames import read_log
    from tuisim.logs.reader import open_log

    try:
        metadata = open_log(path).metadata.get("batch")
        frame = read_log(path) if metadata == identity else None
    except TuisimError:
        return {}
    if frame is None or len(frame) != identity["runs"]:
        return {}
    usual = {*columns, RUN_ID}
    usual_frame = frame[[name for name in frame.columns if name in usual or is_statistic(name)]]
    rows: list[Row] = [
        # A run has no statistics of what it has not printed; of the other columns some texts are empty.
        {
            str(name): _read(str(name), value)
            for name, value in row.items()
            if value == value or name in usual
        }
        for row in usual_frame.to_dict("records")
    ]
    return _select_started(rows)


def _read(name: str, value: Any) -> Any:
    """Return a cell as it was written: a whole number is read as a float if its column has empty cells."""
    if value != value:
        return None
    return int(value) if name.endswith("_count") and isinstance(value, float) else value


def _select_started(rows: Iterable[Row]) -> dict[int, Row]:
    """Return rows by the index of their task, without runs that could not be started: these are tried again."""
    return {int(row[RUN]) - 1: row for row in rows if row.get("end")}


def _encode_row(row: Mapping[str, Any]) -> bytes:
    return json.dumps(row, ensure_ascii=True).encode() + b"\n"


def _decode_line(line: bytes) -> object:
    try:
        return json.loads(line)
    except (ValueError, RecursionError):
        return None
