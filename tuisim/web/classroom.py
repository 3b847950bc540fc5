"""A classroom: a server for each student, and the tutor's view of all of them, behind one port."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from aiohttp import web

from tuisim.web.answering import Owner, Routes, application_of
from tuisim.web.class_links import ClassLinks, StudentLink
from tuisim.web.gate import Gate
from tuisim.web.server import (
    CLOSE_WITHIN_S,
    FILES_OF_PAGE,
    HEARTBEAT_S,
    PAGE,
    Places,
    Server,
    ServerLimits,
    file_of_page,
    to_page,
)
from tuisim.web.session import Place
from tuisim.web.sockets import close
from tuisim.web.usage import Usage, files_exceeded, usages
from tuisim.web.visit import Visit, VisitLimits

LOOK_EVERY_S = 2.0
"""Interval in which the limits of processes are looked at."""
_LOOKS_A_ROUND = 5
"""Files are looked at once in so many times."""
AppOf = Callable[[StudentLink], tuple[Sequence[str], Place]]


class Tutor:
    """Answers the tutor's requests: who is there, and one app at a time to look on at.

    Args:
        gate: Decides which requests are the tutor's.
        servers: The students' servers by name.
        used: What each app uses, by its process.
    """

    def __init__(
        self, gate: Gate, servers: Mapping[str, Server], used: Mapping[int, Usage]
    ) -> None:
        self.gate, self._servers, self._used = gate, servers, used

    @property
    def routes(self) -> Routes:
        """What it answers, after its secret part."""
        return _ROUTES

    async def _page(self, request: web.Request) -> web.StreamResponse:
        return web.FileResponse(PAGE / "classroom.html")

    async def _students(self, request: web.Request) -> web.StreamResponse:
        return web.json_response({"students": [self._student(name) for name in self._servers]})

    def _student(self, name: str) -> dict[str, Any]:
        visit = self._visit(name)
        if visit is None:
            return {"name": name, "app": None}
        memory_bytes = self._used.get(visit.pid, Usage()).memory_bytes
        return {
            "name": name,
            "app": {**visit.to_plain(), **visit.doing.to_plain(), "memory_mb": memory_bytes >> 20},
        }

    def _visit(self, name: str) -> Visit | None:
        server = self._servers.get(name)
        return next(iter(server.visits), None) if server else None

    async def _end(self, request: web.Request) -> web.StreamResponse:
        visit = self._visit(request.match_info["student"])
        if visit is None:
            raise web.HTTPNotFound(text="This student has no app open.\n")
        visit.end("Your tutor has ended this app; what it has saved is still there.")
        raise web.HTTPNoContent

    async def _link(self, request: web.Request) -> web.StreamResponse:
        # Only when it is asked for: the list is on the screen, and asked for all the time.
        server = self._servers.get(request.match_info["student"])
        if server is None:
            raise web.HTTPNotFound(text="There is no such student.\n")
        return web.json_response({"token": server.gate.token})

    async def _view(self, request: web.Request) -> web.StreamResponse:
        if request.match_info["student"] not in self._servers:
            raise web.HTTPNotFound(text="There is no such student.\n")
        return web.FileResponse(PAGE / "view.html")

    async def _look_on(self, request: web.Request) -> web.StreamResponse:
        socket = web.WebSocketResponse(heartbeat=HEARTBEAT_S, timeout=CLOSE_WITHIN_S)
        await socket.prepare(request)
        visit = self._visit(request.match_info["student"])
        if visit is None:
            await close(socket, "This student has no app open.")
        else:
            await visit.watch(socket)
        return socket


_ROUTES: Routes = [
    ("GET", "", to_page),
    ("GET", "/", Tutor._page),
    ("GET", "/students", Tutor._students),
    ("POST", "/students/{student}/end", Tutor._end),
    ("GET", FILES_OF_PAGE, file_of_page),
    ("POST", "/students/{student}/link", Tutor._link),
    ("GET", "/view/{student}", to_page),
    ("GET", "/view/{student}/", Tutor._view),
    ("GET", "/view/{student}/ws", Tutor._look_on),
    ("GET", f"/view/{{student}}{FILES_OF_PAGE}", file_of_page),
]


class Classroom:
    """Answers the requests of a class.

    Args:
        links: Who has which link.
        host: Host name or address that the server listens on.
        app_of: Returns the command of a student's app, and where it runs.
        limits: What the visitors may use: most apps of all together, and how long each lasts.
        report: Called with what an app that has failed wrote to stderr.
    """

    def __init__(
        self,
        links: ClassLinks,
        host: str,
        app_of: AppOf,
        limits: ServerLimits,
        report: Callable[[str], None],
    ) -> None:
        among = Places(limits.visitors)
        self._folders: dict[str, Sequence[Any]] = {}
        self._servers: dict[str, Server] = {}
        for student in links.students:
            command, place = app_of(student)
            gate = Gate(host, student.token)
            one = ServerLimits(1, limits.visit)
            self._servers[student.name] = Server(
                command, gate, one, _naming(report, student.name), place, among
            )
            self._folders[student.name] = (student.folder, student.home)
        self._used: dict[int, Usage] = {}
        self._tutor = Tutor(Gate(host, links.tutor), self._servers, self._used)

    def application(self) -> web.Application:
        """Return the web application."""
        owners: list[Owner] = [self._tutor, *self._servers.values()]
        application = application_of(lambda: owners)
        application.on_shutdown.append(self._send_all_away)
        application.cleanup_ctx.append(self._watched)
        return application

    async def _send_all_away(self, _: web.Application) -> None:
        await asyncio.gather(*(server.send_all_away() for server in self._servers.values()))

    async def _watched(self, _: web.Application) -> Any:
        watch = asyncio.create_task(self._watch())
        yield
        watch.cancel()
        with suppress(asyncio.CancelledError):
            await watch

    async def _watch(self) -> None:
        """End the apps that use too much."""
        look = 0
        while True:
            await asyncio.sleep(LOOK_EVERY_S)
            look += 1
            await self.check(files=look % _LOOKS_A_ROUND == 0)

    async def check(self, *, files: bool) -> None:
        """End the apps that use too much, once.

        Args:
            files: Whether to look at the students' files, too, which takes longer.
        """
        visits = {name: visit for name, server in self._servers.items() for visit in server.visits}
        used = await asyncio.to_thread(
            usages, [visit.pid for visit in visits.values() if visit.pid]
        )
        self._used.clear()
        self._used.update(used)
        for name, visit in visits.items():
            reason = used.get(visit.pid, Usage()).exceeded
            if files and not reason:
                reason = await asyncio.to_thread(files_exceeded, self._folders[name])
            if reason:
                visit.end(reason)


def _naming(report: Callable[[str], None], name: str) -> Callable[[str], None]:
    return lambda text: report(f"{name}: {text}")


def limits_of(links: ClassLinks, most: int | None, visit: VisitLimits) -> ServerLimits:
    """Return what a class may use: an app for everybody, if nothing else is said."""
    return ServerLimits(most or len(links.students), visit)
