"""Writers of recordings, where the disk is full or cannot reserve."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from tuisim.runs.records import OUTPUT_FILE, OutputWriter, TelemetryWriter
from tuisim.runs.views import TelemetryView


class _Full(Exception):
    pass


def _say_full(_: OSError) -> Exception:
    return _Full()


def test_writers_ask_for_less_and_lose_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real, free = os.posix_fallocate, 1_500_000

    def reserve(fd: int, start: int, size: int) -> None:
        if start + size > free:
            raise OSError(errno.ENOSPC, "full")
        real(fd, start, size)

    monkeypatch.setattr(os, "posix_fallocate", reserve)
    writer = TelemetryWriter(tmp_path)
    writer.full = _say_full
    while True:
        try:
            room = writer.room(1)
        except _Full:
            break
        at = 64 + 64 * writer.count
        room[at : at + 4] = writer.count.to_bytes(4, "little")
        writer.publish(writer.count + 1)
    writer.close()
    assert writer.count == (free - 64) // 64
    assert TelemetryView(tmp_path).array()["tick"].tolist() == list(range(writer.count))


def test_room_is_reserved_where_there_is_no_call_for_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "posix_fallocate")
    writer = OutputWriter(tmp_path)
    found = (tmp_path / OUTPUT_FILE).stat()
    assert 512 * found.st_blocks >= found.st_size > 1 << 16
    writer.close()
