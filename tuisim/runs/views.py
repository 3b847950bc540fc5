"""Readers of a run folder's two binary files, also while the run goes on.

A view never changes what it reads and never waits. A file that is not there yet reads as
empty; of one that has grown the rest is read; one that has been packed is unpacked in
memory, once, when its content is wanted. What has been read stays, whatever becomes of the file.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.core.drive import turn_rate_dps
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec, RunSpec
from tuisim.core.state import TICK_RECORD, Instant
from tuisim.errors import LogError, counted
from tuisim.runs.packed.compact import Packed, find_packed
from tuisim.runs.records import (
    HEADER_BYTES,
    OUTPUT_FILE,
    OUTPUT_MAGIC,
    TELEMETRY_FILE,
    TELEMETRY_MAGIC,
    TICK_FIELDS,
    OutputRow,
    output_rows,
    published_length,
    raw_rows,
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


class _Recording:
    """A recording as far as it has been written, copied piece by piece; or unpacked.

    It is not mapped: a map of a file that is cut off under it kills its reader.

    Args:
        path: The file.
        magic: What it begins with.
        record_bytes: Of one record; 1 if they differ.
    """

    def __init__(self, path: Path, magic: bytes, record_bytes: int, may_be_damaged: bool) -> None:
        self._path = path
        self._may_be_damaged = may_be_damaged
        self.damage = ""
        """Why nothing of the file can be read, empty if it can."""
        self._magic = magic
        self._record_bytes = record_bytes
        self._copy = bytearray()
        """Begins like the file, and has room for more."""
        self._published = self._there = 0
        self._unpacked = False
        self.packed: Packed | None = None
        """The packed form, while nothing but its header has been read."""

    def look(self) -> tuple[memoryview, int, int]:
        """Return the recording, its published length, and how much of it is there."""
        published, there = self.extent()
        if self.packed is not None:
            self._copy, self.packed, self._unpacked = bytearray(self.packed.recording()), None, True
        return memoryview(self._copy).toreadonly(), published, there

    def extent(self) -> tuple[int, int]:
        """Return the published length, and how much of it is there."""
        if self.packed is None and not self._unpacked:
            self._read_on()
        return self._published, self._there

    def known(self, count: int) -> memoryview | None:
        """Return the recording if so many records have been read that will not change any more, else None."""
        if self.packed is not None or (count >= self._there and not self._unpacked):
            return None
        return memoryview(self._copy).toreadonly() if count <= self._there else None

    def _read_on(self) -> None:
        try:
            with open(self._path, "rb", buffering=0) as handle:
                self._read_from(handle.fileno())
        except FileNotFoundError:
            # Looked for in this order, a recording that is being packed is always found.
            self.packed = find_packed(self._path)
            if self.packed is not None:
                self._published = self._there = self.packed.length
        except OSError as error:
            raise LogError(f"cannot be read: {error.strerror or error}", file=str(self._path)) from error

    def _read_from(self, fd: int) -> None:
        head = _whole_header(fd)
        # The writer sizes a new file before it writes the header. One that has been emptied since has nothing to add.
        if not head.strip(b"\0") or (self._there and len(head) < HEADER_BYTES):
            return
        try:
            published = published_length(head, self._magic, str(self._path))
        except LogError as error:
            if not self._may_be_damaged:
                raise
            self.damage = f"{error.message}: nothing of it can be read"
            return
        room = max(0, os.fstat(fd).st_size - HEADER_BYTES) // self._record_bytes
        # The last record may have been written anew.
        kept = max(0, self._there - 1) if self._record_bytes > 1 else self._there
        self._published = max(published, self._published)
        wanted = min(published, room)
        if wanted <= kept:
            return
        begin, end = (HEADER_BYTES + self._record_bytes * count for count in (kept, wanted))
        if end > len(self._copy):
            # Another one, not a longer one: arrays may still look at what there is, and it goes with the last of them.
            larger = bytearray(end if not self._there else 2 * end)
            larger[:HEADER_BYTES] = head
            larger[HEADER_BYTES:begin] = self._copy[HEADER_BYTES:begin]
            self._copy = larger
        got = _read_into(fd, memoryview(self._copy)[begin:end], begin)
        self._there = max(self._there, kept + got // self._record_bytes)


def _whole_header(fd: int) -> bytes:
    """Return the header, read until it comes the same twice: a number in it could be just being written."""
    head = b""
    while (again := os.pread(fd, HEADER_BYTES, 0)) != head:
        head = again
    return head


def _read_into(fd: int, place: memoryview, at: int) -> int:
    """Fill a place with what stands in a file at a position; return how many bytes there were."""
    done = 0
    while done < len(place) and (got := os.preadv(fd, [place[done:]], at + done)):
        done += got
    return done


class TelemetryView:
    """The tick records of a run.

    Args:
        folder: The run folder.
        may_be_damaged: Whether a file that is no recording is taken for an empty one, which `note` tells.

    Raises:
        LogError: by every method, if the file is no recording or of another version and may not be damaged.
    """

    def __init__(self, folder: Path, may_be_damaged: bool = False) -> None:
        self._file = _Recording(folder / TELEMETRY_FILE, TELEMETRY_MAGIC, TICK_RECORD.size, may_be_damaged)

    @property
    def count(self) -> int:
        """How many whole records there are; record k is that of tick k."""
        return self._file.extent()[1]

    @property
    def note(self) -> str:
        """What is missing from a file that was cut off, or empty."""
        published, there = self._file.extent()
        if self._file.damage:
            return self._file.damage
        lost = published - there
        return (
            f"{TELEMETRY_FILE} was cut off: the last {lost} of {published} records {'is' if lost == 1 else 'are'} lost"
            if lost
            else ""
        )

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
        data = self._file.known(index + 1) if index >= 0 else None
        if data is None:
            data, _, count = self._file.look()
            if not 0 <= index < count:
                raise IndexError(f"no telemetry record {index}, there are {count}")
        return TickRecord(*TICK_RECORD.unpack_from(data, HEADER_BYTES + index * TICK_RECORD.size))

    def array(self) -> np.ndarray[Any, Any]:
        """Return all records as a structured array of `records.TICK_FIELDS`, shape (count,), read-only.

        It is a view, not a copy; records written later need another call.
        """
        import numpy as np

        kind = np.dtype(list(TICK_FIELDS))
        data, _, count = self._file.look()
        if not count:
            return np.empty(0, kind)
        return np.frombuffer(data, kind, count, HEADER_BYTES)


class OutputView:
    """The rows that a run printed, spoke or was answered.

    Args:
        folder: The run folder.
        may_be_damaged: Whether a file that is no recording is taken for an empty one, which `note` tells.

    Raises:
        LogError: by every method, if the file is no recording or of another version and may not be damaged.
    """

    def __init__(self, folder: Path, may_be_damaged: bool = False) -> None:
        self._file = _Recording(folder / OUTPUT_FILE, OUTPUT_MAGIC, 1, may_be_damaged)
        self._seen = 0

    @property
    def length(self) -> int:
        """How many bytes of rows there are."""
        return self._file.extent()[1]

    @property
    def note(self) -> str:
        """What is missing from a file that was cut off, or empty."""
        published, there = self._file.extent()
        if self._file.damage:
            return self._file.damage
        lost = published - there
        return f"{OUTPUT_FILE} was cut off: its last {counted(lost, 'byte is', 'bytes are')} lost" if lost else ""

    def new_rows(self, limit: int | None = None) -> list[OutputRow]:
        """Return the rows since the last call, at most `limit`; the others come with the next call."""
        rows: list[OutputRow] = []
        data, _, end = self._file.look()
        if limit == 0:
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
        yield from output_rows(data, position, end)

    def raw_rows(self) -> Iterator[tuple[int, bytes]]:
        """Yield stream and text of each row, the text as it stands in the file."""
        data, _, end = self._file.look()
        return raw_rows(data, end)

    def rows(self) -> Iterator[OutputRow]:
        """Yield what `all_rows` returns, one by one: a run may print a million lines."""
        data, _, end = self._file.look()
        for row, _ in output_rows(data, 0, end):
            yield row
