"""Opened device files: their descriptors, and the file objects that `open` returns for them.

The descriptor of a device file is a real one, of /dev/null, so that no other file gets it, and functions that accept
any descriptor, such as `fcntl.fcntl`, accept it; `engine.shim.files.patches` looks it up here before it asks the
kernel.
"""

from __future__ import annotations

import errno
import io
import os
import stat
from functools import cache, wraps
from typing import Any

from tuisim.engine.shim.files.entries import DeviceFile, Folder, OpenFile

_real_open = os.open
_real_file = io.FileIO


class OpenFiles:
    """The device files that the program has opened, by descriptor."""

    def __init__(self) -> None:
        self.by_fd: dict[int, OpenFile] = {}

    def opened(self, file: Any) -> OpenFile | None:
        """Return the device file behind a descriptor or a file object; None if it is not a device file."""
        if not self.by_fd:
            return None
        if not isinstance(file, int):
            try:
                file = file.fileno()
            except (AttributeError, OSError, ValueError, TypeError):
                return None
        return self.by_fd.get(file)

    def open(self, path: str, entry: DeviceFile | Folder, flags: int) -> OpenFile:
        """Open a device file, and return it with a new descriptor.

        Args:
            path: As the program names it.
            entry: What is at the path.
            flags: As for `os.open`.

        Raises:
            OSError: the entry is a folder, or its permissions or the flags forbid opening it.
        """
        if isinstance(entry, Folder):
            raise _error(errno.EISDIR, path)
        if flags & os.O_CREAT and flags & os.O_EXCL:
            raise _error(errno.EEXIST, path)
        access = flags & os.O_ACCMODE
        readable = access != os.O_WRONLY
        writable = access != os.O_RDONLY
        if (readable and not entry.mode & stat.S_IRGRP) or (
            writable and not entry.mode & stat.S_IWGRP
        ):
            raise _error(errno.EACCES, path)
        opened = OpenFile(path, entry, readable, writable)
        entry.begin(opened)
        opened.fd = _real_open(os.devnull, os.O_RDWR | os.O_CLOEXEC | (flags & os.O_NONBLOCK))
        self.by_fd[opened.fd] = opened
        return opened

    def forget(self, fd: int) -> None:
        """Remove a descriptor that the program has closed."""
        self.by_fd.pop(fd, None)


def read(opened: OpenFile, size: int) -> bytes:
    """Return bytes of a device file, at most `size`, as `os.read` does.

    Raises:
        OSError: EBADF if the file is not open for reading, or the driver's error.
    """
    if not opened.readable:
        raise _error(errno.EBADF)
    return opened.file.read(opened, size)


def write(opened: OpenFile, data: Any) -> int:
    """Write bytes to a device file, and return their number, as `os.write` does.

    Raises:
        OSError: EBADF if the file is not open for writing, or the driver's error.
    """
    if not opened.writable:
        raise _error(errno.EBADF)
    return opened.file.write(opened, bytes(data))


def seek(opened: OpenFile, position: int, whence: int) -> int:
    """Move the position of a device file, and return it, as `os.lseek` does."""
    base = {os.SEEK_SET: 0, os.SEEK_CUR: opened.at, os.SEEK_END: opened.file.size}.get(whence)
    if base is None or base + position < 0:
        raise _error(errno.EINVAL)
    opened.at = base + position
    return opened.at


class DeviceIO(_real_file):
    """An opened device file as an `io.FileIO`.

    Args:
        files: The opened files.
        opened: This file.
        mode: As for `open`.
        name: The path or descriptor with which it was opened.
        closefd: Whether closing this object closes the descriptor.
    """

    def __init__(
        self, files: OpenFiles, opened: OpenFile, mode: str, name: object, closefd: bool = True
    ) -> None:
        super().__init__(opened.fd, mode, closefd)
        self._files = files
        self._opened = opened
        vars(self)["name"] = name

    def seekable(self) -> bool:
        """Return whether the file has a position that can be moved."""
        self._checkClosed()
        return True

    def seek(self, position: int, whence: int = 0, /) -> int:
        """Move the position of the file, and return it."""
        self._checkClosed()
        return seek(self._opened, position, whence)

    def tell(self) -> int:
        """Return the file's present position in bytes."""
        self._checkClosed()
        return self._opened.at

    def truncate(self, size: int | None = None, /) -> int:
        """Return the requested size, by default the present position; do nothing else: device files have no length."""
        self._checkClosed()
        return self._opened.at if size is None else size

    def read(self, size: int | None = -1, /) -> Any:
        """Return bytes of the file; None if there are none and reading must not block."""
        self._checkClosed()
        if not self.readable():
            raise io.UnsupportedOperation("File not open for reading")
        try:
            return read(self._opened, -1 if size is None else size)
        except BlockingIOError:
            return None

    def readall(self) -> Any:
        """Return all bytes of the file from its position on."""
        return self.read()

    def readinto(self, buffer: Any, /) -> Any:
        """Read bytes into a buffer, and return their number; None if there are none and reading must not block."""
        view = memoryview(buffer).cast("B")
        data = self.read(len(view))
        if data is None:
            return None
        view[: len(data)] = data
        return len(data)

    def write(self, data: Any, /) -> int:
        """Write bytes to the device immediately, and return their number."""
        self._checkClosed()
        if not self.writable():
            raise io.UnsupportedOperation("File not open for writing")
        return write(self._opened, data)

    def close(self) -> None:
        """Close the device file; later reads and writes fail."""
        if not self.closed and self.closefd:
            self._files.forget(self._opened.fd)
        super().close()


@cache
def _in_turn(kind: Any) -> Any:
    """Return a subclass of a buffered file class whose methods only one thread of the program can run at a time.

    The class's own lock would block the process for ever: the thread that has the lock may wait for simulated time, and
    no time passes while another thread blocks.
    """

    def method(name: str) -> Any:
        does = getattr(kind, name)

        @wraps(does)
        def call(self: Any, *given: Any) -> Any:
            with self._turn:
                return does(self, *given)

        return call

    def __init__(self: Any, *given: Any) -> None:  # noqa: N807
        # Imported late: only after threads are patched, its locks wait in simulated time.
        from threading import RLock

        self._turn = RLock()
        kind.__init__(self, *given)

    names = [name for name in _BUFFERED if hasattr(kind, name)]
    return type(
        kind.__name__, (kind,), {"__init__": __init__, **{name: method(name) for name in names}}
    )


_BUFFERED = (
    "read",
    "read1",
    "readinto",
    "readinto1",
    "readline",
    "peek",
    "write",
    "flush",
    "seek",
    "close",
)
"""Methods of buffered files that may read or write the device file below the buffer."""


def file_object(
    raw: DeviceIO,
    mode: str,
    buffering: int,
    encoding: str | None,
    errors: str | None,
    newline: str | None,
) -> Any:
    """Return the object that `open` returns for a device file, which decodes and buffers as for any other file."""
    if "b" in mode and buffering == 0:
        return raw
    if buffering == 0:
        raise ValueError("can't have unbuffered text I/O")
    size = buffering if buffering > 1 else io.DEFAULT_BUFFER_SIZE
    kind: type[io.BufferedIOBase]
    if "+" in mode:
        kind = io.BufferedRandom
    elif "r" in mode:
        kind = io.BufferedReader
    else:
        kind = io.BufferedWriter
    buffer: Any = _in_turn(kind)(raw, size)
    if "b" in mode:
        return buffer
    text: Any = io.TextIOWrapper(buffer, encoding, errors, newline, buffering == 1)
    text.mode = mode
    return text


def _error(number: int, *path: str) -> OSError:
    return OSError(number, os.strerror(number), *path)
