"""Compressed text, unpacked as far as it goes."""

from __future__ import annotations

import bz2
import lzma
import zlib
from collections.abc import Callable, Mapping
from typing import Any, Protocol

import pyarrow as pa

from tuisim.datalog.opening.lines import BLOCK_BYTES
from tuisim.datalog.opening.notes import Notes
from tuisim.errors import LogError


class Readable(Protocol):
    """Bytes that come one after the other."""

    def read(self, count: int, /) -> bytes | None:
        """Return at most so many more bytes, none at the end."""


class _Decompressor(Protocol):
    """What `bz2` and `lzma` have in common."""

    @property
    def eof(self) -> bool: ...
    @property
    def needs_input(self) -> bool: ...
    @property
    def unused_data(self) -> bytes: ...
    def decompress(self, data: bytes, max_length: int = -1) -> bytes: ...


class _Gzip:
    """`zlib`'s decompressor with the names of the other two."""

    _BITS = 31
    """A gzip header and trailer, and the largest window."""

    def __init__(self) -> None:
        self._inner = zlib.decompressobj(self._BITS)

    @property
    def eof(self) -> bool:
        return self._inner.eof

    @property
    def needs_input(self) -> bool:
        return not self._inner.unconsumed_tail

    @property
    def unused_data(self) -> bytes:
        return self._inner.unused_data

    def decompress(self, data: bytes, max_length: int = -1) -> bytes:
        return self._inner.decompress(self._inner.unconsumed_tail + data, max(max_length, 0))


_ERRORS = (zlib.error, OSError, EOFError, lzma.LZMAError, pa.ArrowException)

_FORMATS: Mapping[bytes, Callable[[], _Decompressor]] = {
    b"\x1f\x8b": _Gzip,
    b"BZh": bz2.BZ2Decompressor,
    b"\xfd7zXZ\0": lzma.LZMADecompressor,
}
_ARROW_CODECS = {b"\x28\xb5\x2f\xfd": "zstd", b"\x04\x22\x4d\x18": "lz4"}
_REFUSED = {
    b"PK\x03\x04": "a ZIP archive, as a spreadsheet is, too",
    b"7z\xbc\xaf\x27\x1c": "a 7-Zip archive",
    b"\xd0\xcf\x11\xe0": "an old Excel workbook",
    b"\x89HDF": "an HDF5 file",
    b"SQLite format 3": "an SQLite database",
    b"\x1f\x9d": "a file of the old compress",
}
"""By their first bytes: files that hold no text and that nothing here reads."""

MAGICS = (*_FORMATS, *_ARROW_CODECS, *_REFUSED)
"""First bytes of everything that is known here."""
MAGIC_BYTES = max(map(len, MAGICS))


def unpacked(title: str, head: bytes, handle: Any, notes: Notes) -> Readable | None:
    """Return the text in a compressed file, None if it is not compressed.

    Args:
        title: Name of the file.
        head: Its first `MAGIC_BYTES` bytes.
        handle: The file, open at its beginning.
        notes: What was wrong.

    Raises:
        LogError: it holds no text, or text in a form that is not read.
    """
    refused = next((what for magic, what in _REFUSED.items() if head.startswith(magic)), "")
    if refused:
        raise LogError(f"is {refused}, which cannot be read", "a log is CSV, Parquet, JSONL, Arrow or text", file=title)
    make = next((make for magic, make in _FORMATS.items() if head.startswith(magic)), None)
    if make is not None:
        return _Unpacked(handle, make, notes)
    codec = next((codec for magic, codec in _ARROW_CODECS.items() if head.startswith(magic)), "")
    return _ArrowUnpacked(handle, codec, notes) if codec else None


class _Unpacked:
    """A compressed file, read as far as it goes; parts that were compressed apart may stand one behind the other.

    Args:
        handle: The compressed bytes.
        make: Makes a decompressor.
        notes: What was wrong.
    """

    def __init__(self, handle: Readable, make: Callable[[], _Decompressor], notes: Notes) -> None:
        self._handle, self._make, self._notes = handle, make, notes
        self._inner = make()

    def read(self, count: int, /) -> bytes:
        """Return some more bytes, none at the end."""
        while True:
            packed = b""
            if self._inner.eof:
                packed = self._inner.unused_data or self._handle.read(BLOCK_BYTES) or b""
                self._inner = self._make()
                if not packed.strip(b"\0"):
                    return b""
            elif self._inner.needs_input:
                packed = self._handle.read(BLOCK_BYTES) or b""
                if not packed:
                    return self._cut_off()
            try:
                data = self._inner.decompress(packed, count)
            except _ERRORS:
                return self._cut_off()
            if data:
                return data

    def _cut_off(self) -> bytes:
        self._notes.say(_CUT_OFF)
        return b""


class _ArrowUnpacked:
    """A file in one of the forms that only Arrow unpacks, read as far as it goes.

    Args:
        handle: The compressed bytes.
        codec: Name of the form.
        notes: What was wrong.
    """

    def __init__(self, handle: Any, codec: str, notes: Notes) -> None:
        self._stream = pa.CompressedInputStream(pa.PythonFile(handle, "r"), codec)
        self._notes = notes

    def read(self, count: int, /) -> bytes:
        """Return some more bytes, none at the end."""
        try:
            return bytes(self._stream.read(count))
        except _ERRORS:
            self._notes.say(_CUT_OFF)
            return b""


_CUT_OFF = "the compressed file was cut off or is damaged: read as far as it goes"
