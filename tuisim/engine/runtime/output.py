"""Writes what the program prints to the run folder, line by line."""

from __future__ import annotations

import codecs
import io
from collections.abc import Callable, Mapping
from typing import Any

from tuisim.engine.runs.records import MAX_OUTPUT_BYTES, TEXT_STREAMS, OutputWriter, Stream
from tuisim.engine.runtime.addresses import Addresses


class OutputRecorder:
    """Writes rows of output, each with the time, the tick and the source line that wrote it."""

    writer: OutputWriter
    """The file; set before the first row."""

    def __init__(self) -> None:
        self.place: Callable[[], tuple[int, int, int]] = lambda: (0, 0, 0)
        """Returns tick, simulated ns and source line; set once the session exists."""
        self.after_write: Callable[[], None] = lambda: None
        self.drain: Callable[[], None] = lambda: None
        """Writes first what was written below Python's streams."""
        self.watch: Callable[[str, Stream], None] | None = None
        """If set, called with text and stream of each written row."""
        self.names: Callable[[], Mapping[str, object]] = dict
        """Returns the program's global names; set once there is a program."""
        self._addresses = Addresses(lambda: self.names())

    def row(self, text: str, stream: Stream) -> None:
        """Write one row."""
        self.drain()
        tick, now, line = self.place()
        if (" at 0x" in text or ", st" in text) and stream in TEXT_STREAMS:
            # A quick check: most rows have no address.
            (text,) = self.stabilize(text)
        self.writer.write(text.encode("utf-8", "backslashreplace"), tick, now, line, stream)
        if self.watch is not None:
            self.watch(text, stream)

    def stabilize(self, *texts: str) -> tuple[str, ...]:
        """Return texts of one instant with addresses that are the same in every run."""
        return self._addresses.stabilize(*texts)

    def write_row(self, text: str, stream: Stream, tick: int, time_ns: int, line: int) -> None:
        """Write one row with a given tick, time and source line, not with the present ones."""
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
    mode = "w"
    line_buffering = True
    write_through = False

    def __init__(self, output: OutputRecorder, stream: Stream = Stream.STDOUT) -> None:
        self._output = output
        self._stream = stream
        self._part = io.StringIO()
        """Text without a newline yet; a line may be the result of any number of prints."""
        self._buffer = ByteStream(self)
        self._is_detached = False

    @property
    def name(self) -> str:
        """Name of the real stream."""
        return "<stdout>" if self._stream == Stream.STDOUT else "<stderr>"

    @property
    def buffer(self) -> ByteStream:
        """Binary stream, for programs that write bytes."""
        return self._buffer

    def __repr__(self) -> str:
        return f"<_io.TextIOWrapper name={self.name!r} mode='w' encoding='utf-8'>"

    def reconfigure(self, **_settings: object) -> None:
        """Do nothing: lines are always written at once and in UTF-8."""

    def fileno(self) -> int:
        """Return the descriptor that C writes to."""
        return int(self._stream)

    def writable(self) -> bool:
        """Return True."""
        return True

    def detach(self) -> Any:
        """Return the binary stream; this one is unusable afterwards."""
        self._is_detached = True
        return self._buffer

    def write(self, text: str) -> int:
        """Write text; whole lines are recorded at once."""
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        if self._is_detached:
            raise ValueError("underlying buffer has been detached")
        if self.closed:
            raise ValueError("I/O operation on closed file.")
        return self.put(text)

    def put(self, text: str) -> int:
        """Write text, even if the program has closed the stream."""
        self._output.drain()
        if "\n" not in text:
            self._part.write(text)
            if self._part.tell() > MAX_OUTPUT_BYTES:
                # The partial line is longer than the file accepts: write it before it fills the memory.
                self.finish()
            return len(text)
        # Taken first: if writing a row ends the program, nothing is written twice.
        *lines, rest = (self.take_part() + text).split("\n")
        self._part.write(rest)
        for line in lines:
            self._output.row(line, self._stream)
        self._output.after_write()
        return len(text)

    def put_bytes(self, data: bytes) -> None:
        """Write bytes, decoded as UTF-8; a character may come in several parts."""
        self._buffer.put(data)

    def flush(self) -> None:
        """Do nothing: whole lines are written already, and a partial line waits for its end."""

    def finish(self) -> None:
        """Write the partial line."""
        if part := self.take_part() + self._buffer.take_rest():
            self._output.row(part, self._stream)

    def take_part(self) -> str:
        """Return the partial line and clear it."""
        part = self._part.getvalue()
        self._part = io.StringIO()
        return part


class ByteStream(io.RawIOBase):
    """The binary stream below a line stream.

    Args:
        stream: Receives the text.
    """

    mode = "wb"

    def __init__(self, stream: LineStream) -> None:
        self._stream = stream
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")

    @property
    def name(self) -> str:
        """Name of the real stream."""
        return self._stream.name

    @property
    def raw(self) -> ByteStream:
        """The stream itself: there is no buffer."""
        return self

    def fileno(self) -> int:
        """Return the descriptor that C writes to."""
        return self._stream.fileno()

    def writable(self) -> bool:
        """Return True."""
        return True

    def write(self, data: Any) -> int:
        """Write bytes, decoded as UTF-8."""
        if self.closed:
            raise ValueError("write to closed file")
        taken = bytes(data)
        self.put(taken)
        return len(taken)

    def put(self, data: bytes) -> None:
        """Write bytes, even if the program has closed the stream."""
        self._stream.put(self._decoder.decode(data))

    def take_rest(self) -> str:
        """Return the replacement for an unfinished UTF-8 character at the end; empty if there is none."""
        return self._decoder.decode(b"", final=True)
