"""The lock of a run folder: held by the process that runs the program, for as long as it lives.

The kernel drops the lock when the process ends in any way, so that a run without an end
can be told from one that is still going on. Pure Python: the child imports it.
"""

from __future__ import annotations

import fcntl
import os
from pathlib import Path

from tuisim.atomic import private

LOCK_FILE = "lock"


def hold(folder: Path) -> int:
    """Take the lock of a run folder and return its file descriptor; the lock lasts until it is closed.

    Waits rather than fails: a reader that looks whether the lock is held has it for an instant.
    """
    descriptor = private(str(folder / LOCK_FILE), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC)
    fcntl.flock(descriptor, fcntl.LOCK_EX)
    return descriptor


def is_held(folder: Path) -> bool | None:
    """Return whether a living process holds the lock; None if nobody has ever taken it."""
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
