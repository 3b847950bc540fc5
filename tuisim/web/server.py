"""The server: a page with a terminal, a socket for each visitor's app, static files and downloads."""

from __future__ import annotations

import asyncio
import errno
import logging
import signal
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from urllib.parse import quote

import textual_serve
from aiohttp import WSCloseCode, web
from aiohttp.http import HttpProcessingError
from aiohttp.typedefs import Handler, Middleware
from textual_serve.download_manager import DownloadManager

from tuisim.data_class import dataclass
from tuisim.errors import SIGNALLED, ConfigError, counted
from tuisim.web.gate import Gate
from tuisim.web.session import END_WITHIN_S, WebSession
from tuisim.web.visit import Visit

HEARTBEAT_S = 15.0
"""A browser that does not answer for about this time has gone."""
CLOSE_WITHIN_S = 2.0
"""Time for a browser to confirm that its socket is closed."""
_PAGE = Path(__file__).parent / "page"
_FONTS = Path(__file__).parent.parent / "charts" / "fonts"
_STATIC = Path(textual_serve.__file__).parent / "static"
_DEFAULT_SIZE = (80, 24)


@dataclass(frozen=True, slots=True)
class ServerLimits:
    """What visitors may use."""

    visitors: int
    """Most at the same time."""
    idle_s: float = float("inf")
    """A visitor that does nothing for this time is sent away."""
    patience_s: float = 3.0
    """How long a visitor waits for a place: a page that is loaded again has just left one."""


class Server:
    """Answers the requests of visitors.

    Args:
        command: The command of the app, as words.
        gate: Decides which requests are answered.
        limits: What visitors may use.
        report: Called with what an app that has failed wrote to stderr.
    """

    def __init__(
        self, command: Sequence[str], gate: Gate, limits: ServerLimits, report: Callable[[str], None] = lambda _: None
    ) -> None:
        self._command, self._gate, self._limits, self._report = command, gate, limits, report
        self._downloads = DownloadManager()
        self._visits: set[Visit] = set()
        self._place_is_free = asyncio.Condition()

    def application(self) -> web.Application:
        """Return the web application."""
        application = web.Application(middlewares=[self._guard()])
        top = f"/{self._gate.token}"
        application.add_routes(
            [
                web.get(top, self._to_page),
                web.get(f"{top}/", self._page),
                web.get(f"{top}/ws", self._socket),
                web.get(f"{top}/download/{{key}}", self._download),
                web.static(f"{top}/static", _STATIC),
                web.static(f"{top}/page", _PAGE),
                web.static(f"{top}/fonts", _FONTS),
            ]
        )
        application.on_response_prepare.append(_protect)
        application.on_shutdown.append(self._send_all_away)
        return application

    def _guard(self) -> Middleware:
        @web.middleware
        async def guard(request: web.Request, handler: Handler) -> web.StreamResponse:
            is_socket, origin = request.path.endswith("/ws"), request.headers.get("Origin")
            if self._gate.admits(request.path, request.host, origin, from_a_page=is_socket):
                return await handler(request)
            raise web.HTTPForbidden(text="Use the whole address that `tuisim serve` has printed.\n")

        return guard

    async def _to_page(self, request: web.Request) -> web.StreamResponse:
        raise web.HTTPFound(f"{request.path}/")

    async def _page(self, request: web.Request) -> web.StreamResponse:
        if await self._has_place():
            return web.FileResponse(_PAGE / "index.html")
        text = (_PAGE / "full.html").read_text("utf-8").replace("REASON", self._full)
        return web.Response(text=text, status=503, content_type="text/html", headers={"Retry-After": "10"})

    async def _socket(self, request: web.Request) -> web.StreamResponse:
        socket = web.WebSocketResponse(heartbeat=HEARTBEAT_S, timeout=CLOSE_WITHIN_S)
        await socket.prepare(request)
        if not await self._has_place():
            await socket.close(code=WSCloseCode.TRY_AGAIN_LATER, message=self._full.encode())
            return socket
        visit = Visit(WebSession(self._command, socket, self._downloads), socket, self._limits.idle_s, self._report)
        self._visits.add(visit)
        try:
            await visit.proceed(*_size(request))
        finally:
            self._visits.remove(visit)
            async with self._place_is_free:
                self._place_is_free.notify_all()
        return socket

    async def _has_place(self) -> bool:
        """Wait a little until there is room for one more visitor; return whether there is."""
        try:
            async with asyncio.timeout(self._limits.patience_s), self._place_is_free:
                await self._place_is_free.wait_for(lambda: len(self._visits) < self._limits.visitors)
        except TimeoutError:
            return False
        return True

    @property
    def _full(self) -> str:
        return f"This server allows {counted(self._limits.visitors, 'visitor')} at a time, and all places are taken."

    async def _download(self, request: web.Request) -> web.StreamResponse:
        key = request.match_info["key"]
        try:
            download = await self._downloads.get_download_metadata(key)
        except KeyError:
            raise web.HTTPNotFound(text="There is no such download.\n") from None
        response = web.StreamResponse()
        response.content_type = download.mime_type or "application/octet-stream"
        response.headers["Content-Disposition"] = f"attachment; filename*=UTF-8''{quote(download.file_name)}"
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

    async def _send_all_away(self, _: web.Application) -> None:
        await asyncio.gather(*(visit.end("The server has been ended.") for visit in self._visits))


async def _protect(request: web.Request, response: web.StreamResponse) -> None:
    """Let the page load nothing from elsewhere, be part of no other page, and keep its address to itself."""
    socket = request.url.with_scheme("wss" if request.secure else "ws").origin() if request.host else ""
    response.headers.update(
        {
            "Content-Security-Policy": "default-src 'self'; img-src 'self' data: blob:; "
            f"style-src 'self' 'unsafe-inline'; connect-src 'self' {socket}; "
            "form-action 'none'; base-uri 'none'; object-src 'none'; frame-ancestors 'none'",
            "Cross-Origin-Opener-Policy": "same-origin",
            "Cross-Origin-Resource-Policy": "same-origin",
            "Referrer-Policy": "no-referrer",
            "X-Content-Type-Options": "nosniff",
            "Cache-Control": "no-store",
            "Server": "tuisim",
        }
    )


def _size(request: web.Request) -> tuple[int, int]:
    """Return the size of the visitor's terminal in cells, as its page says."""
    try:
        return int(request.query["width"]), int(request.query["height"])
    except (KeyError, ValueError):
        return _DEFAULT_SIZE


def serve(server: Server, host: str, port: int, announce: Callable[[int], None]) -> int:
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


async def _serve(server: Server, host: str, port: int, announce: Callable[[int], None]) -> int:
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
async def listening(server: Server, host: str, port: int) -> AsyncIterator[int]:
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
    runner = web.AppRunner(server.application(), access_log=None, logger=logger, shutdown_timeout=2 * END_WITHIN_S)
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
        return ConfigError(f"port {port} is in use", "name another one, or 0 for any free one", key="--port")
    if error.errno == errno.EACCES:
        return ConfigError(f"you may not use port {port}", "name one from 1024 on", key="--port")
    return ConfigError(f"cannot listen on {host}: {error.strerror or error}", "127.0.0.1 always works", key="--host")
