"""Opening files that the program of a run could have replaced by something else."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO

_OF_THE_MACHINE = frozenset({errno.EIO, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.ENOSPC})


def open_regular(path: Path) -> BinaryIO:
    """Open a file for reading, unbuffered. Never blocks, and never follows a link at the end of the path.

    Raises:
        OSError: it cannot be opened; ELOOP for a link, EINVAL for a pipe, a device, a socket or a folder.
    """
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW | os.O_CLOEXEC)
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(errno.EINVAL, "it is not a regular file")
    return open(descriptor, "rb", buffering=0)


def read_regular(path: Path, most_bytes: int) -> bytes:
    """Return the contents of a file that is opened as by `open_regular`.

    Raises:
        OSError: it cannot be read, or is longer than `most_bytes`: then EFBIG.
    """
    with open_regular(path) as handle:
        found = bytearray()
        while chunk := handle.read(most_bytes + 1 - len(found)):
            found += chunk
    if len(found) > most_bytes:
        raise OSError(errno.EFBIG, f"it is larger than {most_bytes >> 20} MiB")
    return bytes(found)


def of_the_machine(error: OSError) -> bool:
    """Return whether an error of a file is this machine's, such as a full disk, and not the program's doing."""
    return error.errno in _OF_THE_MACHINE
