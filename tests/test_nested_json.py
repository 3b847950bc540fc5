"""JSON that is nested without end is damage like any other, although Python raises no `ValueError` for it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pyarrow as pa
import pytest

from tests.cases import cases
from tuisim.analysis.source import read_notes
from tuisim.app import kept_breaks
from tuisim.app.editor import text_file
from tuisim.base.errors import LogError
from tuisim.batch.sweep import _decode_line
from tuisim.engine.runs.side_files import (
    MODULES_FILE,
    READS_FILE,
    STOP_FILE,
    FilesRead,
    read_modules,
    read_stop_tick,
)
from tuisim.logs.arrow import METADATA_KEY, read_metadata
from tuisim.logs.export import find_companion
from tuisim.logs.reader import read_companion
from tuisim.settings.preferences import find_preferences_file, get_preference
from tuisim.tasks.marks.journal import Journal

DEEP = b"[" * 100_000 + b"\n"
PROGRAM = "drive.py"


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TUISIM_HOME", str(tmp_path / "home"))


def deep(file: Path) -> Path:
    """Fill a file; return it."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(DEEP)
    return file


def of_preferences(_folder: Path) -> object:
    deep(find_preferences_file())
    return get_preference("theme")


def of_draft(_folder: Path) -> object:
    deep(text_file.find_program_data(text_file.FOLDER, PROGRAM))
    return text_file.find_draft(PROGRAM)


def of_breakpoints(_folder: Path) -> object:
    deep(text_file.find_program_data(kept_breaks.FOLDER, PROGRAM))
    return kept_breaks.load_kept(PROGRAM)


def of_companion(folder: Path) -> object:
    deep(find_companion(folder / "a.csv"))
    return read_companion(folder / "a.csv")


def of_schema(_folder: Path) -> object:
    return read_metadata(pa.schema([], {METADATA_KEY: DEEP}))


def of_journal(folder: Path) -> object:
    with Journal(deep(folder / "marks.jsonl"), resumes=True) as journal:
        return journal.known


def of_batch(_folder: Path) -> object:
    return _decode_line(DEEP)


@pytest.mark.parametrize(
    "read, nothing",
    [
        (of_preferences, None),
        (of_draft, None),
        (of_breakpoints, kept_breaks.StoredBreaks()),
        (of_companion, {}),
        (of_schema, {}),
        (of_journal, {}),
        (of_batch, None),
    ],
)
def test_optional_files_of_deeply_nested_json_are_ignored(
    read: Callable[[Path], object], nothing: object, tmp_path: Path
) -> None:
    assert read(tmp_path) == nothing


@cases(
    "name, data, read",
    {
        "notes": ("notes.jsonl", DEEP, lambda folder: read_notes(folder / "notes.jsonl")),
        "modules": (MODULES_FILE, DEEP, read_modules),
        "reads": (READS_FILE, DEEP, FilesRead.read),
        "stop": (STOP_FILE, DEEP, read_stop_tick),
        "stop-at-infinity": (STOP_FILE, b'{"tick": 1e999}', read_stop_tick),
    },
)
def test_required_files_of_deeply_nested_json_raise_an_error_naming_the_file(
    name: str, data: bytes, read: Callable[[Path], object], tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(LogError, match=name):
        read(tmp_path)
