"""The server: a page with a terminal, a socket for each visitor's app, static files and downloads."""

from __future__ import annotations

import asyncio
import errno
import logging
import signal
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Protocol
from urllib.parse import quote

import textual_serve
from aiohttp import WSCloseCode, web
from aiohttp.http import HttpProcessingError
from textual_serve.download_manager import DownloadManager

from tuisim.data_class import dataclass
from tuisim.errors import SIGNALLED, ConfigError, TuisimError, counted
from tuisim.web.answering import Routes, application_of
from tuisim.web.gate import Gate
from tuisim.web.session import END_WITHIN_S, HERE, Place
from tuisim.web.sockets import close
from tuisim.web.upload import keep_file
from tuisim.web.visit import Visit, VisitLimits

HEARTBEAT_S = 15.0
"""A browser that does not answer for about this time has gone."""
CLOSE_WITHIN_S = 2.0
"""Time for a browser to confirm that its socket is closed."""
PAGE = Path(__file__).parent / "page"
_FOLDERS = {
    "static": Path(textual_serve.__file__).parent / "static",
    "page": PAGE,
    "fonts": Path(__file__).parent.parent / "charts" / "fonts",
}
"""Folders of files that every visitor gets, by name."""
FILES_OF_PAGE = f"/{{folder:{'|'.join(_FOLDERS)}}}/{{name:.+}}"
"""Where they are, as a path of aiohttp."""
_DEFAULT_SIZE = (80, 24)


@dataclass(frozen=True, slots=True)
class ServerLimits:
    """What visitors may use."""

    visitors: int
    """Most apps at the same time, with those that no tab shows now."""
    visit: VisitLimits = VisitLimits()
    """How long each lasts."""


class Answering(Protocol):
    """What answers requests."""

    def application(self) -> web.Application:
        """Return the web application."""


class Places:
    """Counts the apps of several servers.

    Args:
        most: So many may live at the same time.
    """

    def __init__(self, most: int) -> None:
        self.most = self.free = most


class Server:
    """Answers the requests of visitors.

    Args:
        command: The command of the app, as words.
        gate: Decides which requests are answered.
        limits: What visitors may use.
        report: Called with what an app that has failed wrote to stderr.
        place: Where the apps run.
        among: The places that it shares with other servers, if any.
    """

    def __init__(
        self,
        command: Sequence[str],
        gate: Gate,
        limits: ServerLimits,
        report: Callable[[str], None] = lambda _: None,
        place: Place = HERE,
        among: Places | None = None,
    ) -> None:
        self._command, self._limits, self._report, self._place = command, limits, report, place
        self._among = among or Places(limits.visitors)
        self.gate = gate
        self._downloads = DownloadManager()
        self._visits: dict[str, Visit] = {}
        self._lives: dict[str, asyncio.Task[None]] = {}

    @property
    def routes(self) -> Routes:
        """What it answers, after its secret part."""
        return _ROUTES

    def application(self) -> web.Application:
        """Return the web application."""
        application = application_of(lambda: [self])
        application.on_shutdown.append(self.send_all_away)
        return application

    @property
    def visits(self) -> Sequence[Visit]:
        """The apps of its visitors."""
        return [*self._visits.values()]

    async def _page(self, request: web.Request) -> web.StreamResponse:
        return web.FileResponse(PAGE / "index.html")

    async def _list(self, request: web.Request) -> web.StreamResponse:
        sessions = [
            {**visit.to_plain(), **visit.doing.to_plain()} for visit in self._visits.values()
        ]
        return web.json_response(
            {"sessions": sessions, "free": self._free, "most": self._limits.visitors}
        )

    @property
    def _free(self) -> int:
        return min(self._limits.visitors - len(self._visits), self._among.free)

    async def _socket(self, request: web.Request) -> web.StreamResponse:
        socket = web.WebSocketResponse(heartbeat=HEARTBEAT_S, timeout=CLOSE_WITHIN_S)
        await socket.prepare(request)
        asked, size = request.query.get("session"), _size(request)
        visit = await self.begin(*size, socket) if asked is None else self._visits.get(asked)
        if visit is not None:
            if asked is not None:
                await visit.take_over(socket, *size)
            await visit.follow(socket)
        elif asked is None:
            await close(socket, self._full, WSCloseCode.TRY_AGAIN_LATER)
        else:
            await close(socket, "The session has ended.")
        return socket

    async def begin(
        self, width: int, height: int, socket: web.WebSocketResponse | None = None
    ) -> Visit | None:
        """Start an app for a visitor, if need be once one that is ending has gone; return None if all live.

        Args:
            width: Columns of the visitor's terminal.
            height: Its rows.
            socket: The connection to the browser that shows it from its first frame; None for none yet.
        """
        while self._free <= 0:
            ending = [life for id_, life in self._lives.items() if self._visits[id_].is_ending]
            if not ending:
                return None
            await asyncio.wait(ending, return_when=asyncio.FIRST_COMPLETED)
        visit = Visit(self._command, self._downloads, self._limits.visit, self._report, self._place)
        self._visits[visit.id] = visit
        self._among.free -= 1
        if socket is not None:
            await visit.take(socket)
        has_begun = asyncio.Event()

        async def live() -> None:
            try:
                await visit.live(width, height, has_begun.set)
            finally:
                del self._visits[visit.id], self._lives[visit.id]
                self._among.free += 1

        self._lives[visit.id] = asyncio.create_task(live())
        await has_begun.wait()
        return visit

    def _visit(self, request: web.Request) -> Visit:
        try:
            return self._visits[request.match_info["id"]]
        except KeyError:
            raise web.HTTPNotFound(text="There is no such session.\n") from None

    async def _end(self, request: web.Request) -> web.StreamResponse:
        self._visit(request).end("Another tab has ended this session.")
        raise web.HTTPNoContent

    async def _bring(self, request: web.Request) -> web.StreamResponse:
        visit, data = self._visit(request), await request.read()
        try:
            path = await asyncio.to_thread(
                keep_file, self._place.folder or Path.cwd(), request.query.get("name", ""), data
            )
        except TuisimError as error:
            raise web.HTTPBadRequest(text=f"{error}\n") from None
        await visit.open_file(path)
        return web.json_response({"name": path.name})

    @property
    def _full(self) -> str:
        own = self._limits.visitors
        most = own if len(self._visits) >= own else self._among.most
        return f"This server allows {counted(most, 'visitor')} at a time, and all places are taken."

    async def _download(self, request: web.Request) -> web.StreamResponse:
        key = request.match_info["key"]
        try:
            download = await self._downloads.get_download_metadata(key)
        except KeyError:
            raise web.HTTPNotFound(text="There is no such download.\n") from None
        response = web.StreamResponse()
        response.content_type = download.mime_type or "application/octet-stream"
        response.headers["Content-Disposition"] = (
            f"attachment; filename*=UTF-8''{quote(download.file_name)}"
        )
        await response.prepare(request)
        try:
            async for chunk in self._downloads.download(key):
                await response.write(chunk)
        except ValueError:
            # An app has not answered in time: the browser must not take the part for the whole.
            if request.transport is not None:
                request.transport.abort()
            return response
        await response.write_eof()
        return response

    async def send_all_away(self, _: object = None) -> None:
        """End the apps of all visitors."""
        for visit in self._visits.values():
            visit.end("The server has been ended.")
        await asyncio.gather(*self._lives.values())


async def to_page(_: object, request: web.Request) -> web.StreamResponse:
    """Send to the address of a page, which ends in a slash: what it loads is beside it."""
    raise web.HTTPFound(f"{request.rel_url.raw_path}/")


async def file_of_page(_: object, request: web.Request) -> web.StreamResponse:
    """Answer with a file that every page may have."""
    folder = _FOLDERS[request.match_info["folder"]].resolve()
    try:
        path = (folder / request.match_info["name"]).resolve(strict=True)
    except (OSError, ValueError):
        raise web.HTTPNotFound from None
    if not path.is_relative_to(folder) or not path.is_file():
        raise web.HTTPNotFound
    return web.FileResponse(path)


_ROUTES: Routes = [
    ("GET", "", to_page),
    ("GET", "/", Server._page),
    ("GET", "/ws", Server._socket),
    ("GET", "/sessions", Server._list),
    ("POST", "/sessions/{id}/end", Server._end),
    ("POST", "/sessions/{id}/file", Server._bring),
    ("GET", "/download/{key}", Server._download),
    ("GET", FILES_OF_PAGE, file_of_page),
]


def _size(request: web.Request) -> tuple[int, int]:
    """Return the size of the visitor's terminal in cells, as its page says."""
    try:
        return int(request.query["width"]), int(request.query["height"])
    except (KeyError, ValueError):
        return _DEFAULT_SIZE


def serve(server: Answering, host: str, port: int, announce: Callable[[int], None]) -> int:
    """Serve until a signal ends it, and with it the apps of all visitors. Return the exit code.

    Args:
        server: Answers the requests.
        host: Host name or address to listen on.
        port: Port to listen on; 0 takes any free one.
        announce: Called with the port as soon as visitors can come.

    Raises:
        ConfigError: the address cannot be used.
    """
    return asyncio.run(_serve(server, host, port, announce))


async def _serve(server: Answering, host: str, port: int, announce: Callable[[int], None]) -> int:
    loop = asyncio.get_running_loop()
    ended_by: asyncio.Future[signal.Signals] = loop.create_future()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        loop.add_signal_handler(number, _note, ended_by, number)
    async with listening(server, host, port) as actual_port:
        announce(actual_port)
        number = await ended_by
    # ctrl+c is how a server is meant to end.
    return 0 if number is signal.SIGINT else SIGNALLED + number


@asynccontextmanager
async def listening(server: Answering, host: str, port: int) -> AsyncIterator[int]:
    """Answer requests in the context, which gets the port; at its end, end the apps of all visitors.

    Args:
        server: Answers the requests.
        host: Host name or address to listen on.
        port: Port to listen on; 0 takes any free one.

    Raises:
        ConfigError: the address cannot be used.
    """
    logger = logging.getLogger(__name__)
    logger.addFilter(_is_no_wrong_request)
    runner = web.AppRunner(
        server.application(), access_log=None, logger=logger, shutdown_timeout=2 * END_WITHIN_S
    )
    await runner.setup()
    try:
        try:
            await web.TCPSite(runner, host or None, port).start()
        except OSError as error:
            raise _cannot_listen(host, port, error) from error
        yield runner.addresses[0][1]
    finally:
        await runner.cleanup()


def _is_no_wrong_request(record: logging.LogRecord) -> bool:
    """Return whether to log something: anybody can send a request that is not HTTP, which is no failure of ours."""
    return not (record.exc_info and isinstance(record.exc_info[1], HttpProcessingError))


def _note(ended_by: asyncio.Future[signal.Signals], number: signal.Signals) -> None:
    if not ended_by.done():
        ended_by.set_result(number)


def _cannot_listen(host: str, port: int, error: OSError) -> ConfigError:
    if error.errno == errno.EADDRINUSE:
        return ConfigError(
            f"port {port} is in use", "name another one, or 0 for any free one", key="--port"
        )
    if error.errno == errno.EACCES:
        return ConfigError(f"you may not use port {port}", "name one from 1024 on", key="--port")
    return ConfigError(
        f"cannot listen on {host}: {error.strerror or error}",
        "127.0.0.1 always works",
        key="--host",
    )
