"""Shows the tree of device files to any code: `open`, `io`, `os`, `os.path`, `glob`, `pathlib`, `fcntl` and `mmap`.

Each replacement looks at the first characters of a path, or whether a descriptor is a device file's, and leaves
everything else to the real function. What Python itself builds on these functions needs no replacement.
"""

from __future__ import annotations

import builtins
import errno
import fcntl
import io
import mmap
import os
import stat
import zlib
from collections.abc import Callable, Iterator
from typing import Any

from tuisim.base.errors import NotSimulated
from tuisim.engine.shim.files.entries import FOLDER_MODE, DeviceFile, Folder
from tuisim.engine.shim.files.open_files import DeviceIO, OpenFiles, file_object, read, seek, write
from tuisim.engine.shim.files.tree import MAYBE_OURS, DeviceTree

Replace = Callable[[Any, str, Callable[..., Any]], None]
"""A function that replaces a function of a module; it takes the module, the function's name and the replacement."""

_MISSING: Any = object()

_FLAGS = {
    "r": os.O_RDONLY,
    "w": os.O_WRONLY | os.O_CREAT,
    "a": os.O_WRONLY | os.O_CREAT | os.O_APPEND,
}
_FLAGS["x"] = _FLAGS["w"] | os.O_EXCL
"""The flags of `os.open` for each mode of `open` without `+`; a `+` changes them to reading and writing."""

_FALLS_BACK = ("sendfile", "copy_file_range")
"""Functions of `os` that fail for device files; callers such as `shutil` then use `read` and `write` instead."""
_REFUSED = (
    *("dup2", "ftruncate", "pread", "pwrite", "readv", "writev", "preadv", "pwritev", "splice"),
)
"""Further functions of `os` that fail for the descriptors of device files; hardly any program for a brick uses them."""


class DeviceEntry:
    """One entry of a folder of the brick, as `os.scandir` yields it."""

    def __init__(self, tree: DeviceTree, folder: str, name: str, as_bytes: bool) -> None:
        path = os.path.join(folder, name)
        self._found = tree.find(f"{os.path.normpath(folder)}/{name}")
        self.name: Any = os.fsencode(name) if as_bytes else name
        self.path: Any = os.fsencode(path) if as_bytes else path

    def __fspath__(self) -> Any:
        return self.path

    def __repr__(self) -> str:
        return f"<DirEntry {self.name!r}>"

    def inode(self) -> int:
        """Return the inode number of the entry, as `os.stat` reports it."""
        assert self._found is not None
        return _inode(self._found)

    def is_dir(self, *, follow_symlinks: bool = True) -> bool:
        """Return whether the entry is a folder."""
        return isinstance(self._found, Folder)

    def is_file(self, *, follow_symlinks: bool = True) -> bool:
        """Return whether the entry is a regular file."""
        return isinstance(self._found, DeviceFile) and stat.S_ISREG(self._found.mode)

    def is_symlink(self) -> bool:
        """Return False: the symbolic links of a real brick are folders here."""
        return False

    def is_junction(self) -> bool:
        """Return False: junctions exist only on Windows."""
        return False

    def stat(self, *, follow_symlinks: bool = True) -> os.stat_result:
        """Return the result of `os.stat` for the entry."""
        assert self._found is not None
        return _status(self._found)


class Entries:
    """The iterator over a folder of the brick that `os.scandir` returns."""

    def __init__(self, entries: Iterator[DeviceEntry]) -> None:
        self._entries = entries

    def __iter__(self) -> Entries:
        return self

    def __next__(self) -> DeviceEntry:
        return next(self._entries)

    def __enter__(self) -> Entries:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def close(self) -> None:
        """End the iteration over the folder."""
        self._entries = iter(())


def _status(entry: Folder | DeviceFile) -> os.stat_result:
    mode, size = (FOLDER_MODE, 0) if isinstance(entry, Folder) else (entry.mode, entry.size)
    return os.stat_result((mode, _inode(entry), 0, 1, 0, 0, size, 0, 0, 0))


def _inode(entry: Folder | DeviceFile) -> int:
    return zlib.crc32(entry.path.encode())


class FilePatches:
    """Replacements of Python's functions that open, read and list files, which also work on device files.

    Args:
        tree: The device files.
        files: The device files that the program has open.
        replace: Replaces a function of a module.
    """

    def __init__(self, tree: DeviceTree, files: OpenFiles, replace: Replace) -> None:
        self._tree = tree
        self._files = files
        self._replace = replace

    def apply(self) -> None:
        """Replace the functions of Python that open, read and list files."""
        self._patch_open()
        self._patch_descriptors()
        self._refuse_others()
        self._patch_paths()
        self._patch_folders()
        self._replace(fcntl, "ioctl", self._ioctl(fcntl.ioctl))
        vars(mmap)["mmap"] = _branching(mmap.mmap, self._mapping)

    # Opening

    def _patch_open(self) -> None:
        real_open = builtins.open
        real_os_open = os.open
        files = self._files
        tree = self._tree
        by_fd = self._files.by_fd

        def open(  # noqa: A001 - the name that the program sees
            file: Any = _MISSING,
            mode: str = "r",
            buffering: int = -1,
            encoding: Any = None,
            errors: Any = None,
            newline: Any = None,
            closefd: bool = True,
            opener: Any = None,
        ) -> Any:
            if file is _MISSING:
                nothing: tuple[Any, ...] = ()
                # The real function raises the error for a missing argument.
                return real_open(*nothing)
            if (
                (file.__class__ is str and not file.startswith(MAYBE_OURS))
                or mode.__class__ is not str
                or (raw := self._raw(file, mode.replace("t", ""), closefd)) is None
            ):
                return real_open(file, mode, buffering, encoding, errors, newline, closefd, opener)
            return file_object(raw, mode, buffering, encoding, errors, newline)

        def os_open(path: Any = _MISSING, flags: Any = _MISSING, *given: Any, **named: Any) -> int:
            if flags is _MISSING:
                return real_os_open(*(() if path is _MISSING else (path,)), **named)
            if path.__class__ is str and not path.startswith(MAYBE_OURS):
                return real_os_open(path, flags, *given, **named)
            entry = _or_refuse(tree, path, flags)
            if entry is None:
                return real_os_open(path, flags, *given, **named)
            return files.open(os.fsdecode(path), entry, flags).fd

        self._replace(builtins, "open", open)
        vars(io)["open"] = builtins.open
        self._replace(os, "open", os_open)
        real_dup = os.dup

        def dup(fd: int) -> int:
            copy = real_dup(fd)
            if fd in by_fd:
                by_fd[copy] = by_fd[fd]
            return copy

        self._replace(os, "dup", dup)
        vars(io)["FileIO"] = _branching(io.FileIO, self._file_io)

    def _file_io(
        self, file: Any, mode: str = "r", closefd: bool = True, opener: Any = None
    ) -> DeviceIO | None:
        return self._raw(file, mode, closefd)

    def _raw(self, file: Any, mode: str, closefd: bool) -> DeviceIO | None:
        """Return an opened device file, given its path or descriptor.

        Return None for another file, or if Python's own function has to raise an error.

        Args:
            file: The path or the descriptor.
            mode: As for `open`.
            closefd: Whether closing the object closes the descriptor.
        """
        kinds = [kind for kind in mode if kind in _FLAGS]
        if len(kinds) != 1 or set(mode) - {*_FLAGS, "b", "+"}:
            return None
        if isinstance(file, int):
            held = self._files.by_fd.get(file)
            return (
                None
                if held is None
                else DeviceIO(self._files, held, mode.replace("b", ""), file, closefd)
            )
        flags = _FLAGS[kinds[0]]
        if "+" in mode:
            flags = flags & ~os.O_ACCMODE | os.O_RDWR
        entry = _or_refuse(self._tree, file, flags)
        if entry is None:
            return None
        opened = self._files.open(os.fsdecode(file), entry, flags)
        return DeviceIO(self._files, opened, mode.replace("b", ""), file)

    # Descriptors

    def _patch_descriptors(self) -> None:
        files = self._files
        by_fd = self._files.by_fd
        real_close = os.close

        def close(fd: int) -> None:
            if by_fd:
                files.forget(fd)
            real_close(fd)

        def on_descriptor(real: Callable[..., Any], ours: Callable[..., Any]) -> Callable[..., Any]:
            """Return a function of a descriptor: `ours` for that of a device file, else `real`."""

            def call(fd: int, *given: Any) -> Any:
                return real(fd, *given) if fd not in by_fd else ours(by_fd[fd], *given)

            return call

        self._replace(os, "close", close)
        self._replace(os, "read", on_descriptor(os.read, read))
        self._replace(os, "write", on_descriptor(os.write, write))
        self._replace(os, "lseek", on_descriptor(os.lseek, seek))
        status = on_descriptor(os.fstat, lambda opened: _status(opened.file))
        self._replace(os, "fstat", status)

    def _refuse_others(self) -> None:
        """Patch the remaining functions of `os`, so that they refuse the descriptor of a device file."""
        by_fd = self._files.by_fd

        def guarded(name: str, real: Callable[..., Any]) -> Callable[..., Any]:
            def call(*given: Any, **named: Any) -> Any:
                if by_fd and any(
                    isinstance(one, int) and one in by_fd for one in (*given[:2], *named.values())
                ):
                    if name in _FALLS_BACK:
                        raise OSError(errno.EINVAL, os.strerror(errno.EINVAL))
                    hint = "use os.read, os.write, os.lseek and os.dup"
                    raise NotSimulated(
                        f"os.{name} on a device file is not part of the simulated brick", hint
                    )
                return real(*given, **named)

            return call

        for name in (*_FALLS_BACK, *_REFUSED):
            if hasattr(os, name):
                self._replace(os, name, guarded(name, getattr(os, name)))

    # Paths

    def _patch_paths(self) -> None:
        tree = self._tree
        by_fd = self._files.by_fd
        real_access, real_chdir = os.access, os.chdir

        def looker(real: Any) -> Callable[..., os.stat_result]:
            def look(path: Any, *given: Any, **named: Any) -> Any:
                if path.__class__ is str and not path.startswith(MAYBE_OURS):
                    return real(path, *given, **named)
                if isinstance(path, int):
                    entry: Any = by_fd[path].file if path in by_fd else None
                else:
                    entry = tree.find(path)
                return real(path, *given, **named) if entry is None else _status(entry)

            return look

        def access(path: Any, mode: int, **named: Any) -> bool:
            try:
                entry = tree.find(path)
            except FileNotFoundError:
                return False
            if entry is None:
                return real_access(path, mode, **named)
            allowed = FOLDER_MODE & ~stat.S_IWUSR if isinstance(entry, Folder) else entry.mode
            # A program has the permissions of the owner and of the group.
            return mode & ~(allowed >> 3 | allowed >> 6) & 0o7 == 0

        def chdir(path: Any) -> None:
            if tree.find(path) is not None:
                hint = "use the whole path of a file"
                raise NotSimulated(
                    f"os.chdir to {os.fsdecode(path)} is not part of the simulated brick", hint
                )
            real_chdir(path)

        self._replace(os, "stat", looker(os.stat))
        self._replace(os, "lstat", looker(os.lstat))
        self._replace(os, "access", access)
        self._replace(os, "chdir", chdir)

    def _patch_folders(self) -> None:
        tree = self._tree
        real_list, real_scan = os.listdir, os.scandir

        def listdir(path: Any = None) -> Any:
            if (names := _names(tree, path)) is None:
                return real_list(path)
            return [os.fsencode(name) for name in names] if isinstance(path, bytes) else list(names)

        def scandir(path: Any = None) -> Any:
            if (names := _names(tree, path)) is None:
                return real_scan(path)
            folder = os.fsdecode(path)
            return Entries(
                DeviceEntry(tree, folder, name, isinstance(path, bytes)) for name in names
            )

        self._replace(os, "listdir", listdir)
        self._replace(os, "scandir", scandir)

    def finish_glob(self, module: Any) -> None:
        """Patch `glob` after its import, so that it also finds device files.

        In later versions of Python, its classes keep the original `os.scandir`.
        """
        for held in list(vars(module).values()):
            if isinstance(held, type) and "scandir" in vars(held):
                held.scandir = staticmethod(os.scandir)  # type: ignore[attr-defined]

    # Devices

    def _ioctl(self, real: Any) -> Callable[..., Any]:
        def ioctl(fd: Any, request: int, arg: Any = 0, mutate_flag: bool = True, /) -> Any:
            if (opened := self._files.opened(fd)) is None:
                return real(fd, request, arg, mutate_flag)
            data = opened.file.ioctl(request & 0xFFFFFFFF)
            if isinstance(arg, int):
                return 0
            if isinstance(arg, bytes) or not mutate_flag:
                return (data + bytes(arg)[len(data) :])[: len(bytes(arg))]
            from ctypes import c_char

            size = min(len(data), memoryview(arg).nbytes)
            (c_char * size).from_buffer(arg).raw = data[:size]
            return 0

        return ioctl

    def _mapping(self, fileno: Any, length: int, *_given: Any, **_named: Any) -> Any:
        opened = self._files.opened(fileno)
        return None if opened is None else opened.file.mapping(length)


def _or_refuse(tree: DeviceTree, path: Any, flags: int) -> Folder | DeviceFile | None:
    """Return the entry at a path of the brick; None for a path of this computer.

    Raises:
        FileNotFoundError: there is no such file.
        PermissionError: there is no such file, and `flags` ask to create it.
    """
    try:
        return tree.find(path)
    except FileNotFoundError as error:
        if not flags & os.O_CREAT or not isinstance(_parent(tree, path), Folder):
            raise
        refused = PermissionError(errno.EACCES, os.strerror(errno.EACCES), os.fsdecode(path))
        for note in error.__notes__:
            refused.add_note(note)
        raise refused from None


def _parent(tree: DeviceTree, path: Any) -> Folder | DeviceFile | None:
    """Return the brick's entry for the folder of a path; None if the folder is this computer's or missing."""
    try:
        return tree.find(os.path.dirname(os.path.normpath(os.fsdecode(path))))
    except FileNotFoundError:
        return None


def _names(tree: DeviceTree, path: Any) -> tuple[str, ...] | None:
    """Return the names in a folder of the brick; None for a folder of this computer."""
    if path is None or (path.__class__ is str and not path.startswith(MAYBE_OURS)):
        return None
    entry = tree.find(path)
    if isinstance(entry, DeviceFile):
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), os.fsdecode(path))
    return None if entry is None else entry.names


def _branching(real: type, choose: Callable[..., Any]) -> type:
    """Return a class that replaces a class of Python; programs can derive from it, and test for it with `isinstance`.

    A call of the class returns the result of `choose`. If that is None, or the arguments are wrong, it returns an
    object of the real class.
    """

    class Branching(type):
        def __call__(cls, *given: Any, **named: Any) -> Any:
            if cls is not made:
                return super().__call__(*given, **named)
            try:
                found = choose(*given, **named)
            except TypeError:
                # The arguments are wrong: the real class raises the right error.
                found = None
            return real(*given, **named) if found is None else found

        def __instancecheck__(cls, instance: object) -> bool:
            return (
                isinstance(instance, real) if cls is made else super().__instancecheck__(instance)
            )

        def __subclasscheck__(cls, subclass: type) -> bool:
            return (
                issubclass(subclass, real) if cls is made else super().__subclasscheck__(subclass)
            )

    made = Branching(
        real.__name__, (real,), {"__module__": real.__module__, "__doc__": real.__doc__}
    )
    return made
