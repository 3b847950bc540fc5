"""Runs a child process through bubblewrap: without network, without the user's files, and with limits.

The program sees its own folder, the run folder, Python and its packages, and the libraries of the system. It may start
no process, and use only so much memory and space.
"""

from __future__ import annotations

import errno
import json
import os
import platform
import select
import socket
import stat
import struct
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError

BWRAP = "bwrap"
START_S = 10.0
"""Real seconds that bubblewrap may take to start."""
_SYSTEM = (
    "/usr",
    "/lib",
    "/lib32",
    "/lib64",
    "/libx32",
    "/bin",
    "/etc/ld.so.cache",
    "/etc/alternatives",
)
_SIGNALLED = 128
"""bubblewrap reports a signal N that ended the child as exit status 128 + N."""
_PACKAGES = ("site-packages", "dist-packages")
_KEY = "--isolate"
_TMP_BYTES = 64 << 20
"""Size of the program's own `/tmp`, which is in memory."""
MOST_FILES, MOST_BYTES = 20_000, 1 << 30
"""Files, and bytes in them, that a program may add to its folders; see `Quota`."""
_MEMORY_BYTES = 2 << 30
"""Limit of the address space of an isolated program's process; at half of it, the program gets a MemoryError."""
_OPEN_FILES = 256
LIMITS = f"""\
import resource
for kind, most in (
    (resource.RLIMIT_AS, {_MEMORY_BYTES}),
    (resource.RLIMIT_FSIZE, {MOST_BYTES}),
    (resource.RLIMIT_NOFILE, {_OPEN_FILES}),
    (resource.RLIMIT_CORE, 0),
):
    hard = resource.getrlimit(kind)[1]
    most = most if hard == resource.RLIM_INFINITY else min(most, hard)
    resource.setrlimit(kind, (most, most))
del resource, kind, most, hard
"""
"""Code that the process runs first: it sets limits that cannot be raised again."""
_MAX_THREADS = 2_000
"""Largest number of threads of an isolated program: more than the simulation allows."""
_MAX_SOCKETS = 512
"""Largest number of sockets of a program: a socket without a descriptor still holds the data that was sent to it."""
_SOCKETS_USED = "sockets: used "
_LOOK_EVERY_S = 0.25
_BLOCK_BYTES = 512
_HIDDEN = (errno.ENAMETOOLONG, errno.EACCES)
"""Errors of folders that are nested too deep, or that the program has made unreadable."""


def check_isolation() -> None:
    """Check that bubblewrap works on this machine, by starting it once and waiting for its end.

    Raises:
        ConfigError: it is not installed, or cannot start here.
    """
    import shutil

    hint = "--no-isolate goes without"
    if shutil.which(BWRAP) is None:
        raise ConfigError(f"{BWRAP} is not installed", f"install bubblewrap; {hint}", key=_KEY)
    try:
        done = subprocess.run(
            [*_build_command(Path("/"), (), ()), sys.executable, "-c", ""],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=START_S,
        )
        reason = (
            done.stderr.strip().rpartition("\n")[2] or f"exit status {done.returncode}"
            if done.returncode
            else ""
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        reason = str(error)
    if reason:
        raise ConfigError(f"{BWRAP} cannot start here: {reason}", hint, key=_KEY)


class IsolatedChild:
    """A child process that runs inside bubblewrap.

    Args:
        process: The process of bubblewrap itself, which waits for the child.
        pid: The process id of the child.
    """

    def __init__(self, process: subprocess.Popen[bytes], pid: int) -> None:
        self._process = process
        self.pid = pid
        self.returncode: int | None = None

    def poll(self) -> int | None:
        """Return the child's exit status, negative for a signal; None while it runs."""
        return self._handle_end(self._process.poll())

    def wait(self, timeout: float | None = None) -> int:
        """Block until the child has ended; return its exit status.

        Raises:
            subprocess.TimeoutExpired: it is still running after `timeout` seconds.
        """
        status = self._handle_end(self._process.wait(timeout))
        assert status is not None
        return status

    def send_signal(self, number: int, /) -> None:
        """Send a signal to the child, unless it has ended."""
        if self.poll() is None:
            with suppress(ProcessLookupError):
                os.kill(self.pid, number)

    def _handle_end(self, status: int | None) -> int | None:
        if status is not None:
            self.returncode = _SIGNALLED - status if status > _SIGNALLED else status
        return self.returncode


class Quota:
    """The limits of an isolated program: its threads, its sockets, and what it may add to its folders.

    Args:
        pid: The process that runs the program. The program must not have begun yet.
        folders: The folders that the program may change; empty names are ignored.
    """

    def __init__(self, pid: int, folders: Iterable[str | Path]) -> None:
        self._process = f"/proc/{pid}"
        self._folders = tuple(filter(None, map(str, folders)))
        self._next_look_s = 0.0
        self._sockets = self._count_sockets()
        self._files = self._bytes = 0
        self._files, self._bytes = self._count_growth(MOST_FILES, MOST_BYTES)

    def exceeded(self, now_s: float) -> str:
        """Return a text that says which limit the program exceeds.

        It is empty if the program exceeds none. Sockets and files are only counted every `_LOOK_EVERY_S` seconds.

        Args:
            now_s: The time on any clock.
        """
        # Threads are counted at each call: in a quarter of a second, a program can start all that the system allows.
        with suppress(OSError):
            # The number of links to a folder is two more than the number of folders in it, here one for each thread.
            if os.stat(f"{self._process}/task").st_nlink - 2 > _MAX_THREADS:
                return f"the program has started more than {_MAX_THREADS:,} threads"
        if now_s < self._next_look_s:
            return ""
        self._next_look_s = now_s + _LOOK_EVERY_S
        if self._count_sockets() - self._sockets > _MAX_SOCKETS:
            return f"the program has opened more than {_MAX_SOCKETS} sockets"
        files, size = self._count_growth(MOST_FILES, MOST_BYTES)
        size += sum(self._measure_nameless())
        if files > MOST_FILES or size > MOST_BYTES:
            return (
                f"the program has written more than {MOST_FILES:,} files or {MOST_BYTES >> 30} GiB"
            )
        return ""

    def _count_sockets(self) -> int:
        """Return the number of sockets in the program's network namespace; 0 if the system does not give it."""
        with suppress(OSError):
            first = Path(f"{self._process}/net/sockstat").read_text("ascii").partition("\n")[0]
            if first.startswith(_SOCKETS_USED):
                return int(first.removeprefix(_SOCKETS_USED))
        return 0

    def _count_growth(self, most_files: int, most_bytes: int) -> tuple[int, int]:
        """Return how many files and bytes the folders have gained since the start, counted only up to these limits."""
        files = -self._files
        size = -self._bytes
        for block in self._measure_blocks():
            files = files + 1
            size = size + block
            if files > most_files or size > most_bytes:
                break
        return files, size

    def _measure_blocks(self) -> Iterator[int]:
        """Yield the bytes that each file in the folders takes on the disk.

        For an unreadable folder, yield more than the limit.
        """
        folders = list(self._folders)
        while folders:
            # The program goes on meanwhile: a file or folder that it has deleted takes no space.
            try:
                with os.scandir(folders.pop()) as entries:
                    for entry in entries:
                        with suppress(FileNotFoundError):
                            yield _BLOCK_BYTES * entry.stat(follow_symlinks=False).st_blocks
                        if entry.is_dir(follow_symlinks=False):
                            folders.append(entry.path)
            except OSError as error:
                if error.errno in _HIDDEN:
                    # The contents of this folder cannot be measured, so it is treated as too large.
                    yield MOST_BYTES + 1

    def _measure_nameless(self) -> Iterator[int]:
        """Yield the bytes of the program's open files that have no name (any more), including files in memory."""
        with suppress(OSError):
            for entry in os.scandir(f"{self._process}/fd"):
                with suppress(OSError):
                    status = entry.stat()
                    if stat.S_ISREG(status.st_mode) and not status.st_nlink:
                        yield _BLOCK_BYTES * status.st_blocks


def spawn_isolated(
    command: Sequence[str],
    environment: Mapping[str, str],
    log: IO[bytes],
    inherited: Sequence[int],
    writable: Sequence[Path],
    readable: Sequence[Path],
) -> IsolatedChild:
    """Start a child that can change only some folders, and read little else; return it when it has started.

    Args:
        command: The command that the child executes.
        environment: The child's environment variables.
        log: The file for the child's error output.
        inherited: File descriptors that the child keeps.
        writable: Folders that the child may change; the last one is its working directory.
        readable: Further files and folders that the child may read.

    Raises:
        OSError: bubblewrap cannot be started, or has not started the child.
    """
    info_fd, info_write = os.pipe()
    filter_fd = filter_descriptor()
    filtered = [] if filter_fd is None else ["--seccomp", str(filter_fd)]
    theirs = [info_write] if filter_fd is None else [info_write, filter_fd]
    try:
        process = subprocess.Popen(
            [
                *_build_command(writable[-1], writable, readable),
                "--as-pid-1",
                *filtered,
                "--info-fd",
                str(info_write),
                "--",
                *command,
            ],
            pass_fds=[*inherited, *theirs],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=log,
            env=environment,
            start_new_session=True,
        )
    finally:
        for fd in theirs:
            os.close(fd)
    with open(info_fd, "rb") as info:
        # bubblewrap closes its end when the child starts, or when it has given up.
        text = info.read() if is_readable(info_fd, START_S) else b""
    try:
        return IsolatedChild(process, int(json.loads(text)["child-pid"]))
    except (ValueError, KeyError) as error:
        process.kill()
        process.wait()
        raise OSError(f"{BWRAP} has not started the program") from error


def _build_command(cwd: Path, writable: Sequence[Path], readable: Sequence[Path]) -> list[str]:
    """Return bubblewrap's command, to which `spawn_isolated` adds its last options.

    The process that bubblewrap starts ends when bubblewrap does.

    Args:
        cwd: The working directory.
        writable: Folders that the process may change.
        readable: Files and folders that it may read, besides Python and the system.
    """
    words = [BWRAP, "--unshare-all", "--new-session", "--die-with-parent"]
    # For root, bubblewrap would keep capabilities, with which read-only folders could be mounted for writing again.
    words += ["--cap-drop", "ALL"]
    words += ["--proc", "/proc", "--dev", "/dev", "--size", str(_TMP_BYTES), "--tmpfs", "/tmp"]
    for place in (*_SYSTEM, *_list_python_folders(), *map(str, readable)):
        words += ["--ro-bind-try", place, place]
    for folder in writable:
        words += ["--bind", str(folder), str(folder)]
    # /dev and / are in memory, which the program must not fill; in /proc, root could change settings of the system.
    for place in ("/proc", "/dev", "/"):
        words += ["--remount-ro", place]
    return [*words, "--chdir", str(cwd)]


def _list_python_folders() -> list[str]:
    """Return the folders that contain Python and its packages."""
    package = Path(__file__).parents[3]
    packages = [folder for folder in sys.path if Path(folder).name in _PACKAGES]
    folders = [
        sys.base_prefix,
        sys.base_exec_prefix,
        sys.prefix,
        sys.exec_prefix,
        *packages,
        str(package),
    ]
    # A prefix of / is left out, because it would make everything readable. Python's own files are then in the folders
    # of the system, which are readable anyway.
    return [folder for folder in dict.fromkeys(map(os.path.realpath, folders)) if folder != os.sep]


def is_readable(descriptor: int, timeout_s: float | None) -> bool:
    """Return whether a descriptor can be read without blocking, or is at its end.

    Args:
        descriptor: The descriptor.
        timeout_s: How long to wait until it can be read; None waits without a limit.

    Raises:
        OSError: the descriptor is closed.
    """
    poll = select.poll()
    poll.register(descriptor, select.POLLIN)
    events = poll.poll(None if timeout_s is None else max(0, round(timeout_s * 1000)))
    if events and events[0][1] & select.POLLNVAL:
        raise OSError(9, "Bad file descriptor")
    return bool(events)


# An isolated program must not avoid its other limits either. So the filter refuses system calls that create a
# namespace, in which the program could mount memory. It refuses memory that belongs to no address space and no open
# file, such as that in a socket or a pipe. And it refuses io_uring, which calls the kernel past the filter, and the
# user's keys.

_LOAD = 0x20
_EQUAL = 0x15
_AT_LEAST = 0x35
_BITS = 0x45
_RETURN = 0x06
"""Instructions of a classic BPF program: load a word; jump if equal, at least, or if bits are set; return."""
_ALLOW = 0x7FFF0000
_FAIL = 0x00050000
_NUMBER_AT, _ARCHITECTURE_AT, _FIRST_AT, _SECOND_AT, _THIRD_AT = 0, 4, 16, 24, 32
"""Offsets in `struct seccomp_data`; of each argument the lower half, little-endian."""
_CLONE_THREAD = 0x00010000
_X32 = 0x40000000
"""Numbers from here on belong to another calling convention of the same processor."""


@dataclass(frozen=True, slots=True)
class _Machine:
    """The numbers that Linux gives to the system calls in the filter of `build_filter`, on one kind of processor."""

    architecture: int
    """`AUDIT_ARCH_…`"""
    clone: int
    setsockopt: int
    refused: tuple[int, ...]
    """fork, vfork; unshare, setns; shmget, msgget, semget; add_key, request_key, keyctl; sendmsg, sendmmsg, which send
    descriptors, too; memfd_create; vmsplice."""
    clone3: int = 435
    refused_everywhere: tuple[int, ...] = (425, 447)
    """io_uring_setup, memfd_secret."""


_MACHINES = {
    "x86_64": _Machine(
        0xC000003E, 56, 54, (57, 58, 272, 308, 29, 68, 64, 248, 249, 250, 46, 307, 319, 278)
    ),
    "aarch64": _Machine(
        0xC00000B7, 220, 208, (97, 268, 194, 186, 190, 217, 218, 219, 211, 269, 279, 75)
    ),
}


def build_filter() -> bytes | None:
    """Return the filter that forbids a program some system calls, such as `fork`, in the form that bubblewrap needs.

    Return None on an unknown kind of processor.
    """
    machine = _MACHINES.get(platform.machine())
    if machine is None:
        return None
    fails = _FAIL | errno.EPERM
    unknown = _FAIL | errno.ENOSYS
    nothing = _FAIL
    program = [
        _pack_instruction(_LOAD, _ARCHITECTURE_AT),
        # System calls of another architecture have other numbers, so they are all refused.
        _pack_instruction(_EQUAL, machine.architecture, 1, 0),
        _pack_instruction(_RETURN, fails),
        _pack_instruction(_LOAD, _NUMBER_AT),
        _pack_instruction(_AT_LEAST, _X32, 0, 1),
        _pack_instruction(_RETURN, unknown),
        # clone3 has its flags in memory, which a filter cannot read. Without it the C library uses clone.
        _pack_instruction(_EQUAL, machine.clone3, 0, 1),
        _pack_instruction(_RETURN, unknown),
    ]
    for number in (*machine.refused, *machine.refused_everywhere):
        program += [_pack_instruction(_EQUAL, number, 0, 1), _pack_instruction(_RETURN, fails)]
    program += [
        # A socket's buffers use memory, too: `setsockopt` reports success, but they keep their size.
        _pack_instruction(_EQUAL, machine.setsockopt, 0, 7),
        _pack_instruction(_LOAD, _SECOND_AT),
        _pack_instruction(_EQUAL, socket.SOL_SOCKET, 0, 4),
        _pack_instruction(_LOAD, _THIRD_AT),
        _pack_instruction(_EQUAL, socket.SO_SNDBUF, 1, 0),
        _pack_instruction(_EQUAL, socket.SO_RCVBUF, 0, 1),
        _pack_instruction(_RETURN, nothing),
        _pack_instruction(_RETURN, _ALLOW),
        _pack_instruction(_EQUAL, machine.clone, 1, 0),
        _pack_instruction(_RETURN, _ALLOW),
        _pack_instruction(_LOAD, _FIRST_AT),
        _pack_instruction(_BITS, _CLONE_THREAD, 0, 1),
        _pack_instruction(_RETURN, _ALLOW),
        _pack_instruction(_RETURN, fails),
    ]
    return b"".join(program)


def _pack_instruction(code: int, operand: int, if_true: int = 0, if_false: int = 0) -> bytes:
    return struct.pack("=HBBI", code, if_true, if_false, operand)


def filter_descriptor() -> int | None:
    """Return a descriptor from which the filter of `build_filter` can be read once; None if there is no filter.

    Raises:
        OSError: this process can open no more files.
    """
    content = build_filter()
    if content is None:
        return None
    read_fd, write_fd = os.pipe()
    os.write(write_fd, content)
    os.close(write_fd)
    return read_fd
