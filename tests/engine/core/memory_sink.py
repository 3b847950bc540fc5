"""A place for tick records in memory."""

from __future__ import annotations


class MemorySink:
    """Tick records with the header space of the file."""

    def __init__(self) -> None:
        self.count = 0
        self.buffer = bytearray(64 * 64)

    def reserve(self, records: int) -> bytearray:
        need = 64 * (1 + self.count + records)
        if need > len(self.buffer):
            self.buffer += bytes(2 * need)
        return self.buffer

    def publish(self, count: int) -> None:
        self.count = count

    def records(self) -> bytes:
        return bytes(self.buffer[64 : 64 + 64 * self.count])
