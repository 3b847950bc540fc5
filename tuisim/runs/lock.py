"""The lock of a run folder: held by the process that runs the program, as long as it lives.

The kernel releases the lock when the process ends in any way, which distinguishes a run
without an end from one that is still running. Pure Python: the child imports it.
"""

from __future__ import annotations

import fcntl
import os
from pathlib import Path

from tuisim.atomic import private

LOCK_FILE = "lock"


def hold(folder: Path) -> int:
    """Acquire the lock of a run folder and return its file descriptor; closing it releases the lock.

    Blocks instead of failing: `is_held` acquires the lock for a moment.
    """
    descriptor = private(str(folder / LOCK_FILE), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC)
    fcntl.flock(descriptor, fcntl.LOCK_EX)
    return descriptor


def is_held(folder: Path) -> bool | None:
    """Return whether a living process holds the lock; None if it was never acquired."""
    try:
        descriptor = os.open(folder / LOCK_FILE, os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(descriptor)
    return False
