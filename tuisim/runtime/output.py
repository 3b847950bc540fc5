"""Writes what the program prints to the run folder, line by line."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

from tuisim.runs.records import MAX_OUTPUT_BYTES, OutputWriter, Stream


class Output:
    """Rows of output, each with the time, tick and source line that wrote it."""

    writer: OutputWriter
    """The file; set before the first row."""

    def __init__(self) -> None:
        self.place: Callable[[], tuple[int, int, int]] = lambda: (0, 0, 0)
        """Returns tick, simulated ns and source line; set once the session exists."""
        self.after_write: Callable[[], None] = lambda: None
        self.watch: Callable[[str, Stream], None] | None = None
        """If set, called with text and stream of each written row."""

    def row(self, text: str, stream: Stream) -> None:
        """Write one row."""
        tick, now, line = self.place()
        self.writer.write(text.encode("utf-8", "backslashreplace"), tick, now, line, stream)
        if self.watch is not None:
            self.watch(text, stream)

    def row_at(self, text: str, stream: Stream, tick: int, time_ns: int, line: int) -> None:
        """Write one row that belongs to a tick, not to a time between two."""
        self.writer.write(text.encode(), tick, time_ns, line, stream)

    def close(self) -> None:
        """Close the file and truncate it to its size."""
        self.writer.close()


class LineStream(io.TextIOBase):
    """`sys.stdout` or `sys.stderr` of the program.

    Args:
        output: Receives whole lines.
        stream: `Stream.STDOUT` or `Stream.STDERR`.
    """

    encoding = "utf-8"
    errors = "backslashreplace"

    def __init__(self, output: Output, stream: Stream = Stream.STDOUT) -> None:
        self._output, self._stream = output, stream
        self._part = io.StringIO()
        """Text without a newline yet; a line may be the result of any number of prints."""

    @property
    def name(self) -> str:
        """Name of the real stream."""
        return "<stdout>" if self._stream == Stream.STDOUT else "<stderr>"

    @property
    def buffer(self) -> ByteStream:
        """Binary stream, for programs that write bytes."""
        return ByteStream(self)

    def reconfigure(self, **_settings: object) -> None:
        """Do nothing: lines are always written at once and in UTF-8."""

    def writable(self) -> bool:
        """Return True."""
        return True

    def write(self, text: str) -> int:
        """Write text; whole lines are recorded at once."""
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        if "\n" not in text:
            self._part.write(text)
            if self._part.tell() > MAX_OUTPUT_BYTES:
                # More than the file accepts anyway: write it before it fills the memory.
                self.finish()
            return len(text)
        # Taken first: if writing a row ends the program, nothing is written twice.
        *lines, rest = (self.take_part() + text).split("\n")
        self._part.write(rest)
        for line in lines:
            self._output.row(line, self._stream)
        self._output.after_write()
        return len(text)

    def flush(self) -> None:
        """Do nothing: whole lines are written already, and a partial line waits for its end."""

    def finish(self) -> None:
        """Write the partial line."""
        if part := self.take_part():
            self._output.row(part, self._stream)

    def take_part(self) -> str:
        """Return the partial line and clear it."""
        part, self._part = self._part.getvalue(), io.StringIO()
        return part


class ByteStream(io.RawIOBase):
    """The binary stream below a line stream.

    Args:
        stream: Receives the text.
    """

    def __init__(self, stream: LineStream) -> None:
        self._stream = stream

    def writable(self) -> bool:
        """Return True."""
        return True

    def write(self, data: Any) -> int:
        """Write bytes, decoded as UTF-8."""
        taken = bytes(data)
        self._stream.write(taken.decode("utf-8", "replace"))
        return len(taken)
