"""Memory that is freed."""

from __future__ import annotations

import subprocess
import sys

CODE = """
import os
from tuisim.base.memory import LARGE_BLOCK_BYTES, return_freed_blocks

def read_resident_bytes():
    return int(open("/proc/self/statm").read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

return_freed_blocks()
# By itself glibc keeps blocks of this size from now on, and the small ones behind them keep them apart.
del [b"x" * LARGE_BLOCK_BYTES][:]
blocks = [(b"x" * LARGE_BLOCK_BYTES, b"x" * 5000) for _ in range(8)]
before_bytes = read_resident_bytes()
small = [behind for _, behind in blocks]
del blocks
print((before_bytes - read_resident_bytes()) // LARGE_BLOCK_BYTES)
"""


def test_freed_pictures_are_given_back_to_the_system() -> None:
    # The memory that earlier tests have left would take the blocks.
    output = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True).stdout
    assert int(output) >= 7
