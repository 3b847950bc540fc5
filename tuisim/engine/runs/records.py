"""The two binary files of a run folder, and their writers. Pure Python: the child imports it.

Both files are shared memory maps that begin with a 64-byte header and grow while the
program runs. A writer stores a record first and then publishes the new length in the
header, so that a reader, even after a `kill -9`, never sees half a record.

`telemetry.bin`: one 64-byte record per tick (`TICK_RECORD`); length = number of records.
`output.bin`: rows of any size (`OUTPUT_ROW` and the text in UTF-8); length = bytes.
"""

from __future__ import annotations

import errno
import mmap
import os
import resource
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from enum import IntEnum, StrEnum
from pathlib import Path
from struct import Struct
from typing import TYPE_CHECKING, Any

from tuisim.base.atomic import private
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.base.regular_file import of_the_machine, read_regular
from tuisim.engine.core.tick_record import TICK_RECORD

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

HEADER_BYTES = 64
_HEADER = Struct("<8sIIQ")
"""Magic, format version, record size (0: variable), published length."""
_LENGTH_AT = 16
FORMAT_VERSION = 1

TELEMETRY_MAGIC = b"TUISIMTL"
OUTPUT_MAGIC = b"TUISIMOU"

OUTPUT_ROW = Struct("<IIqIB3x")
"""Number of bytes of text, tick, simulated time in ns, source line (0: none), stream; then the text."""


class Mark(StrEnum):
    """Why a tick of a run is marked on the timeline."""

    ERROR = "error"
    """An error text."""
    BREAK = "break"
    """A breakpoint was hit."""
    ACTION = "action"
    """An action of the user."""
    SAMPLE = "sample"
    """A sample that has reached another level."""
    COMMAND = "command"
    """A command of the program that is no repetition."""


class Stream(IntEnum):
    """Where an output row comes from, or which part of the brick's state it stores."""

    NOTE = 0
    """A line of the app itself; never recorded."""
    STDOUT = 1
    STDERR = 2
    SPEECH = 3
    """Spoken texts and, in brackets, other sounds."""
    INPUT = 4
    """The echo of an answer to `input()`."""
    LED = 5
    DISPLAY = 6
    CONSOLE = 7
    """The text screen of the brick."""
    MOTORS = 8
    """Rotation of motors that do not drive a wheel."""
    DATA = 9
    """A sample that the program wrote into a log file of its library, as a line that prints it."""
    UNKNOWN = 255
    """A number that stands for no stream, in a damaged recording."""


TEXT_STREAMS = frozenset({Stream.STDOUT, Stream.STDERR, Stream.SPEECH, Stream.INPUT})
"""Streams with readable text."""

SAMPLE_STREAMS = frozenset({Stream.STDOUT, Stream.DATA})
"""Streams in which there are samples."""

_STREAMS = {stream.value: stream for stream in Stream}

TELEMETRY_FILE = "telemetry.bin"
OUTPUT_FILE = "output.bin"
READINGS_FILE = "readings.bin"
"""What sensors, encoders and buttons the program has read; see `engine.runs.readings`."""
MOTORS_FILE = "motors.bin"
"""What the drivers knew of the motors at each tick; see `engine.runs.motor_records`. Missing if they have none."""
COMMANDS_FILE = "commands.bin"
"""What the program has changed in the simulation; see `engine.runs.command_records`."""
TELEMETRY_CHUNK = 64 * 1024
_FIRST_BYTES = 1 << 14
"""Initial size of a file of counted records after the header."""
OUTPUT_CHUNK = 1 << 16
"""Initial size of an output file after the header; it is truncated to its true size at the end."""

_ZEROS = 1 << 16
_MIN_STEP = 4096
"""If the disk lacks space, a file requests less in steps of at least this size."""

MAX_OUTPUT_BYTES = 256 << 20
"""A run that prints more than this is stopped."""
MAX_OUTPUT_ROWS = 1_000_000
MAX_ROWS_PER_S = 1_000
"""A run may print the first number of rows, plus the second for each simulated second; with more, it is stopped."""
_NS_PER_ROW = 1_000_000_000 // MAX_ROWS_PER_S


def pack_header(magic: bytes, record_bytes: int, length: int) -> bytes:
    """Return the header of a recording, which has HEADER_BYTES bytes.

    Args:
        magic: The bytes with which files of this kind begin.
        record_bytes: The size of a record.
        length: The number of records, or of bytes of output, that readers can see.
    """
    return _HEADER.pack(magic, FORMAT_VERSION, record_bytes, length).ljust(HEADER_BYTES, b"\0")


def is_full(error: OSError) -> bool:
    """Return whether an error means that no more can be written: a full disk, a quota, or a limit of file sizes."""
    return error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def _allow_address_space(more: int) -> None:
    """Raise this process's limit of address space by `more` bytes.

    The limit is meant for the program: the recording, in the same process, must not use it up.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    if soft != resource.RLIM_INFINITY:
        limit = soft + more if hard == resource.RLIM_INFINITY else min(hard, soft + more)
        # If the system refuses, the program has less memory.
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_AS, (limit, hard))


def _reserve(fd: int, start: int, size: int) -> None:
    """Allocate disk space for a part of a file: writing to a memory map without space would kill the process."""
    try:
        os.posix_fallocate(fd, start, size)
    # macOS does not have this function, and some file systems refuse it.
    except (AttributeError, OSError) as error:
        if isinstance(error, OSError) and error.errno not in (
            errno.EINVAL,
            errno.EOPNOTSUPP,
            errno.ENOSYS,
        ):
            raise
        nothing = bytes(min(size, _ZEROS))
        end = start + size
        while start < end:
            start += os.pwrite(fd, nothing[: end - start], start)


class MappedWriter:
    """Base class of writers of recordings, each of which is a memory-mapped file that grows in ever larger steps.

    Raises:
        OSError: by the constructor, if the disk is full.
    """

    def __init__(self, path: str, magic: bytes, record_bytes: int, first_bytes: int) -> None:
        self.full: Callable[[OSError], BaseException] = lambda error: error
        """Returns the exception to raise when the disk is full; what was written before is kept."""
        self._is_full = False
        self._fd = private(path, os.O_RDWR | os.O_CREAT | os.O_EXCL)
        self._capacity = HEADER_BYTES + first_bytes
        _reserve(self._fd, 0, self._capacity)
        self._map_file()
        self._map[0:HEADER_BYTES] = pack_header(magic, record_bytes, 0)

    def _make_room(self, need: int) -> None:
        try:
            self._grow(need)
        except OSError as error:
            self._is_full = True
            raise self.full(error) from None

    def _grow(self, need: int) -> None:
        capacity = self._capacity
        while capacity < need:
            capacity *= 2
        while True:
            try:
                _reserve(self._fd, self._capacity, capacity - self._capacity)
                break
            except OSError as error:
                # Some file systems keep the part of the file for which there was space: cut it off.
                os.ftruncate(self._fd, self._capacity)
                if not is_full(error) or capacity == need:
                    raise
                capacity = max(need, (self._capacity + capacity) // 2 - _MIN_STEP)
        self._close_map()
        _allow_address_space(capacity - self._capacity)
        self._capacity = capacity
        self._map_file()

    def _map_file(self) -> None:
        self._map = mmap.mmap(self._fd, self._capacity)
        # The length is set by one aligned store, which is atomic for readers; `pack_into` would clear the bytes first.
        self._length = memoryview(self._map)[_LENGTH_AT : _LENGTH_AT + 8].cast("Q")

    def _close_map(self) -> None:
        self._length.release()
        self._map.close()

    def _close(self, used: int) -> None:
        self._close_map()
        # If this fails, the unused rest may stay, because the header has the length that is in use.
        with suppress(OSError):
            os.ftruncate(self._fd, used)
        os.close(self._fd)


class TelemetryWriter(MappedWriter):
    """A writer of tick records.

    The simulation writes the records directly into the memory map that `reserve` returns, then calls `publish`.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__(
            f"{folder}{os.sep}{TELEMETRY_FILE}", TELEMETRY_MAGIC, TICK_RECORD.size, TELEMETRY_CHUNK
        )
        self.count = 0

    def reserve(self, records: int) -> mmap.mmap:
        """Return the memory map of the file, with space for `records` records after the first `count` ones."""
        need = HEADER_BYTES + (self.count + records) * TICK_RECORD.size
        if need > self._capacity:
            self._make_room(need)
        return self._map

    def publish(self, count: int) -> None:
        """Make the first `count` tick records visible to readers of the file."""
        self.count = self._length[0] = count

    def close(self) -> None:
        """Close the file of tick records, and cut off its unused space."""
        self._close(HEADER_BYTES + self.count * TICK_RECORD.size)


class OutputWriter(MappedWriter):
    """A writer of rows of output; readers can see each row immediately. When the disk is full, later rows are lost."""

    def __init__(self, folder: Path) -> None:
        super().__init__(f"{folder}{os.sep}{OUTPUT_FILE}", OUTPUT_MAGIC, 0, OUTPUT_CHUNK)
        self.length = self.rows = 0

    def write(self, text: bytes, tick: int, time_ns: int, line: int, stream: Stream) -> None:
        """Append one row of output.

        Args:
            text: The line without its newline, UTF-8.
            tick: Number of completed ticks.
            time_ns: Simulated time.
            line: Source line that printed it; 0 for none.
            stream: The stream.

        Raises:
            LogError: the output has reached MAX_OUTPUT_BYTES, or more rows than are allowed up to this time.
        """
        if self._is_full:
            return
        self.rows += 1
        if self.rows > MAX_OUTPUT_ROWS + time_ns // _NS_PER_ROW:
            raise LogError(
                f"the program printed more than {MAX_OUTPUT_ROWS:,} lines and {MAX_ROWS_PER_S:,} a second"
            )
        offset = HEADER_BYTES + self.length
        end = offset + OUTPUT_ROW.size + len(text)
        if end > self._capacity:
            if end > MAX_OUTPUT_BYTES:
                raise LogError(f"the program printed more than {MAX_OUTPUT_BYTES >> 20} MiB")
            self._make_room(end)
        self._map[offset:end] = OUTPUT_ROW.pack(len(text), tick, time_ns, line, stream) + text
        self.length = self._length[0] = end - HEADER_BYTES

    def close(self) -> None:
        """Close the file of output, and cut off its unused space."""
        self._close(HEADER_BYTES + self.length)


class CountedWriter(MappedWriter):
    """Base class of writers of records of one size; readers can see each record immediately.

    Args:
        path: The file.
        magic: The bytes with which files of this kind begin.
        record_bytes: The size of a record.
        most: Maximum number of records in the file; further ones are only counted.
    """

    def __init__(self, path: str, magic: bytes, record_bytes: int, most: int) -> None:
        super().__init__(path, magic, record_bytes, _FIRST_BYTES)
        self._record_bytes = record_bytes
        self._most = most
        self._count = 0
        self._room = _FIRST_BYTES // record_bytes
        """Number of records for which the file has space."""

    def _extend(self, count: int) -> bool:
        """Make space in the file for `count` + 1 records; return False if there is none."""
        if count >= self._most or self._is_full:
            return False
        self._make_room(HEADER_BYTES + (count + 1) * self._record_bytes)
        self._room = min(self._most, (self._capacity - HEADER_BYTES) // self._record_bytes)
        return True

    def close(self) -> None:
        """Close the file, and cut off its unused space."""
        self._close(HEADER_BYTES + min(self._count, self._room) * self._record_bytes)


@dataclass(frozen=True, slots=True)
class OutputRow:
    """One row of output: a printed line, speech, an answer to `input()`, or a part of the brick's state."""

    text: str
    tick: int
    time_ns: int
    line: int
    stream: Stream

    @property
    def is_text(self) -> bool:
        """Whether its text is one to read, not a part of the brick's state."""
        return self.stream in TEXT_STREAMS

    @property
    def may_be_sample(self) -> bool:
        """Whether a sample in its text counts."""
        return self.stream in SAMPLE_STREAMS

    def format_line(self) -> str:
        """Return the display text of a row: speech begins with `says: `, and an answer to `input()` with `> `."""
        if self.stream is Stream.SPEECH and not self.text.startswith("["):
            # A text in brackets describes a sound, which is not spoken.
            return f"says: {self.text}"
        return f"> {self.text}" if self.stream is Stream.INPUT else self.text


def read_published_length(data: bytes, magic: bytes, file: str) -> int:
    """Return the length in a recording's header: the number of telemetry records, or the bytes of output.

    Args:
        data: The contents of the file, or only its header.
        magic: The bytes with which files of this kind begin.
        file: The path of the file, for errors.

    Raises:
        LogError: the file is not such a recording, or of another version.
    """
    return read_header(data, magic, file)[1]


def read_header(data: bytes, magic: bytes, file: str) -> tuple[int, int]:
    """Return the size of a record and the length in a recording's header.

    Args:
        data: The contents of the file, or only its header.
        magic: The bytes with which files of this kind begin.
        file: The path of the file, for errors.

    Raises:
        LogError: the file is not such a recording, or of another version.
    """
    if len(data) < HEADER_BYTES:
        raise LogError("too short to be a recording", file=file)
    file_magic, version, record_bytes, length = _HEADER.unpack_from(data)
    if file_magic != magic:
        raise LogError("not a tuisim recording", file=file)
    if version != FORMAT_VERSION:
        raise LogError(f"format version {version}, this tuisim reads {FORMAT_VERSION}", file=file)
    return int(record_bytes), int(length)


def read_counted(
    path: Path, magic: bytes, fields: Sequence[tuple[str, str]], most: int, did: str
) -> tuple[Array, int]:
    """Return the records in a file of a `CountedWriter` so far, and the number of those for which it had no space.

    Args:
        path: The file.
        magic: The bytes with which files of this kind begin.
        fields: Name and type of each field of a record, the type as numpy writes it.
        most: Maximum number of records in the file.
        did: What the program did, for errors, such as `read`.

    Raises:
        LogError: the file is missing, damaged or of another version, or this machine cannot read it.
    """
    import numpy as np

    kind = np.dtype([*fields])
    try:
        data = read_regular(path, HEADER_BYTES + 2 * most * kind.itemsize)
    except FileNotFoundError as error:
        raise LogError(
            f"there is no record of what the program {did}", "run it again", file=str(path)
        ) from error
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(path)) from (
            error if of_the_machine(error) else None
        )
    size, published = read_header(data, magic, str(path))
    if size != kind.itemsize:
        raise LogError("damaged: its records have another size", file=str(path))
    count = min(published, most, (len(data) - HEADER_BYTES) // size)
    return np.frombuffer(data, kind, count, HEADER_BYTES), published - count


def is_hole(part: bytes | memoryview) -> bool:
    """Return whether a part of a recording was never written; the part must be far larger than a record.

    A file with such parts may seem to be of any length without taking space on the disk.
    """
    return not bytes(part[-HEADER_BYTES:]).strip(b"\0") and not bytes(part).strip(b"\0")


def iterate_raw_rows(data: bytes | memoryview, end: int) -> Iterator[tuple[int, bytes]]:
    """Yield the stream and the text of each complete row of output, faster than `iterate_rows`.

    Args:
        data: The contents of an output file.
        end: Published length in bytes; later rows are left out.
    """
    start = HEADER_BYTES
    head = OUTPUT_ROW.unpack_from
    after_head = OUTPUT_ROW.size
    end += HEADER_BYTES
    while start + after_head <= end:
        size, _, _, _, stream = head(data, start)
        start += after_head + size
        if start > end:
            return
        yield stream, bytes(data[start - size : start])


def iterate_rows(data: bytes | memoryview, start: int, end: int) -> Iterator[tuple[OutputRow, int]]:
    """Yield each complete row between two byte positions, with the position after it.

    Args:
        data: The contents of an output file.
        start: Byte position after the header: 0, or one that was yielded before.
        end: Published length in bytes.
    """
    while start + OUTPUT_ROW.size <= end:
        offset = HEADER_BYTES + start
        size, tick, time_ns, line, stream = OUTPUT_ROW.unpack_from(data, offset)
        start += OUTPUT_ROW.size + size
        if start > end:
            return
        text = bytes(data[offset + OUTPUT_ROW.size : offset + OUTPUT_ROW.size + size]).decode(
            "utf-8", "replace"
        )
        yield OutputRow(text, tick, time_ns, line, _STREAMS.get(stream, Stream.UNKNOWN)), start
