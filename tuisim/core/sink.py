"""Where the simulation puts its tick records."""

from __future__ import annotations

from typing import Protocol


class Buffer(Protocol):
    """Bytes that can be set and read by slices: a mapped file, or a bytearray."""

    def __setitem__(self, at: slice, data: bytes, /) -> None:
        """Store bytes."""

    def __getitem__(self, at: slice, /) -> bytes | bytearray:
        """Read bytes."""


class TickSink(Protocol):
    """Where tick records go."""

    count: int

    def room(self, records: int) -> Buffer:
        """Return a writable buffer in which record k of 64 bytes starts at 64 + 64·k; it holds until the next call."""

    def publish(self, count: int) -> None:
        """Tell readers how many records are whole."""
