"""Readers of a run folder's two binary files, also while the run goes on.

A view never changes what it reads and never waits. A file that is not there yet reads as
empty; one that has grown is mapped again; one that has been packed is unpacked in memory,
once, when its content is wanted.
"""

from __future__ import annotations

import mmap
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from tuisim.core.drive import turn_rate_dps
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec, RunSpec
from tuisim.core.state import TICK_RECORD, Instant
from tuisim.datalog.compact import Packed, find_packed
from tuisim.datalog.records import (
    HEADER_BYTES,
    OUTPUT_CHUNK,
    OUTPUT_FILE,
    OUTPUT_MAGIC,
    TELEMETRY_CHUNK,
    TELEMETRY_FILE,
    TELEMETRY_MAGIC,
    TICK_FIELDS,
    OutputRow,
    output_rows,
    published_length,
)

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True, slots=True)
class TickRecord:
    """What the telemetry says of one tick; see `core.state.TICK_RECORD`."""

    tick: int
    line: int
    x_mm: float
    y_mm: float
    heading_deg: float
    left_position_deg: float
    right_position_deg: float
    left_speed_dps: float
    right_speed_dps: float
    gyro_zero_deg: float
    flags: int
    actions: int

    @property
    def pose(self) -> Pose:
        """Where the robot was."""
        return Pose(self.x_mm, self.y_mm, self.heading_deg)


def instant_of(record: TickRecord, spec: RunSpec, noise: NoiseSpec) -> Instant:
    """Return the moment of a record, ready for the functions of `core.sensors`.

    Args:
        record: What was recorded.
        spec: What the run was made of.
        noise: The noise at that tick; `runfile.noise_at` knows it.
    """
    return Instant(
        tick=record.tick,
        pose=record.pose,
        left_position_deg=record.left_position_deg,
        right_position_deg=record.right_position_deg,
        left_speed_dps=record.left_speed_dps,
        right_speed_dps=record.right_speed_dps,
        turn_rate_dps=turn_rate_dps(record.left_speed_dps, record.right_speed_dps, spec.robot),
        gyro_zero_deg=record.gyro_zero_deg,
        noise=noise,
        seed=spec.seed,
    )


class _Mapped:
    """A recording mapped for reading, and mapped again when it has outgrown the map; or unpacked, or read.

    Args:
        path: The file.
        magic: What it begins with.
        record_bytes: Of one record; 1 if they differ.
        first_bytes: What a file has at least after its header while it is written.
    """

    def __init__(self, path: Path, magic: bytes, record_bytes: int, first_bytes: int) -> None:
        self._first_bytes = first_bytes
        self._path = path
        self._magic = magic
        self._record_bytes = record_bytes
        self._map: mmap.mmap | bytes | None = None
        self.packed: Packed | None = None
        """The packed form, while nothing but its header has been read."""

    def look(self) -> tuple[mmap.mmap | bytes | None, int, int]:
        """Return the map (None while there is no file), the published length, and how much of it is there."""
        published, there = self.extent()
        if self.packed is not None:
            self._map, self.packed = self.packed.recording(), None
        return self._map, published, there

    def extent(self) -> tuple[int, int]:
        """Return the published length, and how much of it is there."""
        if self._map is None and self.packed is None:
            self._open()
        if self.packed is not None:
            return self.packed.length, self.packed.length
        if self._map is None:
            return 0, 0
        # A copy of the header is made in one piece; read in place, a number that is just being
        # written could be put together from the bytes of two.
        published = published_length(self._map[:HEADER_BYTES], self._magic, str(self._path))
        if published > self._room():
            self._open()
        return published, published if self.packed is not None else min(published, self._room())

    def _room(self) -> int:
        return 0 if self._map is None else (len(self._map) - HEADER_BYTES) // self._record_bytes

    def _open(self) -> None:
        try:
            with open(self._path, "rb") as handle:
                found = self._content(handle)
        except FileNotFoundError:
            # Looked for in this order, a recording that is being packed is always found.
            self.packed = find_packed(self._path)
            return
        except ValueError:  # created, but still empty
            return
        # The writer sizes a new file before it writes the header.
        if found[:HEADER_BYTES].strip(b"\0"):
            # The old map is not closed: arrays may still look at it, and it goes with the last of them.
            self._map = found

    def _content(self, handle: BinaryIO) -> mmap.mmap | bytes:
        size = os.fstat(handle.fileno()).st_size
        if 0 < size < HEADER_BYTES + self._first_bytes:
            # It is over, and small. A map would keep a file open, and of those a process may have few.
            return handle.read()
        return mmap.mmap(handle.fileno(), 0, access=mmap.ACCESS_READ)


class TelemetryView:
    """The tick records of a run.

    Args:
        folder: The run folder.

    Raises:
        LogError: by every method, if the file is no recording or of another version.
    """

    def __init__(self, folder: Path) -> None:
        self._file = _Mapped(folder / TELEMETRY_FILE, TELEMETRY_MAGIC, TICK_RECORD.size, TELEMETRY_CHUNK)

    @property
    def count(self) -> int:
        """How many whole records there are; record k is that of tick k."""
        return self._file.extent()[1]

    @property
    def note(self) -> str:
        """What is missing from a file that was cut off, or empty."""
        published, there = self._file.extent()
        lost = published - there
        return f"{TELEMETRY_FILE} was cut off: the last {lost} of {published} records are lost" if lost else ""

    def last(self) -> TickRecord | None:
        """Return the newest record, None if there is none yet."""
        count = self.count
        if not count:
            return None
        packed = self._file.packed
        # The packed form tells its last record without being unpacked.
        return self.record(count - 1) if packed is None else TickRecord(*TICK_RECORD.unpack(packed.last_record))

    def record(self, index: int) -> TickRecord:
        """Return one record.

        Raises:
            IndexError: there is no such record (yet).
        """
        data, _, count = self._file.look()
        if data is None or not 0 <= index < count:
            raise IndexError(f"no telemetry record {index}, there are {count}")
        return TickRecord(*TICK_RECORD.unpack_from(data, HEADER_BYTES + index * TICK_RECORD.size))

    def array(self) -> np.ndarray[Any, Any]:
        """Return all records as a structured array of `records.TICK_FIELDS`, shape (count,), read-only.

        It is a view of the file, not a copy; records written later need another call.
        """
        import numpy as np

        kind = np.dtype(list(TICK_FIELDS))
        data, _, count = self._file.look()
        if data is None or not count:
            return np.empty(0, kind)
        return np.frombuffer(data, kind, count, HEADER_BYTES)


class OutputView:
    """The rows that a run printed, spoke or was answered.

    Args:
        folder: The run folder.

    Raises:
        LogError: by every method, if the file is no recording or of another version.
    """

    def __init__(self, folder: Path) -> None:
        self._file = _Mapped(folder / OUTPUT_FILE, OUTPUT_MAGIC, 1, OUTPUT_CHUNK)
        self._seen = 0

    @property
    def length(self) -> int:
        """How many bytes of rows there are."""
        return self._file.extent()[1]

    @property
    def note(self) -> str:
        """What is missing from a file that was cut off, or empty."""
        published, there = self._file.extent()
        lost = published - there
        return f"{OUTPUT_FILE} was cut off: its last {lost} bytes are lost" if lost else ""

    def new_rows(self, limit: int | None = None) -> list[OutputRow]:
        """Return the rows since the last call, at most `limit`; the others come with the next call."""
        rows: list[OutputRow] = []
        data, _, end = self._file.look()
        if data is None or limit == 0:
            return rows
        for row, after in output_rows(data, self._seen, end):
            rows.append(row)
            self._seen = after
            if len(rows) == limit:
                break
        return rows

    def all_rows(self) -> list[OutputRow]:
        """Return every row so far; what `new_rows` returns next does not change."""
        return list(self.rows())

    def rows_from(self, position: int) -> Iterator[tuple[OutputRow, int]]:
        """Yield the rows from a position on, each with the position after it.

        Args:
            position: 0, or one that was yielded before.
        """
        data, _, end = self._file.look()
        if data is not None:
            yield from output_rows(data, position, end)

    def rows(self) -> Iterator[OutputRow]:
        """Yield what `all_rows` returns, one by one: a run may print a million lines."""
        data, _, end = self._file.look()
        if data is not None:
            for row, _ in output_rows(data, 0, end):
                yield row
