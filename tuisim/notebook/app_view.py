"""The app in a cell: a server in the kernel for the page in a frame, and what cells and app tell each other.

Needs the extra `web`.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from queue import Empty, SimpleQueue
from threading import Event
from typing import Any

from tuisim.errors import HostError
from tuisim.source import Program
from tuisim.web.gate import Gate, new_token
from tuisim.web.server import BackgroundServer, Server, ServerLimits
from tuisim.web.session import app_command
from tuisim.web.visit import Visit, VisitLimits

_START_WITHIN_S = 60.0
_SIZE_AT_FIRST = (100, 30)
"""Columns and rows until the page tells its own."""


class AppView:
    """One app, shown by the page that has asked for it last.

    Args:
        words: What it opens, as words of `tuisim open`.
        origins: Origins of pages that may show it.
    """

    def __init__(self, words: list[str], origins: tuple[str, ...]) -> None:
        gate = Gate("127.0.0.1", frames=origins)
        limits = ServerLimits(1, VisitLimits(keep_s=float("inf"), keep_unused_s=float("inf")))
        self._server = BackgroundServer(Server(app_command(words), gate, limits))
        self._is_ready = Event()
        self.begun: SimpleQueue[str] = SimpleQueue()
        """The ids of the runs that have begun in the app."""
        self.told: SimpleQueue[Mapping[str, Any]] = SimpleQueue()
        """What the app has told: `run` and `ended` with the `id` of a run, `problem` with its `text`."""
        visit = self._server.call(self._server.server.begin(*_SIZE_AT_FIRST, told=self._take))
        assert visit is not None
        self._visit: Visit = visit

    def renew_address(self, origins: tuple[str, ...]) -> dict[str, Any]:
        """Return the port and a new token: whoever has had another one cannot open the app again."""
        server = self._server.server
        frames = dict.fromkeys((*server.gate.frames, *origins))
        server.gate = replace(server.gate, token=new_token(), frames=tuple(frames))
        return {"port": self._server.port, "token": server.gate.token}

    @property
    def is_shown(self) -> bool:
        """Whether the app has begun and a page shows it now."""
        return self._is_ready.is_set() and self.is_alive and self._visit.is_shown

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
        self,
        settings: Mapping[str, Any],
        program: Program | None,
        *,
        home: bool,
        runs: bool,
        speed: float | None,
    ) -> None:
        """Let the app have the world and the program of a cell.

        Args:
            settings: By path.
            program: None leaves the one that is open.
            home: Whether it puts the robot back to its start.
            runs: Whether it also runs the program; `told` says whether it does.
            speed: Of that run, as in `RunOptions`; None for the one that its user has set, or else as fast as possible.

        Raises:
            HostError: the app does not start.
        """
        with suppress(Empty):
            while True:
                self.told.get_nowait()
        parts = program and {"name": program.name, "text": program.text, "prelude": program.prelude}
        self.ask("cell", settings=dict(settings), program=parts, home=home, runs=runs, speed=speed)

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
