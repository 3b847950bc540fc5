"""The files that a run has read: as they are, as they were, and in a damaged list."""

from __future__ import annotations

import json
import os
from dataclasses import asdict
from pathlib import Path

import pytest

from tuisim.base.errors import LogError
from tuisim.engine.runs.side_files import (
    LOCK_FILE,
    MAX_READS,
    MAX_SUMMED_BYTES,
    READS_FILE,
    FileRead,
    FilesRead,
    is_held,
    note_read,
    note_reads_left_out,
    read_state,
)

MISSING = FileRead("a", there=False)


def test_read_state_gives_a_files_size_time_and_checksum(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"123456789")
    os.utime(path, ns=(5, 5))
    # The check value of CRC-32.
    assert read_state(str(path)) == FileRead(
        str(path), there=True, bytes=9, mtime_ns=5, crc32=0xCBF43926
    )


def test_pipes_in_place_of_lists_and_locks_do_not_block(tmp_path: Path) -> None:
    for name in (READS_FILE, LOCK_FILE):
        os.mkfifo(tmp_path / name)
    with pytest.raises(LogError, match="not a regular file"):
        FilesRead.read(tmp_path)
    assert is_held(tmp_path) is False


def test_the_checksum_of_a_large_file_is_not_computed(tmp_path: Path) -> None:
    with open(tmp_path / "a", "wb") as file:
        file.truncate(MAX_SUMMED_BYTES + 1)
    found = read_state(str(tmp_path / "a"))
    assert found is not None
    assert (found.bytes, found.crc32) == (MAX_SUMMED_BYTES + 1, -1)


@pytest.mark.parametrize(
    "path", ["/", os.devnull, "a\0b", "x" * 5000], ids=["folder", "device", "null", "long"]
)
def test_folders_and_devices_have_no_file_state(path: str) -> None:
    assert read_state(path) is None


def test_read_state_says_that_a_missing_file_is_not_there(tmp_path: Path) -> None:
    assert read_state(str(tmp_path / "a")) == FileRead(str(tmp_path / "a"), there=False)


@pytest.mark.parametrize(
    "one, other, same",
    [
        (MISSING, MISSING, True),
        (MISSING, FileRead("a", there=True), False),
        (FileRead("a", True, 3, 10, 7), FileRead("a", True, 3, 20, 7), True),
        (FileRead("a", True, 3, 10, 7), FileRead("a", True, 3, 10, 8), False),
        (FileRead("a", True, 3, 10, -1), FileRead("a", True, 3, 10, 8), True),
        (FileRead("a", True, 3, 10, -1), FileRead("a", True, 3, 20, -1), False),
    ],
)
def test_two_file_states_count_as_the_same_only_if_nothing_differs(
    one: FileRead, other: FileRead, same: bool
) -> None:
    assert (one.is_same(other), other.is_same(one)) == (same, same)


def test_noted_files_are_listed_once(tmp_path: Path) -> None:
    files = (FileRead("/tmp/b\udcff\x1b", True, 3, 10, 7), MISSING)
    for file in (*files, files[0]):
        note_read(tmp_path, file)
    note_reads_left_out(tmp_path, 12)
    with open(tmp_path / READS_FILE, "ab") as cut:
        cut.write(b'{"path": "/t')
    assert FilesRead.read(tmp_path) == FilesRead(files, 12)


def test_a_list_of_read_files_beyond_the_limit_is_cut_and_counted(tmp_path: Path) -> None:
    rows = (json.dumps(asdict(FileRead(str(n), there=False))) + "\n" for n in range(MAX_READS + 3))
    (tmp_path / READS_FILE).write_text("".join(rows))
    found = FilesRead.read(tmp_path)
    assert (len(found.files), found.left_out) == (MAX_READS, 3)


@pytest.mark.parametrize(
    "row", ["3", "[]", '{"path": "a"}', '{"left_out": null}', "\\", '{"left_out": 1e999}']
)
def test_a_damaged_list_of_read_files_is_refused_by_name(row: str, tmp_path: Path) -> None:
    (tmp_path / READS_FILE).write_text(f"{row}\n")
    with pytest.raises(LogError, match=READS_FILE):
        FilesRead.read(tmp_path)


def test_a_run_without_a_list_of_read_files_has_none(tmp_path: Path) -> None:
    assert FilesRead.read(tmp_path) == FilesRead()
