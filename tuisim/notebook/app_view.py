"""The app in a cell: a server in the kernel, its page in a frame, and what cells and app tell each other.

Needs the extra `web`.
"""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Event
from typing import Any
from urllib.parse import urlsplit

from IPython.display import display

from tuisim.errors import HostError
from tuisim.source import Program
from tuisim.web.gate import Gate, new_token
from tuisim.web.server import BackgroundServer, Server, ServerLimits
from tuisim.web.session import app_command
from tuisim.web.visit import Visit, VisitLimits

DEFAULT_HEIGHT_PX = 560
_FRAME = Path(__file__).with_name("frame.html")
_START_WITHIN_S = 60.0
_SIZE_AT_FIRST = (100, 30)
"""Columns and rows until the page tells its own."""
_LOCAL = ("localhost", "127.0.0.1", "[::1]")


def notebook_origins(environment: Mapping[str, str] = os.environ) -> tuple[str, ...]:
    """Return the origins under which the Jupyter server that has started this kernel is reached on this machine."""
    from jupyter_core.paths import jupyter_runtime_dir

    parent, found = environment.get("JPY_PARENT_PID", ""), []
    for path in Path(jupyter_runtime_dir()).glob("jpserver-*.json"):
        with suppress(OSError, ValueError, KeyError, TypeError):
            server = json.loads(path.read_text("utf-8"))
            if str(server["pid"]) == parent:
                url = urlsplit(str(server["url"]))
                hosts = dict.fromkeys((*_LOCAL[:2], url.hostname or _LOCAL[0]))
                found += [f"{url.scheme}://{host}:{int(server['port'])}" for host in hosts]
    return tuple(dict.fromkeys(found))


class AppView:
    """One app, shown in the cell that has asked for it last.

    Args:
        words: What it opens, as words of `tuisim open`.
        origins: Further origins of pages that may show it.
    """

    def __init__(self, words: list[str], origins: tuple[str, ...]) -> None:
        gate = Gate("127.0.0.1", frames=(*notebook_origins(), *origins))
        limits = ServerLimits(1, VisitLimits(keep_s=float("inf"), keep_unused_s=float("inf")))
        self._server = BackgroundServer(Server(app_command(words), gate, limits))
        self._is_ready = Event()
        self.begun: SimpleQueue[str] = SimpleQueue()
        """The ids of the runs that have begun in the app."""
        self.told: SimpleQueue[Mapping[str, Any]] = SimpleQueue()
        """What the app has told: `run` and `ended` with the `id` of a run, `problem` with its `text`."""
        visit = self._server.call(self._server.server.begin(*_SIZE_AT_FIRST))
        assert visit is not None
        self._visit: Visit = visit
        visit.listen(self._take)

    def show(self, height_px: int, origins: tuple[str, ...]) -> None:
        """Show the app in this cell, under a new token; a cell that has shown it before loses it."""
        server = self._server.server
        frames = dict.fromkeys((*server.gate.frames, *origins))
        server.gate = replace(server.gate, token=new_token(), frames=tuple(frames))
        text, values = (
            _FRAME.read_text("utf-8"),
            {
                "ID": f"tuisim-{secrets.token_hex(8)}",
                "HEIGHT": str(height_px),
                "PORT": str(self._server.port),
                "TOKEN": server.gate.token,
            },
        )
        for name, value in values.items():
            text = text.replace(name, value)
        display({"text/html": text, "text/plain": "<tuisim in this cell>"}, raw=True)

    @property
    def is_alive(self) -> bool:
        """Whether the app has not ended."""
        return not self._visit.has_ended

    def ask(self, what: str, **details: Any) -> None:
        """Ask the app for something, as soon as it has started; see `do_asked`.

        Raises:
            HostError: it does not start.
        """
        if not self._is_ready.wait(_START_WITHIN_S) or not self.is_alive:
            raise HostError("the app in the cell has not started", "%sim_app starts it again")
        self._server.call(self._visit.ask({"what": what, **details}))

    def take_cell(
        self, settings: Mapping[str, Any], program: Program | None, *, home: bool, runs: bool
    ) -> None:
        """Let the app have the world and the program of a cell.

        Args:
            settings: By path.
            program: None leaves the one that is open.
            home: Whether it puts the robot back to its start.
            runs: Whether it also runs the program; `told` says whether it does.

        Raises:
            HostError: the app does not start.
        """
        with suppress(Empty):
            while True:
                self.told.get_nowait()
        parts = program and {"name": program.name, "text": program.text, "prelude": program.prelude}
        self.ask("cell", settings=dict(settings), program=parts, home=home, runs=runs)

    def _take(self, told: Mapping[str, Any]) -> None:
        match told:
            case {"what": "ready"}:
                self._is_ready.set()
            case {"what": "run", "id": str(run_id)}:
                self.begun.put(run_id)
        self.told.put(told)

    def close(self) -> None:
        """End the app and its server."""
        self._server.close()
