"""Files of recordings: written where the disk is full, and read row by row."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from tuisim.base.errors import LogError
from tuisim.engine.runs.records import (
    HEADER_BYTES,
    OUTPUT_FILE,
    OutputRow,
    OutputWriter,
    Stream,
    TelemetryWriter,
    is_hole,
    iterate_raw_rows,
    iterate_rows,
    pack_header,
    read_published_length,
)
from tuisim.engine.runs.views import TelemetryView


class _Full(Exception):
    pass


def _say_full(_: OSError) -> Exception:
    return _Full()


def test_on_a_nearly_full_disk_writers_reserve_less_and_lose_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = os.posix_fallocate
    free = 1_500_000

    def reserve(fd: int, start: int, size: int) -> None:
        if start + size > free:
            raise OSError(errno.ENOSPC, "full")
        real(fd, start, size)

    monkeypatch.setattr(os, "posix_fallocate", reserve)
    writer = TelemetryWriter(tmp_path)
    writer.full = _say_full
    while True:
        try:
            room = writer.reserve(1)
        except _Full:
            break
        at = 64 + 64 * writer.count
        room[at : at + 4] = writer.count.to_bytes(4, "little")
        writer.publish(writer.count + 1)
    writer.close()
    assert writer.count == (free - 64) // 64
    assert TelemetryView(tmp_path).array()["tick"].tolist() == list(range(writer.count))


def test_disk_space_is_reserved_also_without_posix_fallocate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(os, "posix_fallocate")
    writer = OutputWriter(tmp_path)
    found = (tmp_path / OUTPUT_FILE).stat()
    assert 512 * found.st_blocks >= found.st_size > 1 << 16
    writer.close()


def test_a_recordings_header_is_refused_if_short_or_of_another_kind() -> None:
    made = pack_header(b"TUISIMOU", 0, 12)
    assert len(made) == HEADER_BYTES
    assert read_published_length(made, b"TUISIMOU", "f") == 12
    for data, magic, said in (
        (made[:10], b"TUISIMOU", "too short"),
        (made, b"TUISIMTL", "not a tuisim recording"),
        (made[:8] + b"\xff\xff" + made[10:], b"TUISIMOU", "format version"),
    ):
        with pytest.raises(LogError, match=said):
            read_published_length(data, magic, "f")


def test_incomplete_rows_of_an_output_file_are_left_out(tmp_path: Path) -> None:
    writer = OutputWriter(tmp_path)
    for text, stream in (
        (b"one", Stream.STDOUT),
        (b"", Stream.STDERR),
        ("é\xff".encode("latin-1"), Stream.SPEECH),
    ):
        writer.write(text, 5, 50, 2, stream)
    writer.close()
    data = (tmp_path / OUTPUT_FILE).read_bytes()
    end = len(data) - HEADER_BYTES
    rows = [row for row, _ in iterate_rows(data, 0, end)]
    assert [(row.text, row.stream) for row in rows] == [
        ("one", Stream.STDOUT),
        ("", Stream.STDERR),
        ("\ufffd\ufffd", Stream.SPEECH),
    ]
    assert [row.text for row, _ in iterate_rows(data, 0, end - 1)] == ["one", ""]
    assert [text for _, text in iterate_raw_rows(data, end - 1)] == [b"one", b""]
    (_, after_first), *_ = iterate_rows(data, 0, end)
    assert [row.text for row, _ in iterate_rows(data, after_first, end)] == ["", "\ufffd\ufffd"]


@pytest.mark.parametrize(
    "text, stream, shown",
    [
        ("hi", Stream.SPEECH, "says: hi"),
        ("[beep]", Stream.SPEECH, "[beep]"),
        ("5", Stream.INPUT, "> 5"),
        ("x", Stream.STDOUT, "x"),
    ],
)
def test_speech_and_answers_to_input_are_marked_in_the_printed_output(
    text: str, stream: Stream, shown: str
) -> None:
    assert OutputRow(text, 0, 0, 0, stream).format_line() == shown


def test_a_block_of_zeros_counts_as_a_hole_in_a_recording() -> None:
    assert is_hole(bytes(10_000))
    assert not is_hole(b"\1" + bytes(10_000))
