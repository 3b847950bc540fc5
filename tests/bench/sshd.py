"""A private SSH server on this machine, with keys and a port of its own."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import time
from pathlib import Path
from typing import Self

_PATIENCE_S = 10.0
_SEPARATION = Path("/run/sshd")
"""Where a server that root starts wants to lock itself in; a machine without systemd may lack it."""
_CONFIG = """\
ListenAddress 127.0.0.1
Port {port}
HostKey {folder}/host
AuthorizedKeysFile {folder}/user.pub
PidFile none
PasswordAuthentication no
KbdInteractiveAuthentication no
UsePAM no
StrictModes no
"""


def missing() -> str:
    """Return what to install before there can be a server, empty for nothing."""
    found = shutil.which("ssh") and shutil.which("ssh-keygen") and _server_path()
    return (
        ""
        if found
        else "needs an SSH server and client: apt-get install openssh-server openssh-client"
    )


def _server_path() -> str | None:
    return shutil.which("sshd", path=f"{os.environ.get('PATH', '')}:/usr/sbin:/usr/local/sbin")


class Sshd:
    """A server that lets in who has the key.

    Args:
        folder: An empty one, for keys and configuration.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port: int = free.getsockname()[1]

    def __enter__(self) -> Self:
        for name in ("host", "user"):
            words = ["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(self._folder / name)]
            subprocess.run(words, check=True, stdin=subprocess.DEVNULL)
        if os.geteuid() == 0:
            _SEPARATION.mkdir(mode=0o755, exist_ok=True)
        config = self._folder / "sshd_config"
        config.write_text(_CONFIG.format(port=self.port, folder=self._folder), "utf-8")
        # The server starts itself again for each connection, which takes its whole path.
        with (self._folder / "log").open("wb") as log:
            words = [str(_server_path()), "-D", "-e", "-f", str(config)]
            self._process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stderr=log)
        self._wait()
        return self

    def __exit__(self, *error: object) -> None:
        self._process.terminate()
        self._process.wait()

    def _wait(self) -> None:
        give_up = time.monotonic() + _PATIENCE_S
        while True:
            try:
                socket.create_connection(("127.0.0.1", self.port)).close()
                return
            except OSError:
                told = (self._folder / "log").read_text("utf-8", "replace")
                assert time.monotonic() < give_up and self._process.poll() is None, told
                time.sleep(0.02)

    def client(self, port: int) -> tuple[str, ...]:
        """Return the command that opens a terminal there; what is to be run comes after it.

        Args:
            port: The server's, or that of a line to it.
        """
        options = {
            "IdentityFile": self._folder / "user",
            "IdentitiesOnly": "yes",
            "IdentityAgent": "none",
            "StrictHostKeyChecking": "no",
            "UserKnownHostsFile": "/dev/null",
            "LogLevel": "ERROR",
            # Newer clients send keys that nobody has pressed, so that typing cannot be timed.
            "IgnoreUnknown": "ObscureKeystrokeTiming",
            "ObscureKeystrokeTiming": "no",
        }
        words = [word for name, value in options.items() for word in ("-o", f"{name}={value}")]
        return ("ssh", "-F", "none", "-tt", "-p", str(port), *words, "127.0.0.1")
