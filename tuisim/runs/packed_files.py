"""Packed form of a finished run's two recordings; the views read it like the original form.

A packed file replaces the growing one: it is complete before that one is deleted, so that
a run can be read at any time, whichever process dies. Its header describes the recording: its
length, its last record, and a checksum of its bytes.
"""

from __future__ import annotations

import zlib
from pathlib import Path
from struct import Struct
from struct import error as StructError
from typing import BinaryIO

from tuisim.atomic import replacing, sweep
from tuisim.core.tick_record import TICK_RECORD
from tuisim.data_class import dataclass
from tuisim.errors import LogError
from tuisim.regular_file import open_regular
from tuisim.runs.records import (
    HEADER_BYTES,
    OUTPUT_FILE,
    OUTPUT_MAGIC,
    TELEMETRY_FILE,
    TELEMETRY_MAGIC,
    header,
    is_hole,
    published_length,
)

PACKED_SUFFIX = ".packed"
PACKED_MAGIC = {TELEMETRY_FILE: b"TUISIMTP", OUTPUT_FILE: b"TUISIMOP"}
"""By the original file name."""
PACKED_VERSION = 2
_EARLIER_VERSION = 1
EARLIER = "its recording was packed by an earlier tuisim and cannot be read: `tuisim runs rerun RUN` makes it again"
_HEADER = Struct("<8sIIQQ32x64s")
"""Magic, version, checksum of the recording, length from its own header, packed bytes, 32 bytes that only the earlier
version uses, last record."""
_READ_BYTES = 1 << 22
_CHECK = Struct("<I")
"""Checksum of the header, directly after it."""


@dataclass(frozen=True, slots=True)
class Packed:
    """The header of a packed recording."""

    path: Path
    is_earlier: bool
    """Whether it is of the earlier version, of which only the header is read."""
    checksum: int
    length: int
    """Number of records of telemetry, number of bytes of output."""
    packed_bytes: int
    last_record: bytes
    """The last telemetry record; zeros for output, and if there is none."""

    def recording(self) -> bytes:
        """Return the original recording, including its header.

        Raises:
            LogError: the file is damaged.
        """
        try:
            with open_regular(self.path) as handle:
                handle.seek(_HEADER.size + _CHECK.size)
                data = handle.read(self.packed_bytes + 1)
            if len(data) != self.packed_bytes:
                raise ValueError(f"{len(data)} bytes instead of {self.packed_bytes}")
            content = self._unfolded(data)
        # A header may claim more than memory holds.
        except (OSError, ValueError, MemoryError) as error:
            what = str(error) or "it claims to be too large"
            raise LogError(
                f"the packed recording is damaged: {what}", file=str(self.path)
            ) from error
        if zlib.crc32(content) != self.checksum:
            raise LogError(
                "the packed recording is damaged: its checksum is wrong", file=str(self.path)
            )
        return header(*_form(self.name), self.length) + content

    @property
    def name(self) -> str:
        """File name of the recording when it was not packed."""
        return self.path.name.removesuffix(PACKED_SUFFIX)

    def _unfolded(self, data: bytes) -> bytes:
        # Imported here and below: numpy is needed only for packed recordings.
        from tuisim.runs import packed_codec

        if self.name == OUTPUT_FILE:
            return packed_codec.unfold_rows(data)
        return packed_codec.unfold_ticks(data, self.length)


def find_packed(path: Path) -> Packed | None:
    """Return the packed form of the recording that was at `path`; None if there is none.

    Raises:
        LogError: the file is damaged, of another version, or not a packed recording.
    """
    packed = path.with_name(path.name + PACKED_SUFFIX)
    try:
        with open_regular(packed) as handle:
            head = handle.read(_HEADER.size + _CHECK.size)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(packed)) from error
    try:
        magic, version, checksum, length, size, last = _HEADER.unpack_from(head)
        (check,) = _CHECK.unpack_from(head, _HEADER.size)
    except StructError as error:
        raise LogError("too short to be a packed recording", file=str(packed)) from error
    if magic != PACKED_MAGIC[path.name]:
        raise LogError("not a packed recording", file=str(packed))
    if version not in (PACKED_VERSION, _EARLIER_VERSION):
        raise LogError(
            f"format version {version}, this tuisim reads {PACKED_VERSION}", file=str(packed)
        )
    if check != zlib.crc32(head[: _HEADER.size]):
        raise LogError("the packed recording is damaged: its header is corrupt", file=str(packed))
    return Packed(packed, version == _EARLIER_VERSION, checksum, length, size, last)


def earlier_forms(folder: Path) -> list[Packed]:
    """Return the recordings of a run that an earlier tuisim packed.

    Raises:
        LogError: a packed recording is damaged.
    """
    found = (find_packed(folder / name) for name in PACKED_MAGIC if not (folder / name).exists())
    return [packed for packed in found if packed is not None and packed.is_earlier]


def renew(folder: Path, again: Path) -> None:
    """Replace the recordings of a run that an earlier tuisim packed by those of a re-run, as far as they went.

    Args:
        folder: The folder of the run.
        again: That of the re-run, whose recordings are not packed.

    Raises:
        LogError: the re-run has other recordings, or they cannot be read or written.
    """
    try:
        contents = {
            packed.name: _same_recording(packed, again / packed.name)
            for packed in earlier_forms(folder)
        }
        for name, data in contents.items():
            _write(folder / name, data)
    except OSError as error:
        raise LogError(
            f"cannot be packed again: {error.strerror or error}", file=str(folder)
        ) from error


def _same_recording(packed: Packed, path: Path) -> bytes:
    """Return the recording in a file, cut off where a packed one ends, if it has the checksum of that."""
    magic, record_bytes = _form(packed.name)
    with open_regular(path) as handle:
        data = _recording(handle, path) or b""
    content = data[HEADER_BYTES : HEADER_BYTES + packed.length * max(1, record_bytes)]
    if zlib.crc32(content) != packed.checksum:
        message = "a re-run has another recording than this one, which an earlier tuisim packed and which stays"
        raise LogError(
            message,
            "the program, a file that it reads, or the mat may have changed",
            file=str(packed.path),
        )
    return header(magic, record_bytes, packed.length) + content


def compact(folder: Path) -> None:
    """Pack the recordings of a finished run, which no process writes any more; packed ones are left unchanged.

    Raises:
        LogError: a recording is damaged, or the folder cannot be written; nothing is lost.
    """
    for name in PACKED_MAGIC:
        path = folder / name
        try:
            _compact_file(path)
            sweep(folder, name + PACKED_SUFFIX)
        except OSError as error:
            raise LogError(
                f"cannot be packed: {error.strerror or error}", file=str(path)
            ) from error


def _compact_file(path: Path) -> None:
    try:
        with open_regular(path) as handle:
            data = _recording(handle, path)
    except FileNotFoundError:
        return
    if data is None:
        return
    _write(path, data)
    # Another process may have packed it in the meantime.
    path.unlink(missing_ok=True)


def _write(path: Path, data: bytes) -> None:
    """Write the packed form of the recording that is, or was, at a path."""
    packed = _packed(path, data)
    with replacing(
        path.with_name(path.name + PACKED_SUFFIX), owner_only=True, follow_links=False
    ) as handle:
        handle.write(packed)


def _recording(handle: BinaryIO, path: Path) -> bytes | None:
    """Return a recording with its header; None for one that cannot be packed because a part of it is missing."""
    magic, record_bytes = _form(path.name)
    found = bytearray(handle.read(HEADER_BYTES))
    end = HEADER_BYTES + published_length(bytes(found), magic, str(path)) * max(1, record_bytes)
    while len(found) < end:
        part = handle.read(min(_READ_BYTES, end - len(found)))
        if not part or (len(part) == _READ_BYTES and is_hole(part)):
            return None
        found += part
    return bytes(found)


def _packed(path: Path, data: bytes) -> bytes:
    """Return the bytes of the packed file."""
    from tuisim.runs import packed_codec

    content = data[HEADER_BYTES:]
    length = published_length(data, _form(path.name)[0], str(path))
    last = bytes(TICK_RECORD.size)
    if path.name == TELEMETRY_FILE:
        folded = packed_codec.fold_ticks(content)
        back = packed_codec.unfold_ticks(folded, length)
        last = content[-TICK_RECORD.size :] or last
    else:
        try:
            folded = packed_codec.fold_rows(content)
        except ValueError as error:
            raise LogError(str(error), file=str(path)) from error
        back = packed_codec.unfold_rows(folded)
    if back != content:
        raise LogError("cannot be packed without loss", file=str(path))
    head = _HEADER.pack(
        PACKED_MAGIC[path.name], PACKED_VERSION, zlib.crc32(content), length, len(folded), last
    )
    return head + _CHECK.pack(zlib.crc32(head)) + folded


def _form(name: str) -> tuple[bytes, int]:
    """Return magic and record size of a recording."""
    return (TELEMETRY_MAGIC, TICK_RECORD.size) if name == TELEMETRY_FILE else (OUTPUT_MAGIC, 0)
