"""Writes what the program prints to the run folder, line by line."""

from __future__ import annotations

import codecs
import gc
import io
import re
import sys
import types
import weakref
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import cached_property, partial
from typing import Any, NamedTuple

from tuisim.engine.runs.records import MAX_OUTPUT_BYTES, TEXT_STREAMS, OutputWriter, Stream

_ADDRESS = re.compile(
    r"(?P<before> at 0x)(?P<hex>[0-9a-f]{5,16})\b"
    # A thread's identifier is an address, too: <Thread(Thread-1, started 139862347318016)>.
    r"|(?P<thread>\([^()]*(?:\([^()]*\))?, (?:started|stopped)(?: daemon)? )(?P<number>[0-9]{5,20})(?=\)>)"
)
_FIRST = 0x7F0000000010
_STEP = 0x10
_LOWEST = 1 << 32 if sys.maxsize > 1 << 32 else 1 << 20
"""Lowest address outside the heap; a smaller number counts as an address only if it lies in the heap."""
_TEXT_BEFORE = 200
"""Number of characters before an address in which the name of the object's type is looked for."""
_MAX_SEARCHED = 20_000_000
"""Largest number of objects that are searched in a run, which takes a few real seconds."""
_STEPS = 3
_MOST_REACHED = 1_000
"""How far objects are followed from the program's names: number of steps, and of objects in each step."""
_HEAP_TYPE = 1 << 9
"""Flag of a class that is defined in Python: Py_TPFLAGS_HEAPTYPE."""
_NEVER_KEPT = (types.FrameType, types.TracebackType)
"""Types that are never kept alive: each object would keep all that it refers to."""


class _Given(NamedTuple):
    """The number that is printed in place of an object's address, with a check whether the object still exists."""

    number: int
    is_same: Callable[[], object]
    """Returns whether the object still exists, so that no other object can have its address."""


class Addresses:
    """The numbers that stand for addresses in printed texts, and are the same in every run.

    Each object whose address is printed gets the next number of a fixed sequence. Only addresses that Python itself
    writes, after ` at 0x`, and the identifiers of threads are replaced. A number that cannot be an address stays
    unchanged.

    An object keeps its number as long as it exists. A later object at the same address gets another number: which
    memory is used again depends on the machine.

    Args:
        names: Returns the program's global names.
    """

    def __init__(self, names: Callable[[], Mapping[str, object]]) -> None:
        self._names = names
        self._given: dict[int, _Given] = {}
        self._threads: dict[str, int] = {}
        self._count = 0
        self._searched = 0

    def stabilize(self, *texts: str) -> tuple[str, ...]:
        """Return texts of one instant with their addresses replaced; replacing them again changes nothing."""
        here: dict[int, int] = {}

        def replace(match: re.Match[str]) -> str:
            if match["hex"]:
                before = match.string[max(0, match.start() - _TEXT_BEFORE) : match.start()]
                return f"{match['before']}{self._number_address(int(match['hex'], 16), before, here):x}"
            return match["thread"] + str(self._number_thread(match["thread"], int(match["number"])))

        return tuple(_ADDRESS.sub(replace, text) for text in texts)

    def _number_address(self, real: int, before: str, here: dict[int, int]) -> int:
        if real in here:
            return here[real]
        if self._is_given(real) or (real < _LOWEST and real not in self._heap):
            return real
        known = self._given.get(real)
        if known is None or not known.is_same():
            known = self._given[real] = _Given(
                self._next_number(), _watch(self._find(real, before))
            )
        here[real] = known.number
        return known.number

    def _number_thread(self, text: str, real: int) -> int:
        if self._is_given(real):
            return real
        name = f"{text.rpartition(', ')[0]} {real}"
        if name not in self._threads:
            self._threads[name] = self._next_number()
        return self._threads[name]

    def _next_number(self) -> int:
        self._count += 1
        return _FIRST + (self._count - 1) * _STEP

    def _is_given(self, number: int) -> bool:
        return _FIRST <= number < _FIRST + self._count * _STEP

    def _find(self, real: int, before: str) -> object:
        """Return the object at the address `real`, if the text before the printed address can refer to it.

        Return None if there is no such object.

        Args:
            real: The address.
            before: The text before it.
        """
        if self._searched > _MAX_SEARCHED:
            return None
        # The garbage collector does not list all objects, so those that the program's names refer to are searched, too.
        by_age = [partial(gc.get_objects, generation) for generation in range(3)]
        searches: list[Callable[[], list[Any]]] = [*by_age, self._list_reached]
        for search in searches:
            objects = search()
            self._searched += len(objects)
            for index, address in enumerate(map(id, objects)):
                if address == real and _is_meant(objects[index], before):
                    return objects[index]
        return None

    def _list_reached(self) -> list[object]:
        """Return the objects that the program's names refer to, directly or in a few steps."""
        left_out = (types.ModuleType, type)
        level = [item for item in self._names().values() if not isinstance(item, left_out)]
        objects = level
        for _ in range(_STEPS):
            level = [
                item
                for item in gc.get_referents(*level[:_MOST_REACHED])
                if not isinstance(item, left_out)
            ]
            objects = objects + level
        return objects

    @cached_property
    def _heap(self) -> range:
        """The addresses of the heap, whose start the system chooses; empty if the system does not give them."""
        with (
            suppress(OSError, ValueError),
            open("/proc/self/maps", encoding="utf-8", errors="replace") as maps,
        ):
            for row in maps:
                if row.rstrip().endswith("[heap]"):
                    start, end = (int(part, 16) for part in row.split()[0].split("-"))
                    # The heap grows later, so addresses up to `_LOWEST` may belong to it.
                    return range(start, max(end, _LOWEST))
        return range(0)


def _is_meant(one: object, before: str) -> bool:
    """Return whether a printed address can be that of an object: whether the text before it has the name of its class.

    An example of such a text is `<Motor object`. With the name of another class, an earlier object at the same address
    was printed. If the program itself has defined the class, the result is True, because its `__repr__` can write any
    text.
    """
    kind = type(one)
    # The `__repr__` of a program's own class need not contain the name of the class.
    is_own = kind.__flags__ & _HEAP_TYPE and not str(kind.__module__).startswith("tuisim")
    return bool(is_own) or kind.__name__ in before


def _watch(one: object) -> Callable[[], object]:
    """Return a function that returns whether an object still exists.

    An object to which Python allows no weak reference is kept alive.
    """
    if one is None:
        return lambda: False
    if isinstance(one, _NEVER_KEPT):
        return lambda: True
    try:
        watched = weakref.ref(one)
    except TypeError:
        return lambda: one is not None
    return lambda: watched() is not None


class OutputRecorder:
    """A writer of rows of output to the run folder, each with the time, the tick and the source line that wrote it."""

    writer: OutputWriter
    """The file; set before the first row."""

    def __init__(self) -> None:
        self.place: Callable[[], tuple[int, int, int]] = lambda: (0, 0, 0)
        """Returns tick, simulated ns and source line; set once the session exists."""
        self.after_write: Callable[[], None] = lambda: None
        self.drain: Callable[[], None] = lambda: None
        """Writes output that did not go through Python's streams; called before each row."""
        self.watch: Callable[[str, Stream], None] | None = None
        """If set, called with text and stream of each written row."""
        self.names: Callable[[], Mapping[str, object]] = dict
        """Returns the program's global names; set once there is a program."""
        self._addresses = Addresses(lambda: self.names())

    def row(self, text: str, stream: Stream) -> None:
        """Write one row of a stream, with the present time, tick and source line."""
        self.drain()
        tick, now, line = self.place()
        if (" at 0x" in text or ", st" in text) and stream in TEXT_STREAMS:
            # This check is quick, because most rows have no address.
            (text,) = self.stabilize(text)
        self.writer.write(text.encode("utf-8", "backslashreplace"), tick, now, line, stream)
        if self.watch is not None:
            self.watch(text, stream)

    def stabilize(self, *texts: str) -> tuple[str, ...]:
        """Return texts of one instant in which addresses are replaced by numbers that are the same in every run."""
        return self._addresses.stabilize(*texts)

    def write_row(self, text: str, stream: Stream, tick: int, time_ns: int, line: int) -> None:
        """Write one row with a given tick, time and source line, not with the present ones."""
        self.writer.write(text.encode(), tick, time_ns, line, stream)


class LineStream(io.TextIOBase):
    """The program's `sys.stdout` or `sys.stderr`, which records whole lines.

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
        """Name of the stream: `<stdout>` or `<stderr>`, as Python's own stream has it."""
        return "<stdout>" if self._stream == Stream.STDOUT else "<stderr>"

    @property
    def buffer(self) -> ByteStream:
        """Binary stream, for programs that write bytes."""
        return self._buffer

    def __repr__(self) -> str:
        return f"<_io.TextIOWrapper name={self.name!r} mode='w' encoding='utf-8'>"

    def reconfigure(self, **_settings: object) -> None:
        """Do nothing: lines are always written immediately and in UTF-8."""

    def fileno(self) -> int:
        """Return the descriptor to which C code writes for this stream."""
        return int(self._stream)

    def writable(self) -> bool:
        """Return True: a program can write to this stream."""
        return True

    def detach(self) -> Any:
        """Return the binary stream; this stream cannot be used afterwards."""
        self._is_detached = True
        return self._buffer

    def write(self, text: str) -> int:
        """Write text, and return its length; whole lines are recorded immediately."""
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        if self._is_detached:
            raise ValueError("underlying buffer has been detached")
        if self.closed:
            raise ValueError("I/O operation on closed file.")
        return self.put(text)

    def put(self, text: str) -> int:
        """Write text, even if the program has closed the stream, and return its length."""
        self._output.drain()
        if "\n" not in text:
            self._part.write(text)
            if self._part.tell() > MAX_OUTPUT_BYTES:
                # The partial line is longer than the file accepts: write it before it fills the memory.
                self.finish()
            return len(text)
        # The partial line is removed before rows are written: if writing ends the program, nothing is written twice.
        *lines, rest = (self.take_part() + text).split("\n")
        self._part.write(rest)
        for line in lines:
            self._output.row(line, self._stream)
        self._output.after_write()
        return len(text)

    def flush(self) -> None:
        """Do nothing: whole lines are written already, and a partial line waits for its end."""

    def finish(self) -> None:
        """Record the partial line at the end, if there is one."""
        if part := self.take_part() + self._buffer.take_rest():
            self._output.row(part, self._stream)

    def take_part(self) -> str:
        """Return the partial line, and remove it from the stream."""
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
        """Name of the stream: `<stdout>` or `<stderr>`, as Python's own stream has it."""
        return self._stream.name

    @property
    def raw(self) -> ByteStream:
        """The stream itself: there is no buffer."""
        return self

    def fileno(self) -> int:
        """Return the descriptor to which C code writes for this stream."""
        return self._stream.fileno()

    def writable(self) -> bool:
        """Return True: a program can write to this stream."""
        return True

    def write(self, data: Any) -> int:
        """Write bytes to the stream, decoded as UTF-8, and return their number."""
        if self.closed:
            raise ValueError("write to closed file")
        taken = bytes(data)
        self.put(taken)
        return len(taken)

    def put(self, data: bytes) -> None:
        """Write bytes to the stream, even if the program has closed it."""
        self._stream.put(self._decoder.decode(data))

    def take_rest(self) -> str:
        """Return the replacement for an unfinished UTF-8 character at the end; empty if there is none."""
        return self._decoder.decode(b"", final=True)
