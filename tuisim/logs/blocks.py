"""Text input, plain or compressed, cut into blocks of whole lines."""

from __future__ import annotations

import codecs
import io
import re
from collections.abc import Iterator
from typing import Any, Protocol

import pyarrow as pa

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.logs.warnings import Notes

BLOCK_BYTES = 4 << 20
"""Bytes of a file that are read and parsed at a time."""

MAX_LINE_BYTES = 1 << 20
MAX_DOCUMENT_BYTES = 64 << 20
"""Largest size of a JSON document that is read as a whole, as it may be a single line; a larger one is an error."""

_UTF_8 = "utf-8-sig"
_GUESSES = {"cp1252": "Windows-1252", "gbk": "GBK", "shift_jis": "Shift-JIS"}
"""Python's names of the encodings, one of which is guessed if a text is not UTF-8, with the names for messages."""
_find_high_bytes = re.compile(rb"[\x80-\xff]").findall
_find_kanji_bytes = re.compile(rb"[\x81-\x9f]").findall
_IN_WORDS = re.compile(rb"[a-z][\x92\xa0-\xff]{1,2}|[\x92\xa0-\xff]{1,2}[a-z]")
"""Matches one or two bytes of western letters above ASCII beside a letter from a to z, as in words."""


_find_control_characters = re.compile(r"[\x01-\x08\x0e-\x1a\x1c-\x1f\x7f]").findall
_MAX_CONTROL_CHARACTERS = 8
_CONTROL_OF_TEXT = 0.04
"""A file is no text if more than this fraction of its characters, and more than `_MAX_CONTROL_CHARACTERS`, are control
characters: of random bytes, 0.11 are.
"""
_JUDGED_CHARACTERS = 20_000
"""Number of characters at the beginning of a file by which it is decided whether the file is a text."""
_KINDS = "a log is CSV, Parquet, JSONL, Arrow or text"

_COLOURS = re.compile(r"\x1b\[[\d;]*m")
"""Matches an escape sequence by which a program colours its output in a terminal."""


@dataclass(frozen=True, slots=True)
class Block:
    """Consecutive whole lines of a text file."""

    first_row: int
    """Number, from 1, of the block's first line in the file."""
    text: str
    """The lines of the block, each with its newline."""

    def lines(self) -> Iterator[tuple[int, str]]:
        """Yield each line that is not blank, with its row in the file."""
        for row, line in enumerate(self.text.split("\n"), self.first_row):
            if line and not line.isspace():
                yield row, line


class LineCutter:
    """Decodes the bytes of a text file, and cuts the text into blocks of whole lines.

    Args:
        longest: Characters of the longest line that is allowed.
        encoding: Python's name of the text's encoding; empty to find the encoding.

    Raises:
        LogError: Python has no encoding of that name.
    """

    def __init__(self, notes: Notes, longest: int = MAX_LINE_BYTES, encoding: str = "") -> None:
        self._notes = notes
        self._longest = longest
        self._rest = ""
        self._row = 1
        self._newlines = io.IncrementalNewlineDecoder(None, translate=True)
        self._is_known = encoding != ""
        """Whether the encoding is chosen or guessed already, so that bytes which do not fit are replaced, and nothing
        is guessed any more.
        """
        encoding = encoding or _UTF_8
        try:
            # This raises for Python's codecs that are not for text, such as hex and rot13.
            b"0".decode(encoding, "replace")
            self._choose(encoding)
        except (LookupError, ValueError) as error:
            hint = "one of Python's, such as utf-8, cp1252, gbk, shift_jis"
            raise LogError(f"no encoding {encoding!r}", hint) from error

    def feed(self, data: bytes) -> Block | None:
        """Decode further bytes of the file; return the lines that are complete now, or None if there are none.

        The first block has two lines if the text has them: from a single line one cannot tell a heading from a row.

        Args:
            data: The bytes; empty at the end of the file.

        Raises:
            LogError: a line is too long.
        """
        text = self._rest + self._newlines.decode(self._decode(data), final=not data)
        end = text.rfind("\n") + 1
        if not data:
            text = text and text.removesuffix("\n") + "\n"
            end = len(text)
        elif self._row == 1 and "\n" not in text[:end].strip():
            end = 0
        self._rest = text[end:]
        if len(self._rest) > self._longest:
            row = self._row + text.count("\n", 0, end)
            raise LogError(
                f"line {row} is longer than {self._longest >> 20} MiB",
                "a log has a row in each line",
            )
        if not end:
            return None
        lines = text[:end]
        if "\0" in lines:
            self._notes.say("null bytes were skipped")
            lines = lines.replace("\0", "")
        if "\x1b" in lines:
            lines = _COLOURS.sub("", lines)
        if self._row == 1:
            _refuse_control_characters(lines[:_JUDGED_CHARACTERS])
        block = Block(self._row, lines)
        self._row += block.text.count("\n")
        return block

    def _decode(self, data: bytes) -> str:
        if not self._is_known and self._row == 1 and not self._rest:
            self._find_utf_16(data)
        try:
            return self._decoder.decode(data, final=not data)
        except UnicodeDecodeError:
            return self._guess(self._decoder.getstate()[0] + data)

    def _find_utf_16(self, data: bytes) -> None:
        """If the first bytes of the text show that it is UTF-16, choose that encoding."""
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            self._choose("utf-16")
            return
        head = data[:2000]
        for odd, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
            # UTF-16 without a byte order mark: every second byte is null.
            nulls = head[odd::2].count(0)
            if nulls > 0.4 * len(head[odd::2]) and len(head) > 3 and 0 not in head[1 - odd :: 2]:
                self._notes.say(f"read as {encoding.upper()}")
                self._choose(encoding)

    def _choose(self, encoding: str) -> None:
        self._is_known |= encoding != _UTF_8
        self._decoder = codecs.getincrementaldecoder(encoding)(
            "replace" if self._is_known else "strict"
        )

    def _guess(self, data: bytes) -> str:
        """Choose an encoding for a text that is not UTF-8; return the text of some bytes in that encoding."""
        encoding = _guess_encoding(data)
        self._notes.say(f"not UTF-8: read as {_GUESSES[encoding]} (--encoding selects another)")
        self._choose(encoding)
        return self._decoder.decode(data)


def _refuse_control_characters(text: str) -> None:
    """Check that the beginning of a file is a text.

    Raises:
        LogError: too many of its characters are control characters.
    """
    count = len(_find_control_characters(text))
    if count > max(_MAX_CONTROL_CHARACTERS, _CONTROL_OF_TEXT * len(text)):
        raise LogError("is not a text, and of no format that can be read", _KINDS)


def _guess_encoding(data: bytes) -> str:
    """Return one of `_GUESSES` for bytes that are not UTF-8."""
    rest = _IN_WORDS.sub(b"", data)
    high_bytes = _find_high_bytes(rest)
    if 2 * len(high_bytes) >= len(_find_high_bytes(data)):
        # Most kanji of Shift-JIS begin with such a byte, and Chinese in GB 2312 has none.
        if 4 * len(_find_kanji_bytes(rest)) >= len(high_bytes) and _can_decode(data, "shift_jis"):
            return "shift_jis"
        if _can_decode(data, "gb2312"):
            return "gbk"
    return next((name for name in _GUESSES if _can_decode(data, name)), "cp1252")


def _can_decode(data: bytes, encoding: str) -> bool:
    try:
        codecs.getincrementaldecoder(encoding)().decode(data)
    except UnicodeDecodeError:
        return False
    return True


class Readable(Protocol):
    """A stream from which bytes can be read."""

    def read(self, count: int, /) -> bytes | None:
        """Return up to `count` bytes; empty bytes at the end, and None if the stream has none at the moment."""


_UNPACKED_BYTES = 1 << 12
"""Bytes that are unpacked at a time; up to this number are lost before the place where a compressed file is damaged."""
_CUT_OFF = "the compressed file is truncated or damaged: only the readable part was read"

_CODECS = {b"\x1f\x8b": "gzip", b"BZh": "bz2", b"\x28\xb5\x2f\xfd": "zstd"}
"""Arrow's names of the compressed formats that can be read, by the first bytes of a file."""
_REFUSED = {
    b"PK\x03\x04": "a ZIP archive or a spreadsheet",
    b"7z\xbc\xaf\x27\x1c": "a 7-Zip archive",
    b"\xfd7zXZ\0": "an xz file",
    b"\x04\x22\x4d\x18": "an lz4 file",
    b"\xd0\xcf\x11\xe0": "an old Excel workbook",
    b"\x89HDF": "an HDF5 file",
    b"SQLite format 3": "an SQLite database",
    b"\x1f\x9d": "a compress (.Z) file",
    b"#separator \\x": "a Zeek log",
    b"\x89PNG": "a PNG picture",
    b"\xff\xd8\xff": "a JPEG picture",
    b"GIF8": "a GIF picture",
    b"II*\0": "a TIFF picture",
    b"MM\0*": "a TIFF picture",
    b"RIFF": "a sound or a picture",
    b"OggS": "a sound",
    b"%PDF-": "a PDF document",
    b"\x7fELF": "a program",
}
"""Formats of files that tuisim refuses to read, in words, by their first bytes."""

MAGICS = (*_CODECS, *_REFUSED)
"""First bytes of all formats that are recognised here: the compressed ones, and those that cannot be read."""
MAGIC_BYTES = max(map(len, MAGICS))


def unpack(head: bytes, handle: Any, notes: Notes) -> Readable | None:
    """Return a stream of the unpacked contents of a compressed file; None if it is not compressed.

    Args:
        head: The first `MAGIC_BYTES` bytes of the file.
        handle: The file, open at its beginning.
        notes: Receives a note if the file is damaged.

    Raises:
        LogError: the format cannot be read.
    """
    refused = next((what for magic, what in _REFUSED.items() if head.startswith(magic)), "")
    if refused:
        raise LogError(
            f"is {refused}, which cannot be read",
            _KINDS,
        )
    codec = next((codec for magic, codec in _CODECS.items() if head.startswith(magic)), "")
    return _Unpacked(handle, codec, notes) if codec else None


class _Unpacked:
    """A stream of the contents of a compressed file, which ends where the file is damaged."""

    def __init__(self, handle: Any, codec: str, notes: Notes) -> None:
        self._notes = notes
        self._stream = pa.CompressedInputStream(pa.PythonFile(handle, "r"), codec)

    def read(self, count: int, /) -> bytes:
        """Return up to `count` bytes; empty bytes at the end, or where the file is damaged or cut off."""
        parts = []
        try:
            while count > 0 and (part := self._stream.read(min(count, _UNPACKED_BYTES))):
                parts.append(part)
                count -= len(part)
        except (OSError, pa.ArrowException):
            self._notes.say(_CUT_OFF)
        return b"".join(parts)
