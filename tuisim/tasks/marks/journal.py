"""The journal of a marking: each outcome as soon as it is known, so that an interrupted marking can be resumed."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from pathlib import Path
from typing import IO, Self

import msgspec

from tuisim.base.atomic import make_private_folder, private
from tuisim.base.errors import LogError
from tuisim.base.folders import home_folder
from tuisim.tasks.marks.outcome import Outcome

FOLDER = "marks"
"""In the user's data folder."""


def build_journal_path(goals: Path) -> Path:
    """Return the path of the journal for a goals file: its name is a hash of the goals file's path."""
    key = hashlib.sha256(bytes(goals.resolve())).hexdigest()[:32]
    return home_folder() / FOLDER / f"{key}.jsonl"


class Journal:
    """The outcomes of a marking so far, in a file, so that an interrupted marking can be resumed.

    In a `with` block, the attribute `known` has the outcomes of finished runs, each by a key of its run, and `add`
    appends new ones.

    Args:
        path: The file.
        resumes: Whether to read the outcomes in an existing file; otherwise they are discarded.

    Raises:
        LogError: by `__enter__` and `add`, if the file cannot be read or written.
    """

    def __init__(self, path: Path, *, resumes: bool) -> None:
        self._path = path
        self._resumes = resumes
        self._file: IO[bytes] | None = None
        self.known: dict[str, Outcome] = {}

    def __enter__(self) -> Self:
        try:
            make_private_folder(self._path.parent)
            self.known = self._read() if self._resumes else {}
            self._file = open(self._path, "ab" if self._resumes else "wb", opener=private)
            if self._resumes and self._file.tell():
                # This ends a last line that an interrupted process may have left incomplete; empty lines are ignored.
                self._file.write(b"\n")
        except OSError as error:
            raise self._build_error(error) from error
        return self

    def __exit__(self, *_: object) -> None:
        if self._file is not None:
            self._file.close()

    def add(self, key: str, outcome: Outcome) -> None:
        """Append the outcome of a run to the file, and flush it."""
        assert self._file is not None
        line = json.dumps({"key": key, "outcome": asdict(outcome)}).encode() + b"\n"
        try:
            self._file.write(line)
            self._file.flush()
        except OSError as error:
            raise self._build_error(error) from error

    def _read(self) -> dict[str, Outcome]:
        """Return the outcomes in the file by key; incomplete lines of an interrupted process are left out."""
        outcomes = {}
        try:
            lines = self._path.read_bytes().split(b"\n")
        except FileNotFoundError:
            return {}
        for line in filter(None, lines):
            try:
                entry = json.loads(line)
                outcomes[str(entry["key"])] = msgspec.convert(entry["outcome"], Outcome)
            except (ValueError, TypeError, KeyError, RecursionError, msgspec.ValidationError):
                continue
        return outcomes

    def _build_error(self, error: OSError) -> LogError:
        return LogError(f"cannot be written: {error.strerror or error}", file=str(self._path))
