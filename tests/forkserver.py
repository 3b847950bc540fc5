"""Children of runs that are forked from a process which has imported the runtime: the imports cost more than most runs.

A forked child executes the same start-up code as any other, leads its own session, has only the files that it was
given, and is a child of the process that asked for it. Tests that take the fixture `real_start`, and commands that
are started as processes, start children as users do.
"""

from __future__ import annotations

import ast
import ctypes
import fcntl
import marshal
import os
import select
import subprocess
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Any

import tuisim.runtime

PR_SET_CHILD_SUBREAPER = 36

SERVER = """
import fcntl, marshal, os, sys

def read(fd, size):
    data = b''
    while len(data) < size:
        more = os.read(fd, size - len(data))
        if not more:
            os._exit(0)
        data += more
    return data

def request():
    return marshal.loads(read(0, int.from_bytes(read(0, 4), 'little')))

package_folder, imports = request()
sys.path.append(package_folder)
exec(imports)
sys.path.pop()
while True:
    arguments, boot, files, folder, environment = request()
    ready, tell = os.pipe()
    between = os.fork()
    if between:
        os.close(tell)
        os.waitpid(between, 0)
        os.write(1, read(ready, 4))
        os.close(ready)
    elif os.fork():
        os._exit(0)
    else:
        break
os.setsid()
opened = [(fd, fcntl.fcntl(os.open(path, flags), fcntl.F_DUPFD, 500)) for fd, path, flags in files]
os.write(tell, os.getpid().to_bytes(4, 'little'))
os.closerange(3, 500)
for fd, copy in opened:
    os.dup2(copy, fd)
    os.close(copy)
if folder is not None:
    os.chdir(folder)
wallclock.start_folder = wallclock._start_folder()
os.environ.clear()
os.environ.update(environment)
sys.argv[:] = arguments
exec(boot, {'__name__': '__main__'})
"""
"""The server: the imports first, then one forked child a request. It has no module that the runtime does without."""


def start_up_imports() -> str:
    """Return the imports of a child before it patches what programs find."""
    source = Path(tuisim.runtime.__path__[0], "__main__.py").read_text(encoding="utf-8")
    module = ast.parse(source)
    (child,) = (node for node in module.body if isinstance(node, ast.ClassDef) and node.name == "Child")
    (run,) = (node for node in child.body if isinstance(node, ast.FunctionDef) and node.name == "run")
    imports = [node for node in (*module.body, *run.body) if isinstance(node, ast.Import | ast.ImportFrom)]
    return "\n".join(map(ast.unparse, imports))


class Forked:
    """A forked child: what a run needs of `subprocess.Popen`."""

    def __init__(self, pid: int) -> None:
        self.pid = pid
        self.returncode: int | None = None
        self._lock = threading.Lock()

    def poll(self) -> int | None:
        with self._lock:
            if self.returncode is None and (ended := os.waitpid(self.pid, os.WNOHANG))[0]:
                self.returncode = os.waitstatus_to_exitcode(ended[1])
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        give_up = None if timeout is None else time.monotonic() + timeout
        while self.poll() is None:
            process = os.pidfd_open(self.pid)
            try:
                left_s = None if give_up is None else max(give_up - time.monotonic(), 0.0)
                if not select.select([process], [], [], left_s)[0]:
                    raise subprocess.TimeoutExpired("forked child", timeout or 0.0)
            finally:
                os.close(process)
        assert self.returncode is not None
        return self.returncode

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            os.kill(self.pid, number)


class ForkServer:
    """The process that has imported the runtime, started when the first child is wanted."""

    def __init__(self) -> None:
        self._libc = ctypes.CDLL(None)
        self._lock = threading.Lock()
        self._server: subprocess.Popen[bytes] | None = None

    def child(
        self, command: Sequence[str], *, pass_fds: Sequence[int], stderr: IO[bytes], env: dict[str, str],
        cwd: str | None, **usual: object,
    ) -> Forked:  # fmt: skip
        """As `subprocess.Popen` with the command of a run's child."""
        assert usual == {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "start_new_session": True}
        *interpreter, boot, package_folder = command[:6]
        mine = f"/proc/{os.getpid()}/fd"
        files = [
            (0, os.devnull, os.O_RDONLY),
            (1, os.devnull, os.O_WRONLY),
            (2, f"{mine}/{stderr.fileno()}", os.O_WRONLY),
        ]
        files += [(fd, f"{mine}/{fd}", fcntl.fcntl(fd, fcntl.F_GETFL) & os.O_ACCMODE) for fd in pass_fds]
        with self._lock:
            server = self._server or self._start(interpreter, package_folder, env)
            # The child's parent ends at once; then the child is that of the nearest process that adopts.
            self._libc.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
            try:
                self._send(server, (["-c", *command[5:]], boot, files, cwd, env))
                assert server.stdout is not None
                return Forked(int.from_bytes(server.stdout.read(4), "little"))
            finally:
                self._libc.prctl(PR_SET_CHILD_SUBREAPER, 0, 0, 0, 0)

    def close(self) -> None:
        """End the server; children go on."""
        if self._server is not None:
            self._server.communicate()

    def _start(self, interpreter: list[str], package_folder: str, env: dict[str, str]) -> subprocess.Popen[bytes]:
        self._server = subprocess.Popen(
            [*interpreter, SERVER], env=env, cwd="/", stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        self._send(self._server, (package_folder, start_up_imports()))
        return self._server

    @staticmethod
    def _send(server: subprocess.Popen[bytes], what: Any) -> None:
        data = marshal.dumps(what)
        assert server.stdin is not None
        server.stdin.write(len(data).to_bytes(4, "little") + data)
        server.stdin.flush()
