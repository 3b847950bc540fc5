"""Readers of a run folder's two binary files, also while the program runs.

A view never changes the file and never blocks. A missing file reads as empty; of a file that has grown the rest is
read. Data that has been read stays valid, even if the file changes.

The program could write to these files as well. So a view of a run that is running reads only data that the simulation
can have written: ticks in order, finite numbers, complete rows.
"""

from __future__ import annotations

import os
import re
from abc import ABC, abstractmethod
from collections.abc import Iterator
from itertools import islice
from math import hypot
from mmap import MAP_ANONYMOUS, MAP_PRIVATE, mmap
from operator import itemgetter
from pathlib import Path
from stat import S_IRUSR
from typing import TYPE_CHECKING, Any, ClassVar
from weakref import finalize

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, counted
from tuisim.base.regular_file import of_the_machine, open_regular
from tuisim.engine.core.drift import find_drift
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import NoiseSpec, RunSpec
from tuisim.engine.core.state import Instant
from tuisim.engine.core.tick_record import (
    FLAG_LEFT_RUNNING,
    FLAG_PEN_DOWN,
    FLAG_RIGHT_RUNNING,
    PRESS_FLAGS,
    TICK_FIELDS,
    TICK_RECORD,
)
from tuisim.engine.runs.brick_state import DRAWN_STREAMS, is_sound
from tuisim.engine.runs.records import (
    HEADER_BYTES,
    MAX_OUTPUT_BYTES,
    OUTPUT_FILE,
    OUTPUT_MAGIC,
    OUTPUT_ROW,
    SAMPLE_STREAMS,
    TELEMETRY_FILE,
    TELEMETRY_MAGIC,
    OutputRow,
    Stream,
    is_hole,
    iterate_raw_rows,
    iterate_rows,
    read_published_length,
)
from tuisim.engine.runs.samples import is_sample

if TYPE_CHECKING:
    import numpy as np

_LARGE_BYTES = 1 << 20
_CHUNK_BYTES = 1 << 22
"""Bytes that are read and checked at a time: a file may claim, or seem to have, any length."""
_KEPT_BYTES = 1 << 20
"""Largest size in bytes of an output whose rows stay in memory."""
_STDOUT = Stream.STDOUT
"""Runs may print millions of rows, and an attribute of an enumeration is slow to reach."""
_AGAIN_BYTES = 1 << 14
"""Bytes that are read at a time of rows that are no longer in memory."""
_MANY_TICKS = 1 << 13
"""Number of records from which on it is worth importing numpy to check them."""
_MAX_NUMBER = 1e30
"""Larger than any position, angle or speed that a run can reach with commands up to `MAX_NUMBER`."""


@dataclass(frozen=True, slots=True)
class TickRecord:
    """The telemetry of one tick; see `engine.core.tick_record.TICK_RECORD`."""

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
        """The robot's pose."""
        return Pose(self.x_mm, self.y_mm, self.heading_deg)

    @property
    def is_pen_down(self) -> bool:
        """Whether the pen is down, so that it draws."""
        return bool(self.flags & FLAG_PEN_DOWN)

    @property
    def running(self) -> tuple[bool, bool]:
        """Whether the left and the right wheel's motor have a command."""
        return bool(self.flags & FLAG_LEFT_RUNNING), bool(self.flags & FLAG_RIGHT_RUNNING)

    def build_instant(self, spec: RunSpec, noise: NoiseSpec) -> Instant:
        """Return the instant of a record, with the noise at its tick, for functions of `engine.core.sensors`."""
        from tuisim.engine.core.drift import sense_turn_rate_dps

        return Instant(
            tick=self.tick,
            pose=self.pose,
            left_position_deg=self.left_position_deg,
            right_position_deg=self.right_position_deg,
            left_speed_dps=self.left_speed_dps,
            right_speed_dps=self.right_speed_dps,
            turn_rate_dps=sense_turn_rate_dps(self.left_speed_dps, self.right_speed_dps, spec),
            gyro_zero_deg=self.gyro_zero_deg,
            press_flags=self.flags & PRESS_FLAGS,
            noise=noise,
            drift=find_drift(spec),
            profile=spec.profile,
            seed=spec.seed,
        )


class _View(ABC):
    """A copy of a recording as far as it has been written; while the file grows, the copy follows.

    The file is not memory-mapped: truncating a mapped file would kill its reader.

    Args:
        folder: The run folder.
        is_checked: Whether to check that the data comes from the simulation, because the program may have changed the
            file. Data that the simulation cannot have written is then not returned, and counts as damage; so does a
            file that disappears.

    Raises:
        LogError: by every method, if this machine cannot read the file.
    """

    name: ClassVar[str]
    """Name of the file."""
    _magic: ClassVar[bytes]
    _record_bytes: ClassVar[int]
    """Size of a record; 1 if it varies."""
    _kept: ClassVar[int | None] = None
    """At least this many records of a running run are kept in memory; None for all."""
    _most_bytes: ClassVar[int | None] = None
    """The length that the program's process never exceeds; None if there is none."""

    def __init__(self, folder: Path, is_checked: bool = False) -> None:
        self._path = folder / self.name
        self._is_checked = is_checked
        self._damage = ""
        self.holds = False
        """Whether the copy stays unchanged until the next `read_new`, so that all readers see the same data."""
        self._copy: bytearray | mmap = bytearray()
        """The copy: it begins like the file, has spare capacity, and lacks the first `_dropped` records."""
        self._dropped = 0
        self._source: int | None = None
        """Descriptor of the file, from which records that were dropped are read again; open only if some were."""
        self._published = self._there = 0
        self._has_begun = False

    @property
    def is_missing(self) -> bool:
        """Whether the run does not have this recording. A recording that is empty, but has a header, is not missing."""
        return not self._measure_length() and not self._has_begun

    @property
    def note(self) -> str:
        """A text that says what is missing in a truncated or damaged file; empty if nothing is."""
        there = self._measure_length()
        if self._damage or self._published == there:
            return self._damage
        return f"{self._path.name} was truncated: {self._describe_lost(self._published - there)}"

    @abstractmethod
    def _describe_lost(self, count: int) -> str:
        """Return a text that says that `count` records, or bytes, are lost."""

    @abstractmethod
    def _find_sound_end(self, data: memoryview, begin: int, end: int) -> int:
        """Return the index up to which records, or bytes, can come from the simulation.

        Args:
            data: The copy of the recording.
            begin: The index of the first record, or byte, to check.
            end: The index after the last one.
        """

    @property
    def _done(self) -> int:
        """Number of records or bytes at the start of the recording that are known to be valid for good."""
        return self._there

    def _look(self) -> tuple[memoryview, int]:
        """Return the copy of the recording, read-only, and how many valid records or bytes it has."""
        there = self._measure_length()
        return memoryview(self._copy).toreadonly(), there

    def _measure_length(self) -> int:
        """Return how many records or bytes there are, after reading new ones unless `holds` is set."""
        if not self.holds:
            self.read_new()
        return self._there

    def read_new(self) -> str:
        """Read what was written since the last call; return why the file is not a valid recording, or an empty text."""
        if not self._damage:
            self._read_new()
        return self._damage

    def hold(self) -> str:
        """Read what was written since the last call, and then keep the copy as it is until the next `read_new`.

        Return why the file is not a valid recording, or an empty text.
        """
        damage = self.read_new()
        self.holds = True
        return damage

    def _read_new(self) -> None:
        try:
            with open_regular(self._path) as handle:
                self._read_file(handle.fileno())
        except FileNotFoundError:
            if self._is_checked and self._there:
                self._damage = f"{self._path.name} was deleted"
        except OSError as error:
            reason = error.strerror or str(error)
            if of_the_machine(error) or self._is_withheld(error):
                raise LogError(f"cannot be read: {reason}", file=str(self._path)) from error
            self._damage = f"{self._path.name} cannot be read: {reason}"

    def _is_withheld(self, error: OSError) -> bool:
        """Return whether an error means that this machine forbids reading a file although its permissions allow it.

        A program cannot cause such an error.
        """
        try:
            return isinstance(error, PermissionError) and bool(self._path.stat().st_mode & S_IRUSR)
        except OSError:
            return False

    def _read_file(self, fd: int) -> None:
        head = _read_header(fd)
        # A new file has its size before it has a header. A file that was emptied after it was read is ignored.
        if not head.strip(b"\0") or (self._there and len(head) < HEADER_BYTES):
            return
        try:
            published = read_published_length(head, self._magic, self._path.name)
        except LogError as error:
            self._damage = f"{error.message}: it cannot be read"
            return
        self._has_begun = True
        if self._most_bytes is not None and published > self._most_bytes:
            self._damage = f"{self._path.name} is too long for a recording"
            return
        room = max(0, os.fstat(fd).st_size - HEADER_BYTES) // self._record_bytes
        self._published = max(published, self._published)
        # The last record is read again, because the simulation may have rewritten it.
        count = max(0, self._there - 1) if self._record_bytes > 1 else self._there
        published_count = min(published, room)
        step = _CHUNK_BYTES // self._record_bytes
        while count < published_count and not self._damage:
            end = min(published_count, count + step)
            count = self._read_chunk(fd, head, count, end)
            if count < end:
                # The file was truncated meanwhile, or its rest was never written: what was read before stays.
                return

    def _read_chunk(self, fd: int, head: bytes, begin_count: int, end_count: int) -> int:
        """Read records from the file into the copy, and check them.

        Args:
            fd: The descriptor of the file.
            head: The header of the file.
            begin_count: The index of the first record, or byte, to read.
            end_count: The index after the last one.

        Returns:
            The index up to which they are valid.
        """
        begin, end = (
            HEADER_BYTES + self._record_bytes * (count - self._dropped)
            for count in (begin_count, end_count)
        )
        if end > len(self._copy):
            begin, end = self._make_room(fd, head, begin, end)
        offset = HEADER_BYTES + self._record_bytes * begin_count
        got = _read_buffer(fd, memoryview(self._copy)[begin:end], offset) // self._record_bytes
        if self._is_checked:
            sound = self._find_sound_end(
                memoryview(self._copy).toreadonly(), begin_count, begin_count + got
            )
        elif got * self._record_bytes == _CHUNK_BYTES and is_hole(
            memoryview(self._copy)[begin:end]
        ):
            sound = begin_count
        else:
            sound = begin_count + got
        self._there = max(self._there, sound)
        return sound

    def _make_room(self, fd: int, head: bytes, begin: int, end: int) -> tuple[int, int]:
        """Enlarge the copy, so that more bytes of the file fit; records that are not needed any more are dropped.

        Args:
            fd: The descriptor of the file.
            head: The header of the file.
            begin, end: Where the further bytes would begin and end in the copy if nothing were dropped.

        Returns:
            Where they begin and end in the enlarged copy.
        """
        drops = 0
        if self._is_checked and self._kept is not None:
            drops = min(
                (begin - HEADER_BYTES) // self._record_bytes - self._kept,
                self._done - self._dropped,
            )
            drops = max(0, drops)
        if drops and self._source is None:
            self._source = os.dup(fd)
            finalize(self, os.close, self._source)
        first = HEADER_BYTES + drops * self._record_bytes
        begin, end = begin - first + HEADER_BYTES, end - first + HEADER_BYTES
        # The buffer is replaced, not resized, because arrays may still refer to the old one.
        larger = _allocate(end if not self._there else 2 * end)
        larger[:HEADER_BYTES] = head
        larger[HEADER_BYTES:begin] = memoryview(self._copy)[first : first + begin - HEADER_BYTES]
        self._copy = larger
        self._dropped = self._dropped + drops
        return begin, end


def _are_few_sound(part: memoryview, begin: int, end: int) -> bool:
    """Return whether records have the ticks from `begin` to before `end`, in this order, and plausible numbers."""
    doubles = part.cast("d")
    floats = part.cast("f")
    columns = [doubles[index :: TICK_RECORD.size // 8] for index in range(1, 6)]
    columns += [floats[index :: TICK_RECORD.size // 4] for index in range(12, 15)]
    ticks = part.cast("I")[:: TICK_RECORD.size // 4].tolist()
    # `hypot` is at least as large as each number of a column, and NaN if one is NaN: then the comparison is false.
    return ticks == list(range(begin, end)) and all(
        hypot(*column.tolist()) <= _MAX_NUMBER for column in columns
    )


def _are_all_sound(part: memoryview, begin: int, end: int) -> bool:
    """Return whether records have the ticks from `begin` to before `end`, in this order, and plausible numbers.

    For many records, this is a hundred times faster than `_are_few_sound`.
    """
    import numpy as np

    records = np.frombuffer(part, np.dtype(list(TICK_FIELDS)))
    numbers = [name for name, _ in TICK_FIELDS[1:]]
    return bool((records["tick"] == np.arange(begin, end)).all()) and all(
        bool((np.abs(records[name]) <= _MAX_NUMBER).all()) for name in numbers
    )


def _allocate(size: int) -> bytearray | mmap:
    """Return a buffer of a size; a large one takes memory only where it is filled."""
    return bytearray(size) if size < _LARGE_BYTES else mmap(-1, size, MAP_PRIVATE | MAP_ANONYMOUS)


def _read_header(fd: int) -> bytes:
    """Return the header of a recording, read until two reads are equal: a number in it may be half written."""
    head = b""
    while (again := os.pread(fd, HEADER_BYTES, 0)) != head:
        head = again
    return head


def _read_buffer(fd: int, place: memoryview, at: int) -> int:
    """Fill a buffer with bytes of a file; return the number of bytes read.

    Args:
        fd: The descriptor of the file.
        place: The buffer.
        at: The position in the file from which to read.
    """
    done = 0
    while done < len(place) and (got := os.preadv(fd, [place[done:]], at + done)):
        done += got
    return done


class TelemetryView(_View):
    """The tick records of a run, read from its folder."""

    name = TELEMETRY_FILE
    _magic = TELEMETRY_MAGIC
    _record_bytes = TICK_RECORD.size
    _kept = 1 << 14

    @property
    def count(self) -> int:
        """Number of complete tick records in the recording; record k is that of tick k."""
        return self._measure_length()

    def _describe_lost(self, count: int) -> str:
        return f"the last {count} of {self._published} records {'is' if count == 1 else 'are'} lost"

    def _find_sound_end(self, data: memoryview, begin: int, end: int) -> int:
        first, after = (
            HEADER_BYTES + TICK_RECORD.size * (tick - self._dropped) for tick in (begin, end)
        )
        return self._find_sound_ticks(data[first:after], begin)

    def _find_sound_ticks(self, part: memoryview, begin: int) -> int:
        """Return the tick up to which records are valid; the first record is that of tick `begin`."""
        end = begin + len(part) // TICK_RECORD.size
        # Ticks are numbered from 0, and all other fields are finite numbers. Whole columns are checked first: it is
        # faster.
        are_all = _are_all_sound if end - begin >= _MANY_TICKS else _are_few_sound
        if are_all(part, begin, end):
            return end
        for tick, record in enumerate(TICK_RECORD.iter_unpack(part), begin):
            if record[0] != tick or not all(abs(value) <= _MAX_NUMBER for value in record):
                what = f"record {tick} of {self._path.name} cannot come from the simulation"
                self._damage = self._damage or what
                return tick
        return end

    def _read_again(self, begin: int, end: int) -> memoryview:
        """Read records from the file again that are no longer in memory, and return them.

        Only a program can have changed these records since they were read. A changed record is replaced by the oldest
        record in memory, so that the reader does not fail here: it learns of the damage later.
        """
        assert self._source is not None
        size = TICK_RECORD.size
        step = _CHUNK_BYTES // TICK_RECORD.size
        records = memoryview(_allocate((end - begin) * size))
        for first in range(begin, end, step):
            part = records[(first - begin) * size : (first - begin + step) * size]
            _read_buffer(self._source, part, HEADER_BYTES + first * size)
            if lost := first + len(part) // size - (sound := self._find_sound_ticks(part, first)):
                oldest = memoryview(self._copy)[HEADER_BYTES : HEADER_BYTES + size]
                part[(sound - first) * size :] = bytes(oldest) * lost
        return records.toreadonly()

    def last(self) -> TickRecord | None:
        """Return the newest tick record; None if there is none yet."""
        count = self.count
        return self.record(count - 1) if count else None

    def record(self, index: int) -> TickRecord:
        """Return the record of one tick.

        Raises:
            IndexError: the record does not exist (yet).
        """
        # Only the newest record may still change, or be missing: then the file is read.
        if not 0 <= index < self._there - 1:
            count = self.count
            if not 0 <= index < count:
                raise IndexError(f"no telemetry record {index}, there are {count}")
        if index < self._dropped:
            return TickRecord(*TICK_RECORD.unpack(self._read_again(index, index + 1)))
        offset = HEADER_BYTES + (index - self._dropped) * TICK_RECORD.size
        return TickRecord(*TICK_RECORD.unpack_from(self._copy, offset))

    def array(self, first: int = 0) -> np.ndarray[Any, Any]:
        """Return all present records from index `first` on, as a read-only structured array of `TICK_FIELDS`.

        The array is a view. It is a copy only if some of these records are no longer in memory, as in a long run.
        """
        import numpy as np

        kind = np.dtype(list(TICK_FIELDS))
        data, count = self._look()
        if first >= count:
            return np.empty(0, kind)
        if first >= self._dropped:
            offset = HEADER_BYTES + (first - self._dropped) * TICK_RECORD.size
            return np.frombuffer(data, kind, count - first, offset)
        # Records that are still in memory are read from the file, too, because the whole array must be one buffer.
        return np.frombuffer(self._read_again(first, count), kind)


class OutputView(_View):
    """The output rows of a run, read from its folder: printed lines, speech, answers to `input()`, brick state."""

    name = OUTPUT_FILE
    _magic = OUTPUT_MAGIC
    _record_bytes = 1
    # A file may be larger than its contents by the last step in which it grew.
    _most_bytes = 2 * MAX_OUTPUT_BYTES
    _kept = 1 << 20
    _seen = 0
    _kept_rows: list[OutputRow]
    _kept_length = -1
    """Length of the output of which `_kept_rows` are all rows."""
    _checked = 0
    """Position up to which all rows are complete and valid."""

    @property
    def length(self) -> int:
        """Number of bytes that the rows of output take in their file."""
        return self._measure_length()

    def _describe_lost(self, count: int) -> str:
        return f"its last {counted(count, 'byte is', 'bytes are')} lost"

    def _find_sound_end(self, data: memoryview, begin: int, end: int) -> int:
        position = self._checked
        shift = HEADER_BYTES - self._dropped
        while position + OUTPUT_ROW.size <= end:
            size, _, _, _, stream = OUTPUT_ROW.unpack_from(data, shift + position)
            after = position + OUTPUT_ROW.size + size
            if after > end and after <= self._published:
                # The rest of the row has not been read yet, or is lost.
                break
            body = slice(shift + after - size, shift + after)
            if after > end or (
                stream in DRAWN_STREAMS and not is_sound(Stream(stream), bytes(data[body]))
            ):
                self._damage = (
                    f"the row at byte {position} of {self._path.name} cannot come from the brick"
                )
                return position
            position = after
        self._checked = position
        return end

    @property
    def _done(self) -> int:
        return self._checked

    def read_new_rows(self, limit: int | None = None) -> list[OutputRow]:
        """Return the rows since the last call, at most `limit`; any others are returned by the next call."""
        rows: list[OutputRow] = []
        for row, after in islice(self.read_rows(self._seen), limit):
            rows.append(row)
            self._seen = after
        return rows

    def may_contain(self, text: str) -> bool:
        """Return whether a text may be in one of the rows so far; False is certain.

        This takes much less time than to read all rows.
        """
        data, _ = self._look()
        return bool(self._dropped) or re.search(re.escape(text.encode()), data) is not None

    def read_all_rows(self) -> list[OutputRow]:
        """Return all output rows so far, without changing what `read_new_rows` returns next.

        The rows of a short output are kept, because each of its readers reads all of them.
        """
        length = self._measure_length()
        if length > _KEPT_BYTES:
            return [row for row, _ in self.read_rows(0)]
        if length != self._kept_length:
            self._kept_rows = [row for row, _ in self.read_rows(0)]
            self._kept_length = length
        return self._kept_rows

    def read_rows(self, position: int) -> Iterator[tuple[OutputRow, int]]:
        """Yield the rows from a byte position on, each with the position after it.

        `position` is 0, or a position that was yielded before.
        """
        data, end = self._look()
        if not self._dropped:
            return iterate_rows(data, position, end)
        return self._read_both_rows(data, position, end, self._dropped)

    def _read_both_rows(
        self, data: memoryview, position: int, end: int, dropped: int
    ) -> Iterator[tuple[OutputRow, int]]:
        """Yield the rows between two positions, each with the position after it.

        Args:
            data: The rows that are in memory.
            position: The position of the first row.
            end: The position after the last row.
            dropped: The position of the first row in memory; the rows before it were dropped, and are read again.
        """
        for row, after in self._read_dropped_rows(position, dropped):
            yield row, after
            position = after
        if position >= dropped:
            for row, after in iterate_rows(data, position - dropped, end - dropped):
                yield row, dropped + after

    def _read_dropped_rows(self, position: int, end: int) -> Iterator[tuple[OutputRow, int]]:
        """Yield the rows between two positions that were dropped from memory; stop at one that was changed since."""
        size = _AGAIN_BYTES
        while position < end and self._source is not None:
            part = bytearray(HEADER_BYTES + size)
            got = _read_buffer(
                self._source, memoryview(part)[HEADER_BYTES:], HEADER_BYTES + position
            )
            begin = position
            for row, after in iterate_rows(memoryview(part), 0, got):
                if row.stream in DRAWN_STREAMS and not is_sound(row.stream, row.text.encode()):
                    break
                position = begin + after
                yield row, position
                if position >= end:
                    return
            if position == begin:
                # The row is longer than the piece that was read, or was changed and now seems to be.
                if got < size or size > MAX_OUTPUT_BYTES:
                    self._damage = (
                        self._damage
                        or f"the row at byte {position} of {self._path.name} was changed"
                    )
                    return
                size *= 4

    def read_raw_rows(self) -> Iterator[tuple[int, bytes]]:
        """Yield the stream and the text of each row; the text as the bytes that are in the file."""
        data, end = self._look()
        if self._dropped:
            return ((row.stream, row.text.encode()) for row in self.rows())
        return iterate_raw_rows(data, end)

    def rows(self) -> Iterator[OutputRow]:
        """Yield the rows of `read_all_rows`; those of a long output one by one, as a run may print a million lines."""
        if self._measure_length() > _KEPT_BYTES:
            return map(itemgetter(0), self.read_rows(0))
        return iter(self.read_all_rows())

    def count_rows(self) -> tuple[int, int]:
        """Return the numbers of printed lines and samples.

        No `OutputRow` is created for a row, because there may be a million rows.
        """
        lines = samples = 0
        for stream, text in self.read_raw_rows():
            if stream in SAMPLE_STREAMS:
                lines += stream == _STDOUT
                samples += is_sample(text)
        return lines, samples


def open_views(folder: Path, is_checked: bool = False) -> tuple[TelemetryView, OutputView]:
    """Return the telemetry and the output of a run folder.

    Args:
        folder: The run folder.
        is_checked: Whether to check that the data comes from the simulation, because the program may have changed the
            files.
    """
    return TelemetryView(folder, is_checked), OutputView(folder, is_checked)
