"""The app in a cell: a server in the kernel for the page in a frame, and what cells and app tell each other.

Needs the extra `web`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from queue import Empty, SimpleQueue
from tempfile import TemporaryDirectory
from threading import Event, Lock
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import HostError
from tuisim.base.source import Program
from tuisim.web.gate import Gate
from tuisim.web.server import BackgroundServer, Server, ServerLimits
from tuisim.web.session import build_app_command
from tuisim.web.visit import Visit, VisitLimits

_START_WITHIN_S = 60.0
_SIZE_AT_FIRST = (100, 30)
"""Columns and rows until the page sends its size."""


@dataclass(frozen=True, slots=True)
class CellState:
    """The world, program and run of a notebook after its last cell."""

    settings: Mapping[str, Any]
    """By path."""
    program: Program | None
    run_id: str = ""
    """The run of the program; empty for none that has ended."""


class AppView:
    """The app of a notebook, in the page that last requested it; its panels and texts are not shared with other apps.

    Args:
        words: What the app opens, as words of `tuisim open`.
        origins: Origins of pages that may show the app.
        find_state: Returns what the app shows first; called in another thread.
    """

    def __init__(
        self, words: list[str], origins: tuple[str, ...], find_state: Callable[[], CellState]
    ) -> None:
        gate = Gate("127.0.0.1", frames=origins)
        limits = ServerLimits(1, VisitLimits(keep_s=float("inf"), keep_unused_s=float("inf")))
        self._folder = TemporaryDirectory(prefix="tuisim-")
        self._find_state = find_state
        command = build_app_command(words, self._folder.name)
        self._server = BackgroundServer(Server(command, gate, limits))
        self._is_ready, self._lock = Event(), Lock()
        self.begun: SimpleQueue[str] = SimpleQueue()
        """The ids of the runs that have begun in the app."""
        self.told: SimpleQueue[Mapping[str, Any]] = SimpleQueue()
        """Messages of the app: `run` and `ended` with the `id` of a run, `problem` with its `text`."""
        visit = self._server.call(self._server.server.begin(*_SIZE_AT_FIRST, on_message=self._take))
        assert visit is not None
        self._visit: Visit = visit

    def create_address(self, origins: tuple[str, ...]) -> dict[str, Any]:
        """Return the app's port and a new token, by name; a page with an earlier token can no longer open the app.

        Args:
            origins: Further origins of pages that may show the app.
        """
        server = self._server.server
        server.gate = server.gate.renew(origins)
        return {"port": self._server.port, "token": server.gate.token}

    @property
    def is_shown(self) -> bool:
        """Whether the app has started and a page shows it now."""
        return self._is_ready.is_set() and self.is_alive and self._visit.is_shown

    @property
    def is_alive(self) -> bool:
        """Whether the app is starting or running."""
        return not self._visit.has_ended

    def ask(self, what: str, **details: Any) -> None:
        """Send a request to the app, as soon as it has started.

        Args:
            what: The name of the request, see `notebook_cells.do_asked`.
            details: The values of the request.

        Raises:
            HostError: the app does not start.
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
        """Show the world and the program of a cell in the app.

        Args:
            settings: The settings of the world, by path.
            program: The program; None leaves the program that is open.
            home: Whether to put the robot back to its start.
            runs: Whether the app also runs the program; the queue `told` then gets the run, or why there is none.
            speed: The speed of that run, as in `RunOptions`; None for the speed that the app's user has set, else as
                fast as possible.

        Raises:
            HostError: the app does not start.
        """
        with suppress(Empty):
            while True:
                self.told.get_nowait()
        self.ask(**_ask_cell(settings, program, home=home, runs=runs, speed=speed))

    def show_state(self) -> None:
        """Show the state after the last cell in the app; an app that is starting shows this state by itself."""
        with self._lock:
            is_told = self._is_ready.is_set() and self.is_alive
        if is_told:
            for request in _ask_state(self._find_state()):
                self.ask(**request)

    async def _ask_first(self, requests: list[dict[str, Any]]) -> None:
        for each in requests:
            await self._visit.ask(each)

    def _take(self, news: Mapping[str, Any]) -> None:
        match news:
            case {"what": "ready"}:
                with self._lock:
                    requests = [*_ask_state(self._find_state())]
                    self._asking = asyncio.get_running_loop().create_task(self._ask_first(requests))
                    self._is_ready.set()
            case {"what": "run", "id": str(run_id)}:
                self.begun.put(run_id)
        self.told.put(news)

    def close(self) -> None:
        """Stop the app and its server."""
        self._server.close()
        self._folder.cleanup()


def _ask_state(state: CellState) -> Iterator[dict[str, Any]]:
    """Yield the requests with which the app shows the state after the last cell."""
    is_home = not state.run_id
    yield _ask_cell(state.settings, state.program, home=is_home, runs=False, speed=None)
    if state.run_id:
        yield {"what": "run", "id": state.run_id}


def _ask_cell(
    settings: Mapping[str, Any],
    program: Program | None,
    *,
    home: bool,
    runs: bool,
    speed: float | None,
) -> dict[str, Any]:
    parts = program and {"name": program.name, "text": program.text, "prelude": program.prelude}
    how = {"home": home, "runs": runs, "speed": speed}
    return {"what": "cell", "settings": dict(settings), "program": parts, **how}
