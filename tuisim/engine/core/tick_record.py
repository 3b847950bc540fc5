"""The record of one tick, and the interface that receives records."""

from __future__ import annotations

from mmap import mmap
from struct import Struct
from typing import Protocol, TypeAlias

TICK_FIELDS = (
    ("tick", "<I"),
    ("line", "<I"),
    ("x_mm", "<d"),
    ("y_mm", "<d"),
    ("heading_deg", "<d"),
    ("left_position_deg", "<d"),
    ("right_position_deg", "<d"),
    ("left_speed_dps", "<f"),
    ("right_speed_dps", "<f"),
    ("gyro_zero_deg", "<f"),
    ("flags", "<H"),
    ("actions", "<H"),
)
"""Name and type of each field of a record, the type as `struct` and numpy write it.

`line` is the program's own line that spent the time (0: none). `gyro_deg` is
gyro_zero_deg - heading_deg. `actions` counts the user actions applied before this tick."""

TICK_RECORD = Struct("<" + "".join(kind[1:] for _, kind in TICK_FIELDS))
POSITION_FIELDS = Struct("<" + "".join(kind[1:] for _, kind in TICK_FIELDS[:7]))
"""The first fields of `TICK_RECORD`, up to right_position_deg: those that change while the speeds are steady."""
FLAGS_OFFSET = TICK_RECORD.size - 4
"""Where `flags` begins in a record, in bytes."""

FLAG_LEFT_RUNNING = 1
FLAG_RIGHT_RUNNING = 2
RUNNING_FLAGS = FLAG_LEFT_RUNNING | FLAG_RIGHT_RUNNING
FLAG_PEN_DOWN = 4
FLAG_FIRST_END = 8
"""Lowest bit of the flags in a tick record which say that a motor is at an end stop (`engine.core.end_stops`)."""
FLAG_FIRST_HAND = 1 << 12
"""The lowest of the flags of touch sensors that are pressed by hand, one for each of `INPUT_PORTS`."""
END_FLAGS = FLAG_FIRST_HAND - FLAG_FIRST_END
"""All bits of the flags in a tick record which say that a motor is at an end stop."""
PRESS_FLAGS = -FLAG_FIRST_END
"""All flags that decide about touch sensors: those of end stops, and those of hands."""

Buffer: TypeAlias = mmap | bytearray
"""A mutable buffer: a mapped file, or memory."""


class TickSink(Protocol):
    """A receiver of the tick records of a simulation."""

    count: int

    def reserve(self, records: int) -> Buffer:
        """Return a writable buffer with space for `records` more records; it is valid until the next call.

        Record k, of 64 bytes, begins at byte 64 + 64·k.
        """

    def publish(self, count: int) -> None:
        """Make the first `count` tick records visible to readers."""


class MemoryRecording:
    """A receiver that keeps the tick records of a simulation in memory, without a file."""

    def __init__(self) -> None:
        self.count = 0
        self.buffer = bytearray(TICK_RECORD.size)

    def reserve(self, records: int) -> bytearray:
        """Return the buffer with all records so far, enlarged to have space for `records` more."""
        need = TICK_RECORD.size * (1 + self.count + records)
        if need > len(self.buffer):
            self.buffer += bytes(2 * need)
        return self.buffer

    def publish(self, count: int) -> None:
        """Make the first `count` tick records visible to readers."""
        self.count = count


class NoRecording:
    """A receiver that discards tick records: for a simulation that is prepared before its run is known."""

    count = 0

    def reserve(self, records: int) -> Buffer:
        """Return a buffer for tick records that nobody reads."""
        return bytearray(64 * (records + 1))

    def publish(self, count: int) -> None:
        """Ignore the tick records in the buffer: nobody reads them."""
