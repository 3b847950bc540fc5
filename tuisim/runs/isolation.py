"""Runs a child process through bubblewrap: without network, and without the user's files.

The program sees its own folder, the run folder, Python and its packages, and the libraries of the system. This keeps a
careless program away from other files; it is no protection against a determined attacker.
"""

from __future__ import annotations

import json
import os
import select
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO

from tuisim.errors import ConfigError

BWRAP = "bwrap"
START_S = 10.0
"""Real seconds that bubblewrap may take to start."""
_SYSTEM = ("/usr", "/lib", "/lib32", "/lib64", "/libx32", "/bin", "/etc/ld.so.cache", "/etc/alternatives")
_SIGNALLED = 128
"""bubblewrap reports a signal N that ended the child as exit status 128 + N."""
_PACKAGES = ("site-packages", "dist-packages")
_KEY = "--isolate"


def check_isolation() -> None:
    """Start bubblewrap once, and wait for its end.

    Raises:
        ConfigError: it is not installed, or cannot start here.
    """
    if shutil.which(BWRAP) is None:
        raise ConfigError(f"{BWRAP} is not installed", "install bubblewrap, or leave --isolate out", key=_KEY)
    try:
        done = subprocess.run(
            [*_command(Path("/"), (), ()), sys.executable, "-c", ""],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=START_S,
        )
        reason = done.stderr.strip().rpartition("\n")[2] or f"exit status {done.returncode}" if done.returncode else ""
    except (OSError, subprocess.TimeoutExpired) as error:
        reason = str(error)
    if reason:
        raise ConfigError(f"{BWRAP} cannot start here: {reason}", "leave --isolate out", key=_KEY)


class IsolatedChild:
    """A child inside bubblewrap.

    Args:
        process: bubblewrap itself, which waits for the child.
        pid: The child.
    """

    def __init__(self, process: subprocess.Popen[bytes], pid: int) -> None:
        self._process, self.pid = process, pid
        self.returncode: int | None = None

    def poll(self) -> int | None:
        """Return the exit status, negative for a signal; None while it runs."""
        return self._ended(self._process.poll())

    def wait(self, timeout: float | None = None) -> int:
        """Block until it has ended.

        Raises:
            subprocess.TimeoutExpired: it is still running after `timeout` seconds.
        """
        status = self._ended(self._process.wait(timeout))
        assert status is not None
        return status

    def send_signal(self, number: int, /) -> None:
        """Send a signal, unless it has ended."""
        if self.poll() is None:
            with suppress(ProcessLookupError):
                os.kill(self.pid, number)

    def _ended(self, status: int | None) -> int | None:
        if status is not None:
            self.returncode = _SIGNALLED - status if status > _SIGNALLED else status
        return self.returncode


def spawn_isolated(
    command: Sequence[str],
    environment: Mapping[str, str],
    log: IO[bytes],
    inherited: Sequence[int],
    writable: Sequence[Path],
    readable: Sequence[Path],
) -> IsolatedChild:
    """Start a child that can change nothing but some folders, and read little else. Blocks until it has started.

    Args:
        command: Its command.
        environment: Its environment.
        log: Its stderr.
        inherited: File descriptors that it keeps.
        writable: Folders that it may change; the last one is its working directory.
        readable: Further files and folders that it may read.

    Raises:
        OSError: bubblewrap cannot be started, or has not started the child.
    """
    info_fd, info_write = os.pipe()
    try:
        process = subprocess.Popen(
            [*_command(writable[-1], writable, readable), "--info-fd", str(info_write), "--", *command],
            pass_fds=[*inherited, info_write],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=log,
            env=environment,
            start_new_session=True,
        )
    finally:
        os.close(info_write)
    with open(info_fd, "rb") as info:
        # It is closed when the child starts, or when bubblewrap has given up.
        text = info.read() if select.select([info_fd], [], [], START_S)[0] else b""
    try:
        return IsolatedChild(process, int(json.loads(text)["child-pid"]))
    except (ValueError, KeyError) as error:
        process.kill()
        process.wait()
        raise OSError(f"{BWRAP} has not started the program") from error


def _command(cwd: Path, writable: Sequence[Path], readable: Sequence[Path]) -> list[str]:
    """Return the command of bubblewrap, up to its last options."""
    words = [BWRAP, "--unshare-all", "--as-pid-1", "--new-session", "--die-with-parent"]
    words += ["--proc", "/proc", "--dev", "/dev", "--tmpfs", "/tmp"]
    for place in (*_SYSTEM, *_python(), *map(str, readable)):
        words += ["--ro-bind-try", place, place]
    for folder in writable:
        words += ["--bind", str(folder), str(folder)]
    return [*words, "--chdir", str(cwd)]


def _python() -> list[str]:
    """Return the folders that Python and its packages are in."""
    package = Path(__file__).parent.parent
    packages = [folder for folder in sys.path if Path(folder).name in _PACKAGES]
    folders = [sys.base_prefix, sys.base_exec_prefix, sys.prefix, sys.exec_prefix, *packages, str(package)]
    # A prefix such as / would show everything; what Python needs of it is part of the system.
    return [folder for folder in dict.fromkeys(map(os.path.realpath, folders)) if folder != os.sep]
