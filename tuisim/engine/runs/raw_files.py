"""Files in memory of a fixed size that replace a program's descriptors 1 and 2."""

from __future__ import annotations

import fcntl
import os

RAW_BYTES = 4 << 20
"""Size of the file: more than this between two instants of the program cannot be written."""


def create_raw_file(fd: int) -> int:
    """Create a file of fixed size in memory, which is to replace stdout or stderr; return its descriptor.

    Args:
        fd: The descriptor that the file will replace: 1 or 2.

    Raises:
        OSError, AttributeError: this system cannot create files in memory, or no descriptors are left.
    """
    created = os.memfd_create(f"output {fd}", os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
    try:
        os.ftruncate(created, RAW_BYTES)
        seals = fcntl.F_SEAL_GROW | fcntl.F_SEAL_SHRINK | fcntl.F_SEAL_SEAL
        fcntl.fcntl(created, fcntl.F_ADD_SEALS, seals)
    except OSError:
        os.close(created)
        raise
    return created
