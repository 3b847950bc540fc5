"""The process of a run whose records go nowhere: what recording costs is what this one saves.

Started like `tuisim.runtime`, with the same arguments. Nothing in the product can be switched to this.
"""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

from tuisim.runs import records


class DroppingSink:
    """Takes tick records and forgets them.

    Args:
        folder: Not used.
    """

    count = 0

    def __init__(self, folder: Path) -> None:
        self._buffer = bytearray(1 << 20)

    def room(self, records: int) -> bytearray:
        """Return the one buffer."""
        return self._buffer

    def publish(self, count: int) -> None:
        """Forget it."""

    def close(self) -> None:
        """There is nothing to close."""


class DroppingOutput:
    """Takes printed lines and forgets them.

    Args:
        folder: Not used.
    """

    def __init__(self, folder: Path) -> None:
        self.length = 0

    def write(self, text: bytes, tick: int, time_ns: int, line: int, stream: int) -> None:
        """Forget it."""

    def close(self) -> None:
        """There is nothing to close."""


if __name__ == "__main__":
    vars(records).update(TelemetryWriter=DroppingSink, OutputWriter=DroppingOutput)
    sys.argv[0] = "tuisim.runtime"
    runpy.run_module("tuisim.runtime", run_name="__main__", alter_sys=True)
