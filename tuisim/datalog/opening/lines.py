"""Text as it comes in, cut into blocks of whole lines in UTF-8."""

from __future__ import annotations

import codecs
from collections.abc import Iterator
from dataclasses import dataclass

from tuisim.datalog.opening.notes import Notes

BLOCK_BYTES = 4 << 20
"""About how much is read and parsed at once."""

MAX_LINE_BYTES = 1 << 20
"""A longer line is no row of a log."""

_BOMS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))


@dataclass(frozen=True, slots=True)
class Block:
    """Some whole lines."""

    first_row: int
    """Row of the first line in the file, from 1."""
    text: bytes
    """UTF-8, each line with its newline."""
    newline: str = "\n"
    """What ends the lines in the file, where it is one character: all else is read as this in `text`."""

    def lines(self) -> Iterator[tuple[int, str]]:
        """Yield each line that is not blank, with its row."""
        for row, line in enumerate(self.text.decode("utf-8").split("\n"), self.first_row):
            if line and not line.isspace():
                yield row, line.rstrip("\r")


class LineCutter:
    """Cuts bytes into blocks of whole lines.

    Args:
        notes: Where it says what was wrong.
    """

    def __init__(self, notes: Notes) -> None:
        self._notes = notes
        self._rest = b""
        self._row = 1
        self._decoder: codecs.IncrementalDecoder | None = None
        self._started = False
        self._newline = "\n"
        self._dropping = False
        """Whether the line at hand is too long, so that its rest is passed over."""

    def feed(self, data: bytes) -> Block | None:
        """Take more bytes; return the lines that are whole now, if any."""
        if not self._started and data:
            self._started = True
            data = self._begin(data)
            self._newline = "\r" if b"\r" in data and b"\n" not in data else "\n"
        if self._decoder is not None:
            data = self._decoder.decode(data).encode()
        if b"\0" in data:
            self._notes.say("null bytes were left out")
            data = data.replace(b"\0", b"")
        if b"\r" in data:
            # Also a carriage return alone ends a line; one at the very end may have its newline still to come.
            held = data.endswith(b"\r")
            data = data.replace(b"\r\n", b"\n")
            data = data[:-1].replace(b"\r", b"\n") + b"\r" if held and data else data.replace(b"\r", b"\n")
        if self._rest.endswith(b"\r") and data:
            self._rest = self._rest[:-1] + (b"" if data.startswith(b"\n") else b"\n")
        end = data.rfind(b"\n") + 1
        if not end:
            self._keep(data)
            return None
        # Blocks are large: each is copied only once.
        text, self._rest, rest = b"".join((self._rest, memoryview(data)[:end])), b"", data[end:]
        if self._dropping:
            text = text.partition(b"\n")[2]
            self._dropping = False
            self._row += 1
        self._keep(rest)
        return self._block(text) if text else None

    def finish(self) -> Block | None:
        """Return the last line, if it has no newline."""
        text, self._rest = self._rest.rstrip(b"\r"), b""
        if self._dropping or not text:
            return None
        return self._block(text + b"\n")

    def _begin(self, data: bytes) -> bytes:
        for mark, encoding in _BOMS:
            if data.startswith(mark):
                if encoding != "utf-8":
                    self._decoder = codecs.getincrementaldecoder(encoding)("replace")
                return data[len(mark) :]
        head = data[:2000]
        for odd, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
            # Text in two bytes a character without a mark: every second one is null.
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
        if len(self._rest) > MAX_LINE_BYTES:
            self._notes.add(f"lines longer than {MAX_LINE_BYTES >> 20} MiB were left out", [self._row])
            self._rest, self._dropping = b"", True

    def _block(self, text: bytes) -> Block:
        first = self._row
        self._row += text.count(b"\n")
        try:
            if not text.isascii():
                text.decode("utf-8")
        except UnicodeDecodeError:
            self._notes.say("not UTF-8: read as Windows-1252")
            text = text.decode("cp1252", "replace").encode()
        return Block(first, text, self._newline)
