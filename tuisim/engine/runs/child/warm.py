"""Host side of the warm process, which forks the children of runs: importing the runtime costs more than most runs."""

from __future__ import annotations

import errno
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any, TypeAlias

from tuisim.engine.runs.child.isolation import IsolatedChild, is_readable

ANSWER_S = 10.0
"""Longest wait for a server: a program may have stopped it. Then it is continued once, and given up after that."""
LOOK_EVERY_S = 0.03
"""Interval of checks whether a program has stopped the process that reports the end of a child."""
END_S = 5.0
"""Time for a server to end when its socket is closed; then it is killed."""
_NUMBER_BYTES = 8
_LENGTH_BYTES = 4


class ForkedChild:
    """A child that the warm process or a template has forked.

    Args:
        pid: Its process id.
        status_fd: The descriptor from which its exit status can be read after its end.
    """

    def __init__(self, pid: int, status_fd: int) -> None:
        self.pid = pid
        self.returncode: int | None = None
        self._status_fd = status_fd
        self._look_at_s = time.monotonic() + LOOK_EVERY_S
        self._lock = threading.Lock()

    def poll(self) -> int | None:
        """Return the child's exit status, negative for a signal; None while it runs."""
        with self._lock:
            if self.returncode is None and is_readable(self._status_fd, 0):
                data = os.read(self._status_fd, _NUMBER_BYTES)
                os.close(self._status_fd)
                if len(data) == _NUMBER_BYTES:
                    self.returncode = int.from_bytes(data, sys.byteorder, signed=True)
                else:
                    # The warm process has ended: nobody can report the end of its children any more.
                    with suppress(OSError):
                        os.killpg(self.pid, signal.SIGKILL)
                    self.returncode = -signal.SIGKILL
            elif self.returncode is None and (now_s := time.monotonic()) >= self._look_at_s:
                self._look_at_s = now_s + LOOK_EVERY_S
                _continue_parent(self.pid)
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Block until the child has ended; return its exit status.

        Raises:
            subprocess.TimeoutExpired: it is still running after `timeout` seconds.
        """
        give_up = None if timeout is None else time.monotonic() + timeout
        while self.poll() is None:
            left_s = None if give_up is None else max(give_up - time.monotonic(), 0.0)
            with suppress(OSError, ValueError):
                # Another thread may close the descriptor meanwhile.
                if not is_readable(self._status_fd, left_s):
                    raise subprocess.TimeoutExpired("child of the warm process", timeout or 0.0)
        assert self.returncode is not None
        return self.returncode

    def send_signal(self, number: int, /) -> None:
        """Send a signal to the child, unless it has ended."""
        if self.poll() is None:
            with suppress(ProcessLookupError):
                os.kill(self.pid, number)


def _continue_parent(pid: int) -> None:
    """Continue the parent of a child that has exited, because the program may have stopped the parent by a signal.

    The parent must run to report the exit.

    Args:
        pid: The child.
    """
    # Without /proc, or with another user's process, nothing can be done.
    with suppress(OSError, ValueError):
        with open(f"/proc/{pid}/stat", "rb") as file:
            state, parent = file.read().rpartition(b")")[2].split()[:2]
        if state == b"Z":
            os.kill(int(parent), signal.SIGCONT)


ChildProcess: TypeAlias = "subprocess.Popen[bytes] | ForkedChild | IsolatedChild"
"""A run's process, however it was started."""


class ForkClient:
    """The host's connection to a server: a process that forks children for it.

    Args:
        connection: The socket to the server.
        process: The server.
    """

    def __init__(self, connection: socket.socket, process: ChildProcess) -> None:
        self._lock = threading.Lock()
        self._pid = os.getpid()
        self._socket = connection
        self._process = process
        # A program may have stopped the server: without a timeout, sending more than the system's buffer would block.
        self._socket.settimeout(ANSWER_S)

    @property
    def is_usable(self) -> bool:
        """Whether this process itself has started the server; processes forked from this one must not use it."""
        return self._pid == os.getpid()

    def fork(
        self,
        folder: str,
        working_directory: str,
        environment: Mapping[str, str],
        files: Sequence[int],
        run: Mapping[str, Any],
        serves: bool = False,
    ) -> ForkedChild:
        """Fork a child, and return it. Blocks until the server is ready and the child leads its process group.

        Args:
            folder: The run folder.
            working_directory: The child's initial working directory.
            environment: The child's environment variables.
            files: Descriptors for the child. The first one is for its error output. A template also gets a socket. Any
                other child also gets the pipes of its commands and events, its lifeline (a pipe: when it is closed, the
                child is killed) and its lock.
            run: The contents of the `run.json` in the folder.
            serves: Whether the child becomes a template.

        Raises:
            OSError: the child cannot be forked, or the server has ended, or does not answer.
        """
        request = {
            "folder": folder,
            "working_directory": working_directory,
            "environment": dict(environment),
            "serves": serves,
        }
        status_fd, theirs = os.pipe()
        try:
            with open(os.devnull, "r+b", buffering=0) as null, self._lock:
                data = json.dumps(
                    {**request, "run": run if serves else self._select_changes(run)}
                ).encode()
                message = len(data).to_bytes(_LENGTH_BYTES, "little") + data
                sent = socket.send_fds(self._socket, [message], [theirs, null.fileno(), *files])
                self._socket.sendall(message[sent:])
                os.close(theirs)
                theirs = -1
                answer = self._answer(status_fd)
        except OSError:
            os.close(status_fd)
            raise
        finally:
            if theirs >= 0:
                os.close(theirs)
        pid = int.from_bytes(answer, sys.byteorder, signed=True) if answer else 0
        if pid <= 0:
            os.close(status_fd)
            raise (
                OSError(-pid, os.strerror(-pid)) if pid else ConnectionError("the server has ended")
            )
        return ForkedChild(pid, status_fd)

    def _select_changes(self, _run: Mapping[str, Any]) -> dict[str, Any]:
        """Return the parts of a `run.json` that are sent to the server: none here; `Template` overrides this."""
        return {}

    def _answer(self, status_fd: int) -> bytes:
        for _ in range(2):
            if is_readable(status_fd, ANSWER_S):
                return os.read(status_fd, _NUMBER_BYTES)
            self._process.send_signal(signal.SIGCONT)
        raise TimeoutError(errno.ETIMEDOUT, "the server does not answer")

    def close(self) -> None:
        """End the server; the children that it has forked go on.

        If another process has started the server, only close the connection.
        """
        self._socket.close()
        if self._pid != os.getpid():
            return
        self._process.send_signal(signal.SIGCONT)
        try:
            self._process.wait(END_S)
        except subprocess.TimeoutExpired:
            self._process.send_signal(signal.SIGKILL)
            self._process.wait()


class Template(ForkClient):
    """A process that is prepared for a robot and a world, and forks children for them.

    Args:
        connection: The socket to it.
        process: The process.
        run: The contents of the `run.json` of the run that it was prepared with.
    """

    def __init__(
        self, connection: socket.socket, process: ChildProcess, run: Mapping[str, Any]
    ) -> None:
        super().__init__(connection, process)
        self._last = _select_varying(run)
        """The parts of the last run's `run.json` in which runs may differ."""

    def _select_changes(self, run: Mapping[str, Any]) -> dict[str, Any]:
        last = self._last
        self._last = _select_varying(run)
        return {name: value for name, value in self._last.items() if last[name] != value}


def _select_varying(run: Mapping[str, Any]) -> dict[str, Any]:
    """Return the parts of a `run.json` in which two runs from one template may differ."""
    spec = run["spec"]
    world = run["spec"]["world"]
    return {
        "program": run["program"],
        "options": run["options"],
        "seed": spec["seed"],
        "noise": world["noise"],
        "start": world["start"],
    }


class WarmProcess(ForkClient):
    """A process that has imported the runtime, so that children forked from it start sooner.

    It ends with the process that has started it.

    Args:
        command: Command of a child without its arguments.
        environment: Its environment.
    """

    def __init__(self, command: Sequence[str], environment: Mapping[str, str]) -> None:
        mine, theirs = socket.socketpair()
        self._environment = environment
        with theirs:
            process = subprocess.Popen(
                [*command, "--warm", str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env=environment,
                cwd="/",
                start_new_session=True,
            )
        super().__init__(mine, process)

    @property
    def is_usable(self) -> bool:
        """Whether the warm process runs, and was started by this process."""
        return super().is_usable and self._process.poll() is None

    def fork_template(self, folder: str, run: Mapping[str, Any]) -> Template:
        """Fork a template for the robot and the world of a run, without blocking until it is ready.

        Args:
            folder: The folder of a run.
            run: The contents of its `run.json` when the run started. The file is not read, as the program could have
                changed it.

        Raises:
            OSError: it cannot be forked, or the warm process has ended.
        """
        mine, theirs = socket.socketpair()
        try:
            with theirs, open(os.devnull, "wb") as log:
                files = [log.fileno(), theirs.fileno()]
                return Template(
                    mine, self.fork(folder, "/", self._environment, files, run, serves=True), run
                )
        except OSError:
            mine.close()
            raise
