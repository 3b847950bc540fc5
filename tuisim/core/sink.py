"""Where the simulation puts its tick records."""

from __future__ import annotations

from mmap import mmap
from typing import Protocol, TypeAlias

Buffer: TypeAlias = mmap | bytearray
"""Bytes that can be set: of a mapped file, or in memory."""


class TickSink(Protocol):
    """Where tick records go."""

    count: int

    def room(self, records: int) -> Buffer:
        """Return a writable buffer in which record k of 64 bytes starts at 64 + 64·k; it holds until the next call."""

    def publish(self, count: int) -> None:
        """Tell readers how many records are whole."""
