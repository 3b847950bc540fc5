"""The entries of the tree of device files: folders, attributes of devices, and files of other kinds."""

from __future__ import annotations

import errno
import os
import select
import stat
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import NotSimulated

if TYPE_CHECKING:
    from tuisim.engine.shim.device_files import SimDevice

FOLDER_MODE = stat.S_IFDIR | 0o755
READ_MODE, WRITE_MODE = 0o444, 0o220
"""Permission bits of an attribute's file: all users may read a readable one, owner and group may write a writable one.

"""
ATTRIBUTE_BYTES = 4096
"""Size of every attribute's file, as the kernel reports it."""
IDENTITY = ("address", "driver_name")
"""Attributes by which a library looks for a device: a program that only reads these does not use the device."""
ALWAYS_READY = select.POLLIN | select.POLLOUT


@dataclass(slots=True)
class OpenFile:
    """One device file that the program has opened, with its descriptor and position."""

    path: str
    file: DeviceFile
    readable: bool
    writable: bool
    fd: int = -1
    at: int = 0
    """Position in the file, in bytes, of the next read or write."""
    data: bytes = b""
    """The attribute's text as the last read at position 0 found it; reads at later positions return parts of it."""
    seen: object = None
    """The value that `poll` compares with the present one to find a change; None until the file has been read."""


@dataclass(frozen=True, slots=True)
class Folder:
    """A folder of device files."""

    path: str
    names: tuple[str, ...]


class DeviceFile:
    """A file of the brick that the program can open, such as an attribute of a device.

    Args:
        path: Its path.
        mode: Type and permissions, as `stat` reports them.
        size: Size in bytes, as `stat` reports it.
    """

    def __init__(self, path: str, mode: int, size: int = 0) -> None:
        self.path = path
        self.mode = mode
        self.size = size

    def begin(self, opened: OpenFile) -> None:
        """Prepare the file for reading and writing; called when the program opens it."""

    def read(self, opened: OpenFile, size: int) -> bytes:
        """Return up to `size` bytes of the file, all bytes for a negative size.

        Raises:
            OSError: the driver's error.
        """
        raise OSError(errno.EINVAL, os.strerror(errno.EINVAL))

    def write(self, opened: OpenFile, data: bytes) -> int:
        """Write bytes to the device; return their number.

        Raises:
            OSError: the driver's error.
        """
        raise OSError(errno.EINVAL, os.strerror(errno.EINVAL))

    def ready(self, opened: OpenFile) -> int:
        """Return the flags of those events that `poll` reports for the file."""
        return ALWAYS_READY

    def ioctl(self, request: int) -> bytes:
        """Return the bytes that an `ioctl` request puts into its buffer.

        Raises:
            OSError: the driver's error.
            NotSimulated: the device has this request, and it is not simulated.
        """
        raise OSError(errno.ENOTTY, os.strerror(errno.ENOTTY))

    def mapping(self, length: int) -> Any:
        """Return the memory of the device as `mmap.mmap` does.

        Raises:
            OSError: the device has no memory to map.
        """
        raise OSError(errno.ENODEV, os.strerror(errno.ENODEV))


class AttributeFile(DeviceFile):
    """A file of `/sys/class` that has the value of one attribute of a device.

    A read at the start of the file reads the value, and takes the time of a read; further reads return the rest of the
    same text.

    Args:
        path: Its path.
        device: The device.
        name: The attribute.
    """

    def __init__(self, path: str, device: SimDevice, name: str) -> None:
        readable = name in device.readers
        writable = name in device.writers
        mode = stat.S_IFREG | (READ_MODE if readable else 0) | (WRITE_MODE if writable else 0)
        super().__init__(path, mode, ATTRIBUTE_BYTES)
        self._device = device
        self._name = name

    def begin(self, opened: OpenFile) -> None:
        """Remember that the program uses the device, unless the attribute only identifies it."""
        if self._name not in IDENTITY:
            self._device.is_opened = True

    def read(self, opened: OpenFile, size: int) -> bytes:
        """Return up to `size` bytes of the attribute's value, all bytes for a negative size.

        A value is read as text with an end of line; a value of bytes is read unchanged.

        Raises:
            OSError: the driver's error.
        """
        if not opened.at:
            try:
                value = self._device.read(self._name)
            except OSError as error:
                raise _as_the_kernel(error, self.path) from None
            opened.data = value if isinstance(value, bytes) else f"{value}\n".encode()
            opened.seen = self._state()
        part = opened.data[opened.at :] if size < 0 else opened.data[opened.at : opened.at + size]
        opened.at += len(part)
        return part

    def write(self, opened: OpenFile, data: bytes) -> int:
        """Set the attribute immediately, without a buffer; return the number of bytes."""
        if data:
            try:
                self._device.write(self._name, data.decode("latin-1").removesuffix("\n"))
            except OSError as error:
                raise _as_the_kernel(error, self.path) from None
            if self._name == "command":
                self._device.commands += 1
        opened.at += len(data)
        return len(data)

    def ready(self, opened: OpenFile) -> int:
        """Return the flags that `poll` reports, with POLLPRI and POLLERR if the attribute has changed since a read.

        Only attributes in `notifying` of their device report changes.
        """
        if self._name in self._device.notifying and opened.seen != self._state():
            return ALWAYS_READY | select.POLLPRI | select.POLLERR
        return ALWAYS_READY

    def _state(self) -> object:
        """Return a value that differs after each change; None if the attribute does not report changes."""
        look = self._device.notifying.get(self._name)
        return None if look is None else (self._device.commands, look())


class TextFile(DeviceFile):
    """A file whose text never changes; reading it takes no simulated time."""

    def __init__(self, path: str, text: str) -> None:
        self._data = text.encode()
        super().__init__(path, stat.S_IFREG | READ_MODE, len(self._data))

    def read(self, opened: OpenFile, size: int) -> bytes:
        """Return up to `size` bytes of the text."""
        part = self._data[opened.at :] if size < 0 else self._data[opened.at : opened.at + size]
        opened.at += len(part)
        return part


def refuse_ioctl(path: str, request: int, hint: str) -> NotSimulated:
    """Return the error for an `ioctl` request that is not simulated."""
    return NotSimulated(f"ioctl {request:#x} of {path} is not part of the simulated brick", hint)


def _as_the_kernel(error: OSError, path: str) -> OSError:
    """Return a driver's error with the kernel's text for its number, and the driver's own text as a note."""
    number = error.errno or errno.EIO
    told = OSError(number, os.strerror(number))
    if len(error.args) > 1 and str(error.args[1]) not in path:
        told.add_note(f"{path}: {error.args[1]}")
    return told
