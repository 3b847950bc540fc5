"""Text input, plain or compressed, cut into blocks of whole lines in UTF-8."""

from __future__ import annotations

import bz2
import codecs
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from gzip import GzipFile
from typing import Any, Protocol

import pyarrow as pa

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.logs.warnings import Notes

BLOCK_BYTES = 4 << 20
"""Bytes that are read and parsed at a time."""

MAX_LINE_BYTES = 1 << 20
"""Longer lines are left out."""
MAX_DOCUMENT_BYTES = 64 << 20
"""Larger JSON documents, which may be a single line, are not read as a whole."""

_BOMS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)

_GUESSES = {"cp1252": "Windows-1252", "gbk": "GBK", "shift_jis": "Shift-JIS"}
"""Encodings that are tried in this order if a text is not UTF-8, with their names."""


@dataclass(frozen=True, slots=True)
class Block:
    """Whole lines of a file that follow each other."""

    first_row: int
    """Row of the first line in the file, from 1."""
    text: bytes
    """UTF-8, each line with its newline."""
    newline: str = "\n"
    """Line ending of the file, if it is a single character; `text` always has line feeds."""

    def lines(self) -> Iterator[tuple[int, str]]:
        """Yield each line that is not blank, with its row."""
        for row, line in enumerate(self.text.decode("utf-8").split("\n"), self.first_row):
            if line and not line.isspace():
                yield row, line.rstrip("\r")

    def join_next(self, block: Block | None) -> Block:
        """Return this block with the lines of the next one."""
        return self if block is None else replace(self, text=self.text + block.text)


class LineCutter:
    """Cuts bytes into blocks of whole lines.

    Args:
        longest: Bytes of the longest line; longer ones are left out.
        encoding: Name of the text's encoding as Python knows it; empty to find it.

    Raises:
        LogError: there is no such encoding.
    """

    def __init__(self, notes: Notes, longest: int = MAX_LINE_BYTES, encoding: str = "") -> None:
        self._notes = notes
        self._longest = longest
        self._encoding = encoding
        self._rest = b""
        self._row = 1
        self._decoder: codecs.IncrementalDecoder | None = None
        if encoding:
            try:
                # Python knows more codecs than those of text: hex, rot13, undefined.
                b"0".decode(encoding, "replace")
                self._decoder = codecs.getincrementaldecoder(encoding)("replace")
            except (LookupError, ValueError) as error:
                hint = "one of Python's, such as utf-8, cp1252, gbk, shift_jis"
                raise LogError(f"no encoding {encoding!r}", hint) from error
        self._started = False
        self._newline = "\n"
        self._dropping = False
        """Whether the current line is too long, so that the rest of it is skipped."""

    def feed(self, data: bytes) -> Block | None:
        """Add bytes; return the lines that are complete now, if any."""
        if not self._started and data:
            self._started = True
            data = self._begin(data)
            self._newline = "\r" if b"\r" in data and b"\n" not in data else "\n"
        if self._decoder is not None:
            data = self._decoder.decode(data).encode()
        if b"\0" in data:
            self._notes.say("null bytes were skipped")
            data = data.replace(b"\0", b"")
        if b"\r" in data:
            # A carriage return alone ends a line, too; the line feed of one at the very end may still follow.
            carried_cr = data.endswith(b"\r")
            data = data.replace(b"\r\n", b"\n")
            data = (
                data[:-1].replace(b"\r", b"\n") + b"\r"
                if carried_cr and data
                else data.replace(b"\r", b"\n")
            )
        if self._rest.endswith(b"\r") and data:
            self._rest = self._rest[:-1] + (b"" if data.startswith(b"\n") else b"\n")
        end = data.rfind(b"\n") + 1
        if not end:
            self._keep(data)
            return None
        # Blocks are large: each is copied only once.
        text = b"".join((self._rest, memoryview(data)[:end]))
        self._rest = b""
        rest = data[end:]
        if self._dropping:
            text = text.partition(b"\n")[2]
            self._dropping = False
            self._row += 1
        self._keep(rest)
        return self._block(text) if text else None

    def finish(self) -> Block | None:
        """Return the last line, if it has no newline."""
        text = self._rest.rstrip(b"\r")
        self._rest = b""
        if self._dropping or not text:
            return None
        return self._block(text + b"\n")

    def _begin(self, data: bytes) -> bytes:
        if self._encoding:
            return data
        for mark, encoding in _BOMS:
            if data.startswith(mark):
                if encoding != "utf-8":
                    self._decoder = codecs.getincrementaldecoder(encoding)("replace")
                return data[len(mark) :]
        head = data[:2000]
        for odd, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
            # UTF-16 without a byte order mark: every second byte is null.
            if (
                len(head) > 3
                and head[odd::2].count(0) > 0.4 * len(head[odd::2]) > 0
                and not head[1 - odd :: 2].count(0)
            ):
                self._notes.say(f"read as {encoding.upper()}")
                self._decoder = codecs.getincrementaldecoder(encoding)("replace")
        return data

    def _keep(self, rest: bytes) -> None:
        if self._dropping:
            return
        self._rest += rest
        if len(self._rest) > self._longest:
            limit = f"longer than {self._longest >> 20} MiB"
            self._notes.add(f"line {limit} was skipped", f"lines {limit} were skipped", [self._row])
            self._rest = b""
            self._dropping = True

    def _block(self, text: bytes) -> Block:
        first = self._row
        self._row += text.count(b"\n")
        try:
            if not text.isascii():
                text.decode("utf-8")
        except UnicodeDecodeError:
            text = self._guess_text(text).encode()
        return Block(first, text, self._newline)

    def _guess_text(self, text: bytes) -> str:
        """Return a text that is not UTF-8, decoded; the rest of the file is read in the encoding found first."""
        guesses = {self._encoding: ""} if self._encoding else _GUESSES
        for encoding in guesses:
            try:
                decoded = text.decode(encoding)
            except UnicodeDecodeError:
                continue
            break
        else:
            encoding = next(iter(guesses))
            decoded = text.decode(encoding, "replace")
        if not self._encoding:
            self._encoding = encoding
            self._notes.say(f"not UTF-8: read as {_GUESSES[encoding]} (--encoding selects another)")
        return decoded


class Readable(Protocol):
    """A stream of bytes."""

    def read(self, count: int, /) -> bytes | None:
        """Return up to `count` bytes, none at the end."""


_UNPACKED_BYTES = 1 << 18
"""Unpacked at once."""
_CUT_OFF = "the compressed file is truncated or damaged: only the readable part was read"

_ERRORS = (zlib.error, OSError, EOFError, pa.ArrowException)

_FORMATS: Mapping[bytes, Callable[[Any], Any]] = {
    b"\x1f\x8b": lambda handle: GzipFile(fileobj=handle),
    b"BZh": bz2.BZ2File,
    b"\x28\xb5\x2f\xfd": lambda handle: pa.CompressedInputStream(
        pa.PythonFile(handle, "r"), "zstd"
    ),
    b"\x04\x22\x4d\x18": lambda handle: pa.CompressedInputStream(pa.PythonFile(handle, "r"), "lz4"),
}
"""Functions that open compressed files, by the first bytes of their formats."""
_REFUSED = {
    b"PK\x03\x04": "a ZIP archive or a spreadsheet",
    b"7z\xbc\xaf\x27\x1c": "a 7-Zip archive",
    b"\xfd7zXZ\0": "an xz file",
    b"\xd0\xcf\x11\xe0": "an old Excel workbook",
    b"\x89HDF": "an HDF5 file",
    b"SQLite format 3": "an SQLite database",
    b"\x1f\x9d": "a compress (.Z) file",
}
"""Formats that cannot be read, by their first bytes."""

MAGICS = (*_FORMATS, *_REFUSED)
"""First bytes of all known formats."""
MAGIC_BYTES = max(map(len, MAGICS))


def unpack(head: bytes, handle: Any, notes: Notes) -> Readable | None:
    """Return the text in a compressed file, to be read; None if it is not compressed.

    Args:
        head: The first `MAGIC_BYTES` bytes of the file.
        handle: The file, open at its beginning.

    Raises:
        LogError: the format cannot be read.
    """
    refused = next((what for magic, what in _REFUSED.items() if head.startswith(magic)), "")
    if refused:
        raise LogError(
            f"is {refused}, which cannot be read",
            "a log is CSV, Parquet, JSONL, Arrow or text",
        )
    open_file = next((opener for magic, opener in _FORMATS.items() if head.startswith(magic)), None)
    return None if open_file is None else _Unpacked(open_file(handle), notes)


class _Unpacked:
    """A compressed file, read as far as it is intact.

    Args:
        file: The open file, which unpacks; reading raises one of `_ERRORS` where it is damaged or cut off.
    """

    def __init__(self, file: Any, notes: Notes) -> None:
        self._notes = notes
        # `read` of Python's files would lose what was unpacked before an error.
        self._unpack: Callable[[int], bytes] = getattr(file, "read1", file.read)

    def read(self, count: int, /) -> bytes:
        """Return up to `count` bytes, none at the end."""
        parts: list[bytes] = []
        while count > 0 and (part := self._read_part(min(count, _UNPACKED_BYTES))):
            parts.append(part)
            count -= len(part)
        return b"".join(parts)

    def _read_part(self, count: int) -> bytes:
        try:
            return bytes(self._unpack(count))
        except _ERRORS:
            self._notes.say(_CUT_OFF)
            self._unpack = lambda _: b""
            return b""
