"""The warm process: it has imported what a child imports, and forks one child for each request of its host.

A request is JSON with the files of the child attached; `tuisim.engine.runs.child.warm` sends it. A forked child runs
the same code as any other child, in a session of its own, and has only the files that it was given.

A template is a child that is prepared for a robot and a world, and forks children that need not be prepared any more.
"""

from __future__ import annotations

from tuisim.engine.runtime import wallclock  # isort: skip - must come first: it saves the real clock

import errno
import gc
import json
import os
import signal
import sys
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from tuisim.base import data_class
from tuisim.engine.core import noise
from tuisim.engine.runtime.child import Child
from tuisim.engine.runtime.run_config import parse_config

LENGTH_BYTES = 4
"""Size in bytes of the length with which each request begins."""
MAX_FILES = 8
_READ_BYTES = 1 << 16
_NEEDED_LATER = (
    "tuisim.engine.runtime.patches.signals",
    "tuisim.engine.runtime.patches.threads",
    "tuisim.engine.runtime.program",
    "tuisim.engine.runtime.scheduler",
    "tuisim.engine.shim.ev3dev.modules",
    "tuisim.engine.shim.install",
)
"""Modules that a child imports only after it has begun."""
_ONLY_HERE = ("_socket", "hashlib", "_hashlib", "_blake2", "_sha3", "tuisim.engine.runtime.warm")
"""Modules that only forked children have: they are removed from `sys.modules`."""

# The real functions are stored here, because a template replaces them in `os` for the program.
_read = os.read
_write = os.write
_close = os.close
_change_folder = os.chdir


def serve(socket_fd: int) -> Child | None:
    """Fork a child for each request of the host; return in each child that is to run a program.

    This process, and each child that becomes a template, serves requests until the host closes the socket.

    Args:
        socket_fd: The socket to the host.

    Returns:
        The prepared child if this process was forked from a template; None if it was forked from the warm process.
    """
    for name in _NEEDED_LATER:
        import_module(name)
    noise.prepare()
    data_class.prepare()
    command = sys.orig_argv[: sys.orig_argv.index("--warm")]
    prepared = None
    while True:
        gc.freeze()
        request = ForkServer(socket_fd, prepared).await_request()
        if not request["serves"]:
            break
        prepared = Child(parse_config(Path(request["folder"]), request["run"]))
        (socket_fd,) = request["channel"]
    for name in _ONLY_HERE:
        sys.modules.pop(name, None)
    sys.argv[:] = [sys.argv[0], request["folder"], *map(str, request["channel"])]
    sys.orig_argv[:] = [*command, *sys.argv[1:]]
    return prepared


class ForkServer:
    """A server that forks a child for each request of the host, and reports how children end.

    Args:
        socket_fd: The socket to the host.
        prepared: The child that is prepared for a robot and a world; None in the warm process.
    """

    def __init__(self, socket_fd: int, prepared: Child | None = None) -> None:
        self._prepared = prepared
        self._environment = dict(os.environ)
        # `_socket` is used, because the program must be the first to import `socket`, with patched functions.
        library: Any = import_module("_socket")
        self._socket: Any = library.socket(fileno=socket_fd)
        self._attached_bytes: int = library.CMSG_SPACE(MAX_FILES * 4)
        self._ended, self._wake = os.pipe()
        for fd in (self._ended, self._wake):
            os.set_blocking(fd, False)
        signal.set_wakeup_fd(self._wake)
        # SIGCHLD writes to the pipe only if it has a handler.
        wallclock.set_signal(signal.SIGCHLD, lambda *_: None)
        self._status_fds: dict[int, int] = {}
        """Where to report the end of each child, by process id."""

    def await_request(self) -> dict[str, Any]:
        """Fork a child for each request of the host; return only in each child.

        Returns:
            The request for the child in which the call returns; its `channel` has the descriptors that came with it.
        """
        while True:
            ready = wallclock.select_files([self._socket, self._ended], [], [])[0]
            if self._ended in ready:
                _read(self._ended, _READ_BYTES)
                self._report_ended()
            if self._socket in ready and (request := self._fork(*self._receive())):
                return request

    def _receive(self) -> tuple[dict[str, Any], list[int]]:
        data, attached, _flags, _address = self._socket.recvmsg(_READ_BYTES, self._attached_bytes)
        files = [
            int.from_bytes(part[offset : offset + 4], sys.byteorder)
            for _level, _kind, part in attached
            for offset in range(0, len(part) - len(part) % 4, 4)
        ]
        while data and len(data) < LENGTH_BYTES + int.from_bytes(data[:LENGTH_BYTES], "little"):
            more = self._socket.recv(_READ_BYTES)
            data = data + more if more else b""
        if not data:
            # The host has ended. The children end by themselves, see `die_with_host`.
            wallclock.exit_process(0)
        return json.loads(data[LENGTH_BYTES:]), files

    def _fork(self, request: dict[str, Any], files: list[int]) -> dict[str, Any] | None:
        status_fd, *attached = files
        if self._prepared is not None:
            self._prepared.expect(Path(request["folder"]), request["run"])
        try:
            _assert_one_thread()
            pid = wallclock.fork()
        except OSError as error:
            _report(status_fd, -(error.errno or errno.EAGAIN))
            _close(status_fd)
        else:
            if not pid:
                self._become_child(request, attached, status_fd)
                return request
            self._status_fds[pid] = status_fd
        for fd in attached:
            _close(fd)
        return None

    def _report_ended(self) -> None:
        while self._status_fds:
            try:
                pid, status = os.waitpid(-1, os.WNOHANG)
            except ChildProcessError:
                return
            if not pid:
                return
            status_fd = self._status_fds.pop(pid)
            _report(status_fd, os.waitstatus_to_exitcode(status))
            _close(status_fd)

    def _become_child(self, request: dict[str, Any], given: list[int], status_fd: int) -> None:
        os.setsid()
        # The id is reported after `setsid`, because the host may kill the child's process group from then on.
        _report(status_fd, os.getpid())
        signal.set_wakeup_fd(-1)
        wallclock.set_signal(signal.SIGCHLD, int(signal.SIG_DFL))
        self._socket.close()
        for fd in (self._ended, self._wake, status_fd, *self._status_fds.values()):
            _close(fd)
        null, log, *request["channel"] = given
        for fd, file in ((0, null), (1, null), (2, log)):
            os.dup2(file, fd)
        for fd in {null, log} - {0, 1, 2}:
            _close(fd)
        if request["environment"] != self._environment:
            os.environ.clear()
            os.environ.update(request["environment"])
        with suppress(OSError):
            _change_folder(request["working_directory"])
        wallclock.start_folder = wallclock._start_folder()


def _report(status_fd: int, number: int) -> None:
    try:
        _write(status_fd, number.to_bytes(8, sys.byteorder, signed=True))
    except OSError:
        # The host no longer waits for this child, or has ended.
        return


def _assert_one_thread() -> None:
    try:
        count = len(os.listdir("/proc/self/task"))
    except OSError:
        # This system has no `/proc`, so the threads cannot be counted.
        return
    assert count == 1, f"{count} threads"
