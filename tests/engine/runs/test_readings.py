"""The record of what a program read: written reading by reading, and read as far as it is there."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from tuisim.base.errors import LogError
from tuisim.engine.runs import readings
from tuisim.engine.runs.readings import (
    READING_CODES,
    READING_MODES,
    READING_PORTS,
    READING_RECORD,
    ReadingsWriter,
    read_readings,
)
from tuisim.engine.runs.records import HEADER_BYTES, READINGS_FILE

TOUCH = READING_CODES["in1", "TOUCH"]
PLACE = READING_CODES["outD", "position"]


def test_each_recorded_reading_can_be_read_while_the_run_goes_on(tmp_path: Path) -> None:
    writer = ReadingsWriter(tmp_path)
    assert len(read_readings(tmp_path).rows) == 0
    expected = []
    for count, ((port, mode), code) in enumerate(READING_CODES.items()):
        writer.add(code, count * 1_000_003, count)
        expected.append(
            (count * 1_000_003, count, READING_PORTS.index(port), READING_MODES.index(mode))
        )
    read = read_readings(tmp_path)
    assert [row[:4] for row in read.rows.tolist()] == [row[:4] for row in expected]
    writer.close()
    path = tmp_path / READINGS_FILE
    assert path.stat().st_size == HEADER_BYTES + len(expected) * READING_RECORD.size
    assert (read_readings(tmp_path).rows == read.rows).all()
    assert set(read.find(("position",))["port"]) == set(range(len(READING_PORTS)))


def test_the_writer_knows_which_readings_it_has_at_the_newest_time(tmp_path: Path) -> None:
    writer = ReadingsWriter(tmp_path)
    assert not writer.has(TOUCH)
    writer.add(TOUCH, 5, 1)
    writer.add(PLACE, 5, 2)
    assert writer.has(TOUCH) and writer.has(PLACE)
    writer.add(PLACE, 6, 2)
    assert not writer.has(TOUCH)
    writer.close()


def test_a_flood_of_readings_is_counted_and_takes_no_more_space(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(readings, "MAX_READINGS", 5000)
    writer = ReadingsWriter(tmp_path)
    for time_ns in range(5007):
        writer.add(TOUCH, time_ns, 1)
    assert not writer.has(PLACE)
    writer.close()
    read = read_readings(tmp_path)
    assert (len(read.rows), read.left_out, read.rows["time_ns"][-1]) == (5000, 7, 4999)


def test_a_full_disk_is_told_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    writer = ReadingsWriter(tmp_path)

    def refuse(*_: int) -> None:
        raise OSError(errno.ENOSPC, "full")

    monkeypatch.setattr(os, "posix_fallocate", refuse)
    with pytest.raises(OSError, match="full"):
        for time_ns in range(2000):
            writer.add(TOUCH, time_ns, 1)
    writer.add(TOUCH, 3000, 1)
    writer.close()
    read = read_readings(tmp_path)
    assert (len(read.rows), read.left_out) == (1024, 1)


def _replace(path: Path, begin: int, data: bytes) -> None:
    whole = path.read_bytes()
    path.write_bytes(whole[:begin] + data + whole[begin + len(data) :])


@pytest.mark.parametrize(
    "begin, data, complaint",
    [
        (0, b"TUISIMTL", "not a tuisim recording"),
        (8, b"\x09", "format version 9"),
        (HEADER_BYTES, b"\xff" * 8, "the records are not readings"),
        (HEADER_BYTES + 12, bytes([len(READING_PORTS)]), "the records are not readings"),
        (HEADER_BYTES + 13, b"\x7f", "the records are not readings"),
        (HEADER_BYTES, b"\x09", "the records are not readings"),
    ],
)
def test_a_damaged_file_of_readings_is_refused(
    tmp_path: Path, begin: int, data: bytes, complaint: str
) -> None:
    writer = ReadingsWriter(tmp_path)
    writer.add(TOUCH, 1, 1)
    writer.add(TOUCH, 2, 1)
    writer.close()
    _replace(tmp_path / READINGS_FILE, begin, data)
    with pytest.raises(LogError, match=complaint):
        read_readings(tmp_path)


def test_a_truncated_file_of_readings_gives_those_that_are_left(tmp_path: Path) -> None:
    writer = ReadingsWriter(tmp_path)
    for time_ns in range(9):
        writer.add(TOUCH, time_ns, 1)
    writer.close()
    os.truncate(tmp_path / READINGS_FILE, HEADER_BYTES + 4 * READING_RECORD.size + 3)
    read = read_readings(tmp_path)
    assert (len(read.rows), read.left_out) == (4, 5)


def test_reading_a_run_without_recorded_readings_says_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="no record of what the program read"):
        read_readings(tmp_path)
    assert not len(read_readings(tmp_path, is_over=False).rows)
    (tmp_path / READINGS_FILE).mkdir()
    with pytest.raises(LogError, match="cannot be read"):
        read_readings(tmp_path)
