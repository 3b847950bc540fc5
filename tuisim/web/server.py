"""The server: a page with a terminal, a socket for each visitor's app, static files and downloads."""

from __future__ import annotations

import asyncio
import atexit
import errno
import logging
import signal
from collections.abc import AsyncIterator, Callable, Coroutine, Mapping, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any, TypeVar
from urllib.parse import quote

import textual_serve
from aiohttp import ClientError, WSCloseCode, web
from aiohttp.http import HttpProcessingError
from aiohttp.typedefs import Handler
from textual_serve.download_manager import DOWNLOAD_CHUNK_SIZE, Download, DownloadManager

from tuisim.base.data_class import dataclass
from tuisim.base.errors import SIGNALLED, ConfigError, TuisimError, counted
from tuisim.web.gate import Door, Gate
from tuisim.web.link import close
from tuisim.web.session import END_WITHIN_S
from tuisim.web.uploads import Uploads
from tuisim.web.visit import Visit, VisitLimits

if TYPE_CHECKING:
    from textual_serve.app_service import AppService

ANSWER_WITHIN_S = 4.0
"""Seconds in which an app must send a requested piece of a file."""
MAX_OFFERED, MAX_KEY = 20, 100
"""The most files that an app can offer at a time, of which the oldest is withdrawn for a new one, and the most
characters of a key.
"""
_MAX_PIECE_BYTES = 4 * DOWNLOAD_CHUNK_SIZE
"""A text has up to 4 bytes for each character that is asked for."""


class Downloads(DownloadManager):
    """The files that apps offer for download; data that an app sends without a request is dropped."""

    def __init__(self) -> None:
        super().__init__()
        self._asked: dict[str, asyncio.Future[bytes | str]] = {}
        """The pieces that were requested from apps, by the keys of their files."""

    async def create_download(
        self, *, app_service: AppService, delivery_key: str, **about: Any
    ) -> None:
        """Offer a file, unless one with the same key is offered.

        If an app has too many offers, its first one is withdrawn.
        """
        if len(delivery_key) > MAX_KEY or delivery_key in self._active_downloads:
            return
        own = self._list_keys(app_service.app_service_id)
        if len(own) >= MAX_OFFERED:
            del self._active_downloads[own[0]]
        await super().create_download(app_service=app_service, delivery_key=delivery_key, **about)

    def take(self, key: str) -> Download:
        """Withdraw the offer of a file and return it.

        Raises:
            KeyError: no file is offered with this key.
        """
        return self._active_downloads.pop(key)

    async def read_pieces(self, download: Download) -> AsyncIterator[bytes]:
        """Yield the contents of a file piece by piece, each requested from the app.

        Raises:
            TimeoutError: the app does not send the next piece in time.
        """
        key = download.delivery_key
        request: dict[str, str | int | bool | None] = {
            "type": "deliver_chunk_request",
            "key": key,
            "size": DOWNLOAD_CHUNK_SIZE,
            "name": download.name,
        }
        while True:
            self._asked[key] = answer = asyncio.get_running_loop().create_future()
            try:
                if not await download.app_service.send_meta(request):
                    raise TimeoutError
                piece = await asyncio.wait_for(answer, ANSWER_WITHIN_S)
            finally:
                self._asked.pop(key, None)
            if not piece:
                return
            yield piece.encode(download.encoding or "utf-8") if isinstance(piece, str) else piece

    async def chunk_received(self, delivery_key: str, chunk: bytes | str) -> None:
        """Receive a piece of a file from an app, and pass it on to `read_pieces`, which has requested it."""
        answer = self._asked.get(delivery_key)
        if answer is not None and not answer.done() and len(chunk) <= _MAX_PIECE_BYTES:
            answer.set_result(chunk)

    async def cancel_app_downloads(self, app_service_id: str) -> None:
        """Withdraw all offers of an app."""
        for key in self._list_keys(app_service_id):
            del self._active_downloads[key]

    def _list_keys(self, app_service_id: str) -> list[str]:
        return [
            key
            for key, offered in self._active_downloads.items()
            if offered.app_service.app_service_id == app_service_id
        ]


_HEARTBEAT_S = 15.0
"""A browser that has not answered for about this time counts as gone."""
_CLOSE_WITHIN_S = 2.0
"""Time for a browser to confirm that its socket is closed."""
_PIECE = 1 << 18
"""Bytes of an uploaded file that are written at a time."""
PAGE = Path(__file__).parent / "page"
_FOLDERS = {
    "static": Path(textual_serve.__file__).parent / "static",
    "page": PAGE,
    "fonts": Path(__file__).parent.parent / "pictures" / "charts" / "fonts",
}
"""Folders of files that every visitor gets, by name."""
_REFUSAL = "This address is wrong; `tuisim serve` prints the right one.\n"
_REFUSAL_PAGE = f"""\
<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><title>tuisim</title>
<style>:root {{ color-scheme: dark }} body {{ font: 18px/1.5 system-ui, sans-serif; margin: 20vh auto 0;
max-width: 30em; padding: 0 1em }}</style>
<p>{_REFUSAL.replace("`tuisim serve`", "<code>tuisim serve</code>").strip()}
</html>
"""
_DEFAULT_SIZE = (80, 24)
_Result = TypeVar("_Result")


@dataclass(frozen=True, slots=True)
class ServerLimits:
    """Limits of a server: how many apps may run, and for how long."""

    visitors: int
    """The most apps at the same time, including those that no browser tab shows now; further visitors are refused."""
    visit: VisitLimits = VisitLimits()
    """How long each visitor's app can last without use or without a browser."""


class Server:
    """A web server that starts an app for each visitor.

    Args:
        command: The command of the app, as words.
        gate: Decides which requests are answered.
        limits: The limits for visitors.
        report: Called with the error output of an app that has failed.
    """

    def __init__(
        self,
        command: Sequence[str],
        gate: Gate,
        limits: ServerLimits,
        report: Callable[[str], None] = lambda _: None,
    ) -> None:
        self._command = command
        self._limits = limits
        self._report = report
        self.gate = gate
        self._downloads, self._uploads = Downloads(), Uploads()
        self.door = Door(report)
        """The listening socket of the server."""
        self._visits: dict[str, Visit] = {}
        self._lives: dict[str, asyncio.Task[None]] = {}

    def build_application(self) -> web.Application:
        """Return the web application; it answers every request that the gate refuses with `403 Forbidden`."""
        application = web.Application(middlewares=[self._guard])
        # The router accepts any token, which may change; the gate compares it.
        application.router.add_routes(
            [
                web.get("/{token}", _redirect),
                web.get("/{token}/", self._handle_page),
                web.get("/{token}/ws", self._handle_socket),
                web.get("/{token}/sessions", self._handle_list),
                web.post("/{token}/sessions/{id}/end", self._handle_end),
                web.post("/{token}/sessions/{id}/file", self._handle_upload),
                web.get("/{token}/download/{key}", self._handle_download),
                web.get(
                    f"/{{token}}/{{folder:{'|'.join(_FOLDERS)}}}/{{name:.+}}", _handle_page_file
                ),
            ]
        )
        application.on_response_prepare.append(self._protect)
        application.on_shutdown.append(self.send_all_away)
        return application

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        # A request that changes something must come from a page of this server.
        acts = request.path.endswith("/ws") or request.method == "POST"
        origin = request.headers.get("Origin")
        if self.gate.is_allowed(request.path, request.host, origin, from_a_page=acts):
            self.door.admit(request)
            return await handler(request)
        if "text/html" in request.headers.get("Accept", ""):
            raise web.HTTPForbidden(text=_REFUSAL_PAGE, content_type="text/html")
        raise web.HTTPForbidden(text=_REFUSAL)

    async def _protect(self, request: web.Request, response: web.StreamResponse) -> None:
        """Set the security headers of a response.

        The page may load nothing from other sites. Only the sites that the gate names may show it in a frame. Its
        address, which contains the token, is not sent to other sites.
        """
        sockets = f"ws://{request.host} wss://{request.host}" if request.host else ""
        response.headers.update(
            {
                "Content-Security-Policy": "default-src 'self'; img-src 'self' data: blob:; "
                f"style-src 'self' 'unsafe-inline'; connect-src 'self' {sockets}; form-action 'none'; "
                f"base-uri 'none'; object-src 'none'; frame-ancestors {self.gate.framed_by}",
                "Cross-Origin-Opener-Policy": "same-origin",
                "Cross-Origin-Resource-Policy": "same-origin",
                "Referrer-Policy": "no-referrer",
                "X-Content-Type-Options": "nosniff",
                "Cache-Control": "no-store",
                "Server": "tuisim",
            }
        )

    async def _handle_page(self, _: web.Request) -> web.StreamResponse:
        return web.FileResponse(PAGE / "index.html")

    async def _handle_list(self, _: web.Request) -> web.StreamResponse:
        sessions = [visit.to_plain() for visit in self._visits.values()]
        return web.json_response({"sessions": sessions, "free": self._free})

    @property
    def _free(self) -> int:
        return self._limits.visitors - len(self._visits)

    async def _handle_socket(self, request: web.Request) -> web.StreamResponse:
        socket = web.WebSocketResponse(heartbeat=_HEARTBEAT_S, timeout=_CLOSE_WITHIN_S)
        await socket.prepare(request)
        session_id = request.query.get("session")
        size = _read_size(request)
        visit = (
            await self.begin(*size, socket) if session_id is None else self._visits.get(session_id)
        )
        if visit is not None:
            if session_id is not None:
                await visit.replace_socket(socket, *size)
            await visit.follow(socket)
        elif session_id is None:
            places = counted(self._limits.visitors, "visitor")
            reason = f"This server allows {places} at a time, and all places are taken."
            await close(socket, reason, WSCloseCode.TRY_AGAIN_LATER)
        else:
            await close(socket, "The session has ended.")
        return socket

    async def begin(
        self,
        width: int,
        height: int,
        socket: web.WebSocketResponse | None = None,
        on_message: Callable[[Mapping[str, Any]], None] | None = None,
    ) -> Visit | None:
        """Start an app for a visitor and return the visit; return None if the largest number of apps runs already.

        If one of these apps is ending, wait until it has ended, and then start the new app.

        Args:
            width: Columns of the visitor's terminal.
            height: Rows of the visitor's terminal.
            socket: The connection to the browser that shows the app from its first frame; None for none yet.
            on_message: Called with each message of the app from its start on; see `Visit.listen`.
        """
        while self._free <= 0:
            ending = [life for id_, life in self._lives.items() if self._visits[id_].is_ending]
            if not ending:
                return None
            await asyncio.wait(ending, return_when=asyncio.FIRST_COMPLETED)
        visit = Visit(self._command, self._downloads, self._limits.visit, self._report)
        self._visits[visit.id] = visit
        if on_message is not None:
            visit.listen(on_message)
        if socket is not None:
            await visit.take(socket)
        has_begun = asyncio.Event()

        async def run_visit() -> None:
            try:
                await visit.run(width, height, has_begun.set)
            finally:
                del self._visits[visit.id], self._lives[visit.id]

        self._lives[visit.id] = asyncio.create_task(run_visit())
        await has_begun.wait()
        return visit

    def _find_visit(self, request: web.Request) -> Visit:
        try:
            return self._visits[request.match_info["id"]]
        except KeyError:
            raise web.HTTPNotFound(text="There is no such session.\n") from None

    async def _handle_end(self, request: web.Request) -> web.StreamResponse:
        self._find_visit(request).end("Another tab has ended this session.")
        raise web.HTTPNoContent

    async def _handle_upload(self, request: web.Request) -> web.StreamResponse:
        visit, name = self._find_visit(request), request.query.get("name", "")
        try:
            pieces = request.content.iter_chunked(_PIECE)
            path = await self._uploads.take(Path.cwd(), name, pieces)
        except TuisimError as error:
            raise web.HTTPBadRequest(text=f"{error}\n") from None
        except (ConnectionError, ClientError):
            # The visitor disconnected before the file was complete.
            raise web.HTTPBadRequest from None
        await visit.open_file(path)
        return web.json_response({"name": path.name})

    async def _handle_download(self, request: web.Request) -> web.StreamResponse:
        key = request.match_info["key"]
        try:
            download = self._downloads.take(key)
        except KeyError:
            raise web.HTTPNotFound(text="There is no such download.\n") from None
        response = web.StreamResponse()
        response.content_type = download.mime_type or "application/octet-stream"
        response.headers["Content-Disposition"] = (
            f"attachment; filename*=UTF-8''{quote(download.file_name)}"
        )
        await response.prepare(request)
        try:
            async for piece in self._downloads.read_pieces(download):
                await response.write(piece)
        except TimeoutError:
            # The app has not sent the rest in time: the browser must not take the part for the whole file.
            if request.transport is not None:
                request.transport.abort()
            return response
        await response.write_eof()
        return response

    async def send_all_away(self, _: object = None) -> None:
        """End the visits and apps of all visitors."""
        for visit in self._visits.values():
            visit.end("The server has stopped.")
        await asyncio.gather(*self._lives.values())

    def serve(self, host: str, port: int, announce: Callable[[int], None]) -> int:
        """Serve until a signal stops the server and the apps of all visitors. Return the exit code.

        Args:
            host: Host name or address to listen on.
            port: Port to listen on; 0 takes any free one.
            announce: Called with the port as soon as the server accepts requests.

        Raises:
            ConfigError: the address cannot be used.
        """
        return asyncio.run(_serve(self, host, port, announce))


async def _redirect(request: web.Request) -> web.StreamResponse:
    """Redirect a request to the page's address with a slash at its end, to which addresses in the page are relative."""
    raise web.HTTPFound(f"{request.rel_url.raw_path}/")


async def _handle_page_file(request: web.Request) -> web.StreamResponse:
    folder = _FOLDERS[request.match_info["folder"]].resolve()
    try:
        path = (folder / request.match_info["name"]).resolve(strict=True)
    except (OSError, ValueError):
        raise web.HTTPNotFound from None
    if not path.is_relative_to(folder) or not path.is_file():
        raise web.HTTPNotFound
    return web.FileResponse(path)


def _read_size(request: web.Request) -> tuple[int, int]:
    """Return columns and rows of the visitor's terminal from a request, or default values if it has none."""
    try:
        return int(request.query["width"]), int(request.query["height"])
    except (KeyError, ValueError):
        return _DEFAULT_SIZE


async def _serve(server: Server, host: str, port: int, announce: Callable[[int], None]) -> int:
    loop = asyncio.get_running_loop()
    ended_by: asyncio.Future[signal.Signals] = loop.create_future()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        loop.add_signal_handler(number, _note, ended_by, number)
    async with run_server(server, host, port) as actual_port:
        announce(actual_port)
        number = await ended_by
    # ctrl+c is the usual way to end the server, so it is no failure.
    return 0 if number is signal.SIGINT else SIGNALLED + number


@asynccontextmanager
async def run_server(server: Server, host: str, port: int) -> AsyncIterator[int]:
    """Answer requests during an `async with` block, which gets the port; at its end, end the apps of all visitors.

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
        server.build_application(),
        access_log=None,
        logger=logger,
        shutdown_timeout=2 * END_WITHIN_S,
    )
    await runner.setup()
    stack = AsyncExitStack()
    try:
        try:
            assert runner.server is not None
            door = server.door.open(runner.server, host or None, port)
            actual_port = await stack.enter_async_context(door)
        except OSError as error:
            raise _build_listen_error(host, port, error) from error
        yield actual_port
    finally:
        await stack.aclose()
        await runner.cleanup()


def _is_no_wrong_request(record: logging.LogRecord) -> bool:
    """Return False for a log record that only says that a request is not HTTP: anybody can send such a request.

    The result is True for all other records, which are then logged.
    """
    return not (record.exc_info and isinstance(record.exc_info[1], HttpProcessingError))


def _note(ended_by: asyncio.Future[signal.Signals], number: signal.Signals) -> None:
    if not ended_by.done():
        ended_by.set_result(number)


def _build_listen_error(host: str, port: int, error: OSError) -> ConfigError:
    if error.errno == errno.EADDRINUSE:
        return ConfigError(
            f"port {port} is in use", "choose another one, or 0 for any free one", key="--port"
        )
    if error.errno == errno.EACCES:
        return ConfigError(f"you may not use port {port}", "choose one from 1024", key="--port")
    return ConfigError(
        f"cannot listen on {host}: {error.strerror or error}",
        "127.0.0.1 always works",
        key="--host",
    )


class BackgroundServer:
    """A server that runs in its own thread, on a free port of this machine only.

    Args:
        server: Answers the requests.
    """

    def __init__(self, server: Server) -> None:
        self.server = server
        self._loop = asyncio.new_event_loop()
        self._thread = Thread(target=self._loop.run_forever, name="tuisim-server", daemon=True)
        self._thread.start()
        self.port: int = self.call(self._listen())
        # The daemon thread stops with this process without cleanup, so the apps are ended here.
        atexit.register(self.close)

    async def _listen(self) -> int:
        self._listening = run_server(self.server, "127.0.0.1", 0)
        return await self._listening.__aenter__()

    def call(self, work: Coroutine[Any, Any, _Result], timeout_s: float | None = None) -> _Result:
        """Run a coroutine in the server's thread, wait for it and return its result.

        Raises:
            TimeoutError: it takes longer than `timeout_s`.
        """
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(timeout_s)

    def close(self) -> None:
        """End the apps of all visitors and the server."""
        if self._thread.is_alive():
            self.call(self._listening.__aexit__(None, None, None))
            self._loop.call_soon_threadsafe(self._loop.stop)
            self._thread.join()
            self._loop.close()
        atexit.unregister(self.close)
