"""The app of one visitor: a process that a browser shows."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from textual_serve.app_service import AppService
from textual_serve.download_manager import DownloadManager

from tuisim.web.link import Link

END_WITHIN_S = 5.0
"""Seconds in which an app must end by itself; after that it is killed."""
_HEAD = b"__GANGLION__\n"
"""The line before the first packet of an app."""
_MAX_ERROR_BYTES = 4096
_MAX_PACKET_BYTES = 32 << 20
_MAX_MESSAGE_BYTES = 64 << 10
"""A longer message of an app is dropped, as messages take memory while they wait for a browser."""
_TERMINAL_VARIABLES = (
    "LC_ALL",
    "TMUX",
    "STY",
    "LC_TERMINAL",
    "LC_TERMINAL_VERSION",
    "ITERM_SESSION_ID",
    "KITTY_WINDOW_ID",
    "WEZTERM_PANE",
    "KONSOLE_VERSION",
    "VTE_VERSION",
    "WT_SESSION",
    "TERMINAL_EMULATOR",
)
"""Variables about the terminal in which the server was started: the app, which is in a browser, must not get them."""
_BROWSER_ENVIRONMENT = {
    "TERM": "xterm-256color",
    "COLORTERM": "truecolor",
    "LC_CTYPE": "C.UTF-8",
    "PYTHONUTF8": "1",
}


_BOOT = """\
import os, sys
package, os.environ["TUISIM_SESSION"] = sys.argv[1:3]
del sys.argv[1:3]
sys.path.append(package)
from tuisim.__main__ import main
sys.exit(main())
"""
"""Startup code of an app: the package comes last in the path, as in the child of a run."""
_PACKAGE_FOLDER = str(Path(__file__).parent.parent.parent)


def build_app_command(words: Sequence[str], session_folder: str = "") -> list[str]:
    """Return the command that starts an app, as words.

    Args:
        words: What the app opens, as words of `tuisim open`.
        session_folder: The folder for the app's panels and unsaved texts; empty for the folder of the user's other
            apps.
    """
    return [sys.executable, "-P", "-c", _BOOT, _PACKAGE_FOLDER, session_folder, "open", *words]


class WebSession(AppService):
    """An app process that is connected to a browser.

    Args:
        command: The command of the app, as words.
        link: The connection to the browser.
        downloads: The files that apps offer.
    """

    def __init__(self, command: Sequence[str], link: Link, downloads: DownloadManager) -> None:
        super().__init__(
            " ".join(command),
            write_bytes=link.send_bytes,
            write_str=link.send_str,
            close=_do_nothing,
            download_manager=downloads,
        )
        self._words = command
        self.told: Callable[[Mapping[str, Any]], None] = lambda _: None
        """Called with each message of the app."""
        self.errors = ""
        """The end of what the app has written to stderr; empty until the app has ended."""

    def _build_environment(self, width: int = 80, height: int = 24) -> dict[str, str]:
        environment = super()._build_environment(width, height).items()
        inherited = {name: value for name, value in environment if name not in _TERMINAL_VARIABLES}
        return inherited | _BROWSER_ENVIRONMENT

    async def _open_app_process(self, width: int = 80, height: int = 24) -> Process:
        process = await asyncio.create_subprocess_exec(
            *self._words,
            stdin=PIPE,
            stdout=PIPE,
            stderr=PIPE,
            env=self._build_environment(width, height),
            # Otherwise ctrl+c in the server's terminal would reach the app before the server can end it.
            start_new_session=True,
        )
        self._process = process
        self._stdin = process.stdin
        return process

    async def on_meta(self, data: bytes) -> None:
        """Handle a message of the app, which is a JSON object; ignore one that is too long."""
        if len(data) > _MAX_MESSAGE_BYTES:
            return
        message = json.loads(data)
        if message.get("type") == "tell":
            self.told(message)
        else:
            await super().on_meta(data)

    async def run(self) -> None:
        """Send the app's output to the browser until the app ends."""
        assert (
            self._process is not None
            and self._process.stdout is not None
            and self._process.stderr is not None
        )
        errors = asyncio.create_task(_read_last_bytes(self._process.stderr))
        with suppress(asyncio.IncompleteReadError):
            await self._forward_output(self._process.stdout)
        self.errors = (await errors).decode("utf-8", "replace").strip()
        await self._process.wait()

    async def _forward_output(self, output: asyncio.StreamReader) -> None:
        await output.readuntil(_HEAD)
        handlers = {b"D": self.on_data, b"M": self.on_meta, b"P": self.on_packed}
        while True:
            kind = await output.readexactly(1)
            size = int.from_bytes(await output.readexactly(4), "big")
            # After a wrong kind or size, no later packet can be understood. A program, which can
            # reach the app that runs it, may have forged it: end the app.
            if kind not in handlers or size > _MAX_PACKET_BYTES:
                self._kill()
                return
            payload = await output.readexactly(size)
            try:
                await handlers[kind](payload)
            # A bad packet may raise any error, which must end this app only, not the server.
            except Exception:
                self._kill()
                return

    async def show(self, width: int, height: int) -> None:
        """Send the app the size of the terminal that now shows it, in columns and rows.

        The app then draws everything.
        """
        await self.send_meta({"type": "show", "width": width, "height": height})

    async def wait_until_ended(self) -> None:
        """Wait until the app ends by itself."""
        # An app that could not be started has no task.
        if self._task is not None:
            await asyncio.shield(self._task)

    @property
    def has_ended(self) -> bool:
        """Whether the app has ended."""
        return self._task is not None and self._task.done()

    @property
    def has_failed(self) -> bool:
        """Whether the app has ended with an error."""
        return self._process is not None and bool(self._process.returncode)

    @property
    def reason(self) -> str:
        """The text for the visitor after the app has failed; empty if it has not."""
        if not self.has_failed:
            return ""
        last = self.errors.rpartition("\n")[2]
        if last.startswith("tuisim: "):
            return last
        return (
            "The app has failed; the server's terminal says why." if last else "The app has ended."
        )

    async def stop(self) -> None:
        """Request the app to end, and wait; kill it and the processes of its group if it does not end in time."""
        if self._task is None or self._process is None:
            return
        await self._download_manager.cancel_app_downloads(app_service_id=self.app_service_id)
        await self.send_meta({"type": "quit"})
        try:
            await asyncio.wait_for(asyncio.shield(self._task), END_WITHIN_S)
        except TimeoutError:
            self._kill()
            await asyncio.wait({self._task}, timeout=END_WITHIN_S)
        self._task = None

    def _kill(self) -> None:
        """Kill the app and all processes of its group."""
        assert self._process is not None
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)


async def _do_nothing() -> None:
    """Ignore the app's announcement of its end: the socket is closed after the app has ended."""


async def _read_last_bytes(stream: asyncio.StreamReader) -> bytes:
    """Read a stream to its end; return its last bytes, at most `_MAX_ERROR_BYTES`."""
    last = b""
    while data := await stream.read(_MAX_ERROR_BYTES):
        last = (last + data)[-_MAX_ERROR_BYTES:]
    return last
