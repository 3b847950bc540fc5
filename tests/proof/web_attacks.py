"""Attacks on the server: each is refused, or costs no more than the connection, and a visitor is served afterwards."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import resource
import sys
from asyncio.subprocess import PIPE
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping, Sequence
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from pathlib import Path

from aiohttp import ClientError, ClientSession, WSMsgType

from tests.proof.kind import FaultError
from tests.running import PATIENCE_S
from tests.web.stand_in import stand_in
from tuisim.web.gate import Gate
from tuisim.web.server import Server, ServerLimits, run_server
from tuisim.web.visit import VisitLimits

TOKEN = "the-token"
_VISITORS = 3


class Target:
    """A server under attack."""

    def __init__(self, client: ClientSession, port: int) -> None:
        self.client = client
        self.port = port
        self.origin = f"http://127.0.0.1:{port}"

    async def answer(self, request: bytes) -> bytes:
        """Send bytes; return what comes back until the server closes, at most its head."""
        reader, writer = await asyncio.open_connection("127.0.0.1", self.port)
        try:
            writer.write(request)
            await writer.drain()
            return await asyncio.wait_for(reader.read(4096), PATIENCE_S)
        except ConnectionError:
            return b""
        finally:
            writer.close()

    async def refused(self, method: str, path: str, **headers: str) -> None:
        """Check that a request is refused."""
        async with self.client.request(method, self.origin + path, headers=headers) as found:
            if found.status < 400:
                raise FaultError(f"{method} {path} {headers}: {found.status}")

    async def visits(self) -> None:
        """Check that a visitor gets an app."""
        url = f"{self.origin}/{TOKEN}/ws"
        give_up = asyncio.get_running_loop().time() + PATIENCE_S
        while True:
            async with self.client.ws_connect(url, headers={"Origin": self.origin}) as socket:
                while (message := await socket.receive(PATIENCE_S)).type is WSMsgType.TEXT:
                    pass
                if message.type is WSMsgType.BINARY:
                    return
            # A place may not be free yet.
            if asyncio.get_running_loop().time() > give_up:
                raise FaultError(f"a visitor gets {message}")


async def _paths(target: Target) -> None:
    for path in (
        "../../etc/passwd",
        "..%2f..%2fetc/passwd",
        "page/%2e%2e/%2e%2e/server.py",
        "static//etc/passwd",
        "static/..%5c..%5cx",
        "download/../../x",
        "download/%00",
        "fonts/..%2f..%2f..%2fcli.py",
    ):
        head = await target.answer(
            f"GET /{TOKEN}/{path} HTTP/1.1\r\nHost: 127.0.0.1:{target.port}\r\nConnection: close\r\n\r\n".encode()
        )
        if b" 200 " in head.split(b"\r\n")[0]:
            raise FaultError(f"{path}: {head[:200]!r}")


async def _methods(target: Target) -> None:
    for method in ("POST", "PUT", "DELETE", "PATCH", "TRACE", "PROPFIND"):
        await target.refused(method, f"/{TOKEN}/")
        await target.refused(method, f"/{TOKEN}/ws")


async def _actions(target: Target) -> None:
    """What ends a session or brings a file is done by a page of the server only."""
    url = f"{target.origin}/{TOKEN}/ws"
    async with target.client.ws_connect(url, headers={"Origin": target.origin}) as socket:
        session = json.loads((await socket.receive(PATIENCE_S)).data)[1]
        for what in ("end", "file?name=x.py"):
            path = f"/{TOKEN}/sessions/{session}/{what}"
            await target.refused("GET", path)
            await target.refused("POST", path)
            await target.refused("POST", path, Origin="http://evil.example")
            await target.refused("POST", path.replace(TOKEN, "other"), Origin=target.origin)
        for name in ("", "..", "../x.py", "%2e%2e%2fx.py", "/etc/x", ".x", "a%00b", "a" * 999):
            await target.refused(
                "POST", f"/{TOKEN}/sessions/{session}/file?name={name}", Origin=target.origin
            )
        for other in ("", "x", "%2e%2e", session[:-1], session.upper() + "0"):
            await target.refused("POST", f"/{TOKEN}/sessions/{other}/end", Origin=target.origin)
        await socket.send_str('["ping", "1"]')
        while (message := await socket.receive(PATIENCE_S)).data != '["pong", "1"]':
            if message.type is WSMsgType.CLOSE:
                raise FaultError("somebody else has ended a session")


async def _headers(target: Target) -> None:
    """What a browser is allowed, whatever is asked for; and who has no token is not told it."""
    for path in (
        f"/{TOKEN}/",
        f"/{TOKEN}",
        f"/{TOKEN}/page/none",
        f"/{TOKEN}/download/none",
        "/x/",
        "/",
    ):
        async with target.client.get(target.origin + path, allow_redirects=False) as found:
            if wrong := [
                f"{name}: {found.headers.get(name)}"
                for name, words in _ALLOWED.items()
                if not all(word in found.headers.get(name, "") for word in words)
            ]:
                raise FaultError(f"{path}: {wrong}")
            if TOKEN not in path and TOKEN in f"{found.headers} {await found.text()}":
                raise FaultError(f"{path}: it tells the token")


_ALLOWED: Mapping[str, Sequence[str]] = {
    "Content-Security-Policy": (
        "default-src 'self'",
        "frame-ancestors 'none'",
        "base-uri 'none'",
        "object-src 'none'",
    ),
    "Cross-Origin-Opener-Policy": ("same-origin",),
    "Cross-Origin-Resource-Policy": ("same-origin",),
    "Referrer-Policy": ("no-referrer",),
    "X-Content-Type-Options": ("nosniff",),
    "Cache-Control": ("no-store",),
}
"""Headers of every answer, with what each must hold."""


_CONNECT = """\
import resource, socket, sys
hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
opened = []
for _ in range(int(sys.argv[2])):
    opened.append(socket.create_connection(("127.0.0.1", int(sys.argv[1]))))
print(flush=True)
sys.stdin.read()
"""


@asynccontextmanager
async def _many_connections(target: Target, room: int, count: int) -> AsyncIterator[None]:
    """Let another process open connections and ask nothing, while this one may open so many more descriptors."""
    most, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    words = (sys.executable, "-c", _CONNECT, str(target.port), str(count))
    other = await asyncio.create_subprocess_exec(*words, stdin=PIPE, stdout=PIPE)
    assert other.stdin is not None and other.stdout is not None
    resource.setrlimit(resource.RLIMIT_NOFILE, (len(os.listdir("/proc/self/fd")) + room, hard))
    try:
        await asyncio.wait_for(other.stdout.readline(), _CONNECT_S)
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))
        other.kill()
        await other.wait()


_CONNECT_S = 10.0


async def _connections(target: Target) -> None:
    """More connections that never ask than the server may have descriptors."""
    # asyncio lets a hundred in, and their transports begin in its next turn, before the oldest ones can be closed.
    async with _many_connections(target, 400, 900):
        await target.visits()


async def _descriptors(target: Target) -> None:
    """A server that has no descriptors left, which it tells once."""
    async with _many_connections(target, 20, 100):
        await asyncio.sleep(3)


async def _silent(target: Target) -> None:
    """A connection that asks for nothing is closed."""
    reader, writer = await asyncio.open_connection("127.0.0.1", target.port)
    if await asyncio.wait_for(reader.read(), 20):
        raise FaultError("who asks for nothing gets an answer")
    writer.close()


async def _uploads(target: Target) -> None:
    """Files that are cut off, too large, or have names that are too long."""
    url = f"{target.origin}/{TOKEN}/ws"
    async with target.client.ws_connect(url, headers={"Origin": target.origin}) as socket:
        session = json.loads((await socket.receive(PATIENCE_S)).data)[1]
        path = f"/{TOKEN}/sessions/{session}/file"
        before = _resident_mb()
        writers = []
        for number in range(_CUT):
            _, writer = await asyncio.open_connection("127.0.0.1", target.port)
            writers.append(writer)
            writer.write(
                f"POST {path}?name=cut{number}.py HTTP/1.1\r\nHost: 127.0.0.1:{target.port}\r\n"
                f"Origin: {target.origin}\r\nContent-Length: 60000000\r\n\r\n".encode()
                + bytes(_CUT_MB << 20)
            )
            await writer.drain()
        name = "\N{LATIN SMALL LETTER E WITH ACUTE}" * 190
        sent = {"Origin": target.origin}
        async with target.client.post(
            f"{target.origin}{path}", params={"name": name}, data=b"x", headers=sent
        ) as answer:
            said = await answer.text()
        if answer.status != 400 or "not a name for a file" not in said or os.getcwd() in said:
            raise FaultError(f"a name that is too long: {answer.status} {said[:500]}")
        if _resident_mb() - before > _CUT * _CUT_MB / 2:
            raise FaultError(f"uploads take {_resident_mb() - before:.0f} MB")
        for writer in writers:
            writer.transport.abort()
        await target.visits()
    if left := [name for name in os.listdir() if name.startswith("cut")]:
        raise FaultError(f"uploads that were cut off have left {left}")


_CUT = 20
_CUT_MB = 8
"""Uploads at the same time, and what of each has come."""


def _resident_mb() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / (1 << 20)


async def _unasked(target: Target) -> None:
    """An app that offers files and sends pieces of them that nobody has asked for."""
    url = f"{target.origin}/{TOKEN}/ws"
    before = _resident_mb()
    async with target.client.ws_connect(url, headers={"Origin": target.origin}) as socket:
        for word in ("offer", "flood"):
            await socket.send_json(["stdin", word])
        while (message := await socket.receive(PATIENCE_S)).data != b"flooded":
            if message.type is WSMsgType.CLOSE:
                raise FaultError(f"the app has ended: {message.extra}")
        if (growth_mb := _resident_mb() - before) > 50:
            raise FaultError(f"what an app sends unasked takes {growth_mb:.0f} MB")


async def _heads(target: Target) -> None:
    for request in (
        b"\0" * 5000,
        b"GET\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"A" * 100_000 + b"\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: x\r\n" + b"X: y\r\n" * 20_000 + b"\r\n",
        b"POST /the-token/ HTTP/1.1\r\nHost: x\r\nContent-Length: -1\r\n\r\n",
        b"POST /the-token/ HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n"
        b"Content-Length: 3\r\n\r\nFFFFFFFFF\r\n",
        b"GET /\x1b[2J\xff HTTP/1.1\r\nHost: \x1b]0;x\x07\r\n\r\n",
    ):
        head = await target.answer(request)
        if head and b" 4" not in head.split(b"\r\n")[0]:
            raise FaultError(f"{request[:60]!r}: {head[:100]!r}")


async def _frames(target: Target) -> None:
    """Frames of a visitor that are too large, or make no sense."""
    url = f"{target.origin}/{TOKEN}/ws"
    for sent in (
        "x" * 20_000_000,
        '["stdin", ' + '"x' * 10,
        '["resize", {"width": 1e999}]',
        '["' + "a" * 99_999 + '"]',
        '["act", ["run"]]',
        '["act", "' + "a" * 99_999 + '"]',
    ):
        # The server may end the connection before it has all.
        with suppress(ClientError, ConnectionError):
            async with target.client.ws_connect(url, headers={"Origin": target.origin}) as socket:
                await socket.receive(PATIENCE_S)
                await socket.send_str(sent)
                await socket.send_str('["ping", "1"]')


ATTACKS: Mapping[str, Callable[[Target], Awaitable[None]]] = {
    "paths": _paths,
    "methods": _methods,
    "actions": _actions,
    "headers": _headers,
    "connections": _connections,
    "heads": _heads,
    "frames": _frames,
    "descriptors": _descriptors,
    "silent": _silent,
    "uploads": _uploads,
    "unasked": _unasked,
}
"""By name."""


class _Logged(logging.Handler):
    """Keeps what a log would write to the server's terminal."""

    def __init__(self, reports: list[str]) -> None:
        super().__init__()
        self._reports = reports

    def emit(self, record: logging.LogRecord) -> None:
        """Keep a record."""
        if len(self._reports) < 5:
            self._reports.append(self.format(record)[-1000:])


async def _attack(name: str) -> None:
    reports: list[str] = []
    logged = _Logged(reports)
    async with AsyncExitStack() as stack:
        for logger in map(logging.getLogger, ("asyncio", "tuisim.web.server")):
            logger.addHandler(logged)
            stack.callback(logger.removeHandler, logged)
        limits = ServerLimits(_VISITORS, VisitLimits(PATIENCE_S, 0.0))
        server = Server(stand_in(), Gate("127.0.0.1", TOKEN), limits, reports.append)
        port = await stack.enter_async_context(run_server(server, "127.0.0.1", 0))
        target = Target(await stack.enter_async_context(ClientSession()), port)
        await ATTACKS[name](target)
        await target.visits()
    if (
        name == "descriptors"
        and len(reports) == 1
        and reports[0].startswith("The server cannot accept")
    ):
        return
    if reports:
        raise FaultError(f"the server's terminal gets {reports}")


def check_attack(name: str) -> None:
    """Attack a server, and visit it afterwards."""
    asyncio.run(asyncio.wait_for(_attack(name), PATIENCE_S))
