"""Safe reading of files that may turn out to be a pipe, a device or a link, or to be larger than the memory."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO

# The original is saved: in a program's process, `os.open` is replaced by one that records opened files.
_open = os.open
_OF_THE_MACHINE = frozenset({errno.EIO, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.ENOSPC})


def open_regular(path: Path, follow_links: bool = False) -> BinaryIO:
    """Open a regular file for reading, unbuffered. Never blocks.

    Args:
        path: The file.
        follow_links: Whether the path may end in a link, as users expect of their own files; False where a program
            could have put a link.

    Raises:
        OSError: it cannot be opened; ELOOP for a link, EINVAL for a pipe, a device, a socket or a folder.
    """
    no_links = 0 if follow_links else os.O_NOFOLLOW
    descriptor = _open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | no_links)
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(errno.EINVAL, "it is not a regular file")
    return open(descriptor, "rb", buffering=0)


def read_regular(path: Path, most_bytes: int, follow_links: bool = False) -> bytes:
    """Return the contents of a regular file.

    Args:
        path: The file.
        most_bytes: The largest size that the file may have.
        follow_links: Whether the path may end in a link; False where a program could have put a link.

    Raises:
        OSError: it cannot be opened or read; EFBIG if it is longer than `most_bytes`.
    """
    with open_regular(path, follow_links) as handle:
        content = bytearray()
        while chunk := handle.read(most_bytes + 1 - len(content)):
            content += chunk
    if len(content) > most_bytes:
        raise OSError(errno.EFBIG, f"it is larger than {most_bytes} bytes")
    return bytes(content)


def of_the_machine(error: OSError) -> bool:
    """Return whether the cause of a file error is this machine, such as a full disk, and not the program."""
    return error.errno in _OF_THE_MACHINE
