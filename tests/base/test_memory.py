"""Memory that is freed."""

from __future__ import annotations

import os
from pathlib import Path

from tuisim.base.memory import LARGE_BLOCK_BYTES


def read_resident_bytes() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_freed_pictures_are_given_back_to_the_system() -> None:
    # By itself glibc keeps blocks of this size from now on, and the small ones behind them keep them apart.
    del [b"x" * LARGE_BLOCK_BYTES][:]
    blocks = [(b"x" * LARGE_BLOCK_BYTES, b"x" * 5000) for _ in range(8)]
    before_bytes = read_resident_bytes()
    small = [behind for _, behind in blocks]
    del blocks
    assert before_bytes - read_resident_bytes() > 7 * LARGE_BLOCK_BYTES, len(small)
