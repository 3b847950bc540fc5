"""Speaking aloud, where that makes sense: a local terminal, and `espeak-ng` installed."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Mapping

COMMAND = "espeak-ng"
MAX_CHARS = 300
"""Of one text; a robot that reads out a book cannot be stopped otherwise."""


class Voice:
    """Speaks one text at a time; one that comes meanwhile is only shown.

    Args:
        quiet: Never speak.
        environment: Where a remote terminal shows; by default that of this process.
    """

    def __init__(self, quiet: bool = False, environment: Mapping[str, str] = os.environ) -> None:
        remote = any(name in environment for name in ("SSH_CONNECTION", "SSH_TTY", "SSH_CLIENT"))
        self._program = None if quiet or remote else shutil.which(COMMAND)
        self._speaking: subprocess.Popen[bytes] | None = None

    def speak(self, text: str) -> None:
        """Say a text, unless one is still being said."""
        if self._program is None or (self._speaking and self._speaking.poll() is None):
            return
        # The text goes in by the pipe: as an argument it could pass for a switch.
        try:
            self._speaking = subprocess.Popen(
                [self._program, "--stdin"],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        except OSError:
            self._program = None
            return
        assert self._speaking.stdin is not None
        self._speaking.stdin.write(text[:MAX_CHARS].encode())
        self._speaking.stdin.close()

    def hush(self) -> None:
        """Stop speaking."""
        if self._speaking and self._speaking.poll() is None:
            self._speaking.kill()
