"""Output that bypasses Python's streams: of `os.write(1, …)`, of files opened on 1 or 2, of C code, of a forked copy.

Descriptors 1 and 2 are files in memory of a fixed size. So a write never blocks, an endless one comes to an end, and no
output leaves this process. Their contents are read at fixed instants of the program, which makes a run with such output
as reproducible as any other.
"""

from __future__ import annotations

import fcntl
import mmap
import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from itertools import zip_longest
from typing import Any

from tuisim.engine.runs.raw_files import RAW_BYTES, create_raw_file

_NOTHING = b"\0"
"""First byte of a file to which nothing has been written."""
_MIN_FD = 200
"""First of the runtime's own descriptors, beyond those that programs try one by one."""
_LINE_BUFFERED = 1


def silence_descriptors() -> None:
    """Discard what this process writes to descriptors 1 and 2: it is a copy that shares the files of the original."""
    with suppress(OSError):
        null = os.open(os.devnull, os.O_WRONLY)
        for fd in (1, 2):
            os.dup2(null, fd)


class RawFile:
    """The file in memory that replaces descriptor 1 or 2.

    Args:
        fd: 1 or 2.
        take: Receives the bytes that were written to the descriptor.
        created: A descriptor of a file that the host has created for it; None creates one.

    Raises:
        OSError, AttributeError: this system cannot create files in memory, or no descriptors are left.
    """

    def __init__(
        self, fd: int, take: Callable[[bytes], object], created: int | None = None
    ) -> None:
        self._take = take
        created = create_raw_file(fd) if created is None else created
        try:
            self._fd = fcntl.fcntl(created, fcntl.F_DUPFD_CLOEXEC, _MIN_FD)
            os.dup2(created, fd)
        finally:
            os.close(created)
        self._identity = os.fstat(self._fd)
        # One byte of memory shows whether anything was written; a system call would take much longer.
        self.first = mmap.mmap(self._fd, mmap.PAGESIZE)
        """Begins with 0 unless something has been written; output that begins with a null byte is not noticed."""

    def drain(self) -> int:
        """Pass the bytes that were written to the descriptor to `take`, and return their number."""
        try:
            length = min(os.lseek(self._fd, 0, os.SEEK_CUR), RAW_BYTES)
            if not length or not os.path.samestat(os.fstat(self._fd), self._identity):
                # Nothing was written, or the program has closed the descriptor and opened another file in its place.
                return 0
            data = os.pread(self._fd, length, 0)
            os.lseek(self._fd, 0, os.SEEK_SET)
        except OSError:
            return 0
        self.first[0] = 0
        self._take(data)
        return length


class RawOutput:
    """A reader of bytes that are written to descriptors 1 and 2 directly, such as by C code.

    Args:
        stdout: Receives the bytes that were written to descriptor 1.
        stderr: Receives the bytes that were written to descriptor 2.
    """

    def __init__(
        self, stdout: Callable[[bytes], object], stderr: Callable[[bytes], object]
    ) -> None:
        self._takers = {1: stdout, 2: stderr}
        self._files: list[RawFile] = []
        self._first_out: bytes | mmap.mmap = _NOTHING
        self._first_err: bytes | mmap.mmap = _NOTHING
        self._busy = False
        self._flush_c: Callable[[], object] = lambda: None
        self._write = os.write

    def open(self, created: Sequence[int] = ()) -> None:
        """Replace descriptors 1 and 2 by files in memory, if this system can create such files.

        Args:
            created: The descriptors of files that the host has created for this; empty if there are none.
        """
        with suppress(OSError, AttributeError):
            for (fd, take), file in zip_longest(self._takers.items(), created):
                self._files.append(RawFile(fd, take, file))
        firsts = (file.first for file in self._files)
        self._first_out, self._first_err, *_ = *firsts, _NOTHING, _NOTHING

    def drain(self) -> None:
        """Pass the bytes that were written to descriptors 1 and 2 to their receivers.

        Only the first byte is checked, because that is fast: output that begins with a null byte is passed on later.
        """
        # Written without a loop, which would take longer: this is called at each reading of a sensor.
        if self._first_out[0] or self._first_err[0]:
            self.drain_all()

    def drain_all(self) -> int:
        """Pass all bytes that were written to descriptors 1 and 2 to their receivers, and return their number."""
        if self._busy:
            return 0
        self._busy = True
        try:
            return sum(file.drain() for file in self._files)
        finally:
            self._busy = False

    def finish(self) -> None:
        """Pass all bytes for descriptors 1 and 2 to their receivers, including those that C code has buffered."""
        self._flush_c()
        self.drain_all()

    def write(self, fd: int, data: Any) -> int:
        """Write bytes to a descriptor as `os.write` does, which it replaces, and return the number of bytes written.

        If the descriptor is 1 or 2, the bytes are passed to its receiver immediately.
        """
        count = self._write(fd, data)
        drained = self.drain_all()
        size = memoryview(data).nbytes
        while drained and count < size:
            # The file was full, and is empty now: write the rest.
            count += self._write(fd, memoryview(data).cast("B")[count:])
            drained = self.drain_all()
        return count

    def finish_ctypes(self, module: Any) -> None:
        """Patch `ctypes` after its import: C code then writes each line immediately, and `finish` can flush the rest.

        Args:
            module: The module `ctypes`.
        """
        # On a system whose C library has other names for these functions, the output is passed on only at the end.
        with suppress(OSError, ValueError, AttributeError):
            c = module.CDLL(None)
            self._flush_c = lambda: c.fflush(None)
            c.setvbuf(module.c_void_p.in_dll(c, "stdout"), None, _LINE_BUFFERED, 0)
