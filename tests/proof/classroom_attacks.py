"""Attacks on a class: by strangers, by a student on another and on the tutor's page, and by who may only look on."""

from __future__ import annotations

import asyncio
import json
import os
from collections.abc import Awaitable, Callable, Mapping
from contextlib import AsyncExitStack
from pathlib import Path
from tempfile import TemporaryDirectory

from aiohttp import ClientSession, ClientWebSocketResponse, WSMsgType, WSServerHandshakeError

from tests.proof.kind import FaultError
from tests.running import PATIENCE_S
from tests.web.stand_in import stand_in
from tuisim.web.class_links import open_class
from tuisim.web.classroom import Classroom
from tuisim.web.server import ServerLimits, listening
from tuisim.web.session import Place
from tuisim.web.visit import VisitLimits

PATHS = (
    "",
    "students",
    "sessions",
    "view/Ada/",
    "view/Bob/",
    "page/classroom.js",
    "static/js/textual.js",
    "download/key",
)
_ORIGINS = ("http://evil.example", "null", "", "http://127.0.0.1:1", "file://")


class Target:
    """A class of two under attack: Ada works, Bob attacks."""

    def __init__(
        self, client: ClientSession, port: int, folder: Path, tokens: Mapping[str, str]
    ) -> None:
        self.client, self.port, self.folder, self.tokens = client, port, folder, tokens
        self.origin = f"http://127.0.0.1:{port}"
        self.ada: ClientWebSocketResponse
        self.session = ""
        """Ada's."""

    def of(self, who: str, path: str = "") -> str:
        """Return the address of a path for whom a secret part belongs to."""
        return f"{self.origin}/{self.tokens[who]}/{path}"

    async def begin(self) -> None:
        """Let Ada begin."""
        self.ada = await self.socket(self.of("Ada", "ws"))
        self.session = json.loads((await self.ada.receive(PATIENCE_S)).data)[1]

    async def works(self) -> None:
        """Check that Ada's app does what she types, and nothing else: it echoes what it gets."""
        await self.ada.send_json(["stdin", "hers"])
        shown = ""
        while shown != "hers":
            message = await self.ada.receive(PATIENCE_S)
            if message.type is WSMsgType.BINARY:
                shown = message.data.decode()
                if not shown.startswith(("hers", "pid ", '{"type": "show"', '{"type": "resize"')):
                    raise FaultError(f"her app gets {shown!r}")
            elif message.type is not WSMsgType.TEXT:
                raise FaultError(f"her app has ended: {message}")
        if found := [path.name for path in (self.folder / "Ada").iterdir()]:
            raise FaultError(f"her folder has {found}")

    async def socket(self, url: str, origin: str | None = None) -> ClientWebSocketResponse:
        return await self.client.ws_connect(
            url, headers={"Origin": self.origin if origin is None else origin}
        )

    async def no_socket(self, url: str, origin: str | None = None) -> None:
        """Check that a socket is refused."""
        try:
            socket = await self.socket(url, origin)
        except WSServerHandshakeError as error:
            if error.status not in (403, 404):
                raise FaultError(f"{url}: {error.status}") from None
            return
        await socket.close()
        raise FaultError(f"a socket {url} of {origin!r} is accepted")

    async def refused(self, method: str, url: str, **headers: str) -> tuple[int, str]:
        """Check that a request is refused; return status and text."""
        async with self.client.request(
            method, url, headers=headers, allow_redirects=False
        ) as found:
            if found.status not in (400, 403, 404, 405):
                raise FaultError(f"{method} {url} {headers}: {found.status}")
            return found.status, await found.text()


async def _wrong_secrets(target: Target) -> None:
    """Secrets that are almost those of somebody, or in another place."""
    for token in target.tokens.values():
        for wrong in (
            token[:-1],
            f"{token}x",
            token.swapcase(),
            "",
            "%00",
            f"{token}%00",
            f"..%2f{token}",
        ):
            for path in PATHS:
                await target.refused("GET", f"{target.origin}/{wrong}/{path}")
            await target.no_socket(f"{target.origin}/{wrong}/ws")
        await target.refused("GET", f"{target.origin}/?token={token}")
        await target.refused(
            "GET", f"{target.origin}/x/", Authorization=f"Bearer {token}", Cookie=f"token={token}"
        )


async def _stolen_elsewhere(target: Target) -> None:
    """A page of another site that knows a secret."""
    for origin in _ORIGINS:
        for who in target.tokens:
            await target.no_socket(target.of(who, "ws"), origin)
        await target.no_socket(target.of("tutor", "view/Ada/ws"), origin)
        for what in ("end", "file?name=x.py"):
            await target.refused(
                "POST", target.of("Ada", f"sessions/{target.session}/{what}"), Origin=origin
            )
        for what in ("end", "link"):
            await target.refused("POST", target.of("tutor", f"students/Ada/{what}"), Origin=origin)
    for path in PATHS:
        await target.refused("GET", target.of("tutor", path), Origin="http://evil.example")
        await target.refused("GET", target.of("tutor", path), Host="evil.example")


async def _tutors_page(target: Target) -> None:
    """A student asks for what is the tutor's, and is told no more than a stranger."""
    for path in (
        "students",
        "view/Ada/",
        "view/Ada",
        "view/Bob/",
        "view/Ada/page/view.js",
        "view/Eve/",
    ):
        stranger = await target.refused("GET", f"{target.origin}/wrong/{path}")
        if await target.refused("GET", target.of("Bob", path)) != stranger:
            raise FaultError(f"{path}: a student is told more than a stranger")
    for path in ("view/Ada/ws", "view/Bob/ws"):
        await target.no_socket(target.of("Bob", path))
    for who in ("Ada", "Bob"):
        for what in ("end", "link"):
            await target.refused(
                "POST", target.of(who, f"students/Bob/{what}"), Origin=target.origin
            )


async def _another_session(target: Target) -> None:
    """A student who has learned the number of another's session."""
    for what in ("end", "file?name=x.py"):
        for who in ("Bob", "tutor"):
            await target.refused(
                "POST", target.of(who, f"sessions/{target.session}/{what}"), Origin=target.origin
            )
    socket = await target.socket(target.of("Bob", f"ws?session={target.session}"))
    message = await socket.receive(PATIENCE_S)
    if message.type is not WSMsgType.CLOSE:
        raise FaultError(f"another's session is opened: {message}")
    async with target.client.get(target.of("Bob", "sessions")) as answer:
        if (await answer.json())["sessions"]:
            raise FaultError("a student sees another's session")


async def _another_download(target: Target) -> None:
    """What one student is offered is of no use to another, who knows its key."""
    await target.ada.send_json(["stdin", "offer"])
    while (message := await target.ada.receive(PATIENCE_S)).data != '["deliver_file_start", "key"]':
        if message.type is WSMsgType.CLOSE:
            raise FaultError("her app has ended")
    for who in ("Bob", "tutor"):
        await target.refused("GET", target.of(who, "download/key"))


async def _paths(target: Target) -> None:
    """Paths that lead out of what a page loads, or to the folders of the class."""
    for path in (
        "../../etc/passwd",
        "..%2f..%2fetc/passwd",
        "page/%2e%2e/classroom.py",
        "page/..%2f..%2fclassroom.py",
        "static//etc/passwd",
        "view/..%2f..%2f.links.json/",
        "view/Ada/page/%2e%2e/%2e%2e/classroom.py",
        "view/%2e%2e/",
        "view/%2fetc%2fpasswd/",
        "view/.links.json/",
        "view/.homes/",
        "view/%00/",
        "view/Ada/../../.links.json",
        "view/Ada%2f..%2fBob/",
        "page/.links.json",
    ):
        for who in ("Bob", "tutor"):
            rest = f"HTTP/1.1\r\nHost: 127.0.0.1:{target.port}\r\nConnection: close\r\n\r\n"
            reader, writer = await asyncio.open_connection("127.0.0.1", target.port)
            writer.write(f"GET /{target.tokens[who]}/{path} {rest}".encode())
            await writer.drain()
            first = (await asyncio.wait_for(reader.read(4096), PATIENCE_S)).split(b"\r\n")[0]
            writer.close()
            if b" 4" not in first:
                raise FaultError(f"{who} {path}: {first!r}")


async def _names_of_files(target: Target) -> None:
    """Files that are brought under names that lead to another's folder."""
    bob = await target.socket(target.of("Bob", "ws"))
    session = json.loads((await bob.receive(PATIENCE_S)).data)[1]
    for name in (
        "../Ada/x.py",
        "..%2fAda%2fx.py",
        "%2e%2e/Ada/x.py",
        "..%5cAda%5cx.py",
        ".links.json",
        "/etc/x",
        "a%00b",
    ):
        url = target.of("Bob", f"sessions/{session}/file?name={name}")
        await target.refused("POST", url, Origin=target.origin)
    (target.folder / "Bob" / "way.py").symlink_to(target.folder / "Ada" / "x.py")
    url = target.of("Bob", f"sessions/{session}/file?name=way.py")
    async with target.client.post(url, data=b"x", headers={"Origin": target.origin}):
        pass


async def _who_looks_on(target: Target) -> None:
    """Who may only look on sends keys, the mouse, sizes, actions and nonsense."""
    view = await target.socket(target.of("tutor", "view/Ada/ws"))
    sent: object
    for sent in (
        ["stdin", "rm"],
        ["stdin", "\x1b[<0;5;5M"],
        ["resize", {"width": 3, "height": 3}],
        ["act", "run"],
        ["focus"],
        ["blur"],
        ["ping", "1"],
        ["session", "x"],
        [],
        {},
        "stdin",
        5,
    ):
        await view.send_json(sent)
    for text in ("", "[", "\x00", "[" * 10_000):
        await view.send_str(text)
    await view.send_bytes(b'["stdin", "rm"]')
    await target.works()
    await view.close()


async def _many_who_look_on(target: Target) -> None:
    """Browsers that look on and never read do not hold the app up."""
    views = [await target.socket(target.of("tutor", "view/Ada/ws")) for _ in range(20)]
    for _ in range(20):
        await target.works()
    for view in views:
        await view.close()


async def _framing(target: Target) -> None:
    """No other site shows the pages of a class in a frame, or reads them."""
    for who, path in (("tutor", ""), ("tutor", "students"), ("tutor", "view/Ada/"), ("Bob", "")):
        async with target.client.get(target.of(who, path)) as found:
            if "frame-ancestors 'none'" not in found.headers["Content-Security-Policy"]:
                raise FaultError(f"{path} may be framed")
            if (
                "Access-Control-Allow-Origin" in found.headers
                or found.headers["Cache-Control"] != "no-store"
            ):
                raise FaultError(f"{path} may be read or kept: {found.headers}")
            text = await found.text()
            if any(token in text for name, token in target.tokens.items() if name != who):
                raise FaultError(f"{path} tells the secret of somebody else")


ATTACKS: Mapping[str, Callable[[Target], Awaitable[None]]] = {
    "wrong secrets": _wrong_secrets,
    "stolen elsewhere": _stolen_elsewhere,
    "tutor's page": _tutors_page,
    "another session": _another_session,
    "another download": _another_download,
    "paths": _paths,
    "names of files": _names_of_files,
    "who looks on": _who_looks_on,
    "many who look on": _many_who_look_on,
    "framing": _framing,
}
"""By name."""


async def _attack(name: str) -> None:
    reports: list[str] = []
    async with AsyncExitStack() as stack:
        folder = Path(os.path.realpath(stack.enter_context(TemporaryDirectory())))
        links = open_class(folder, ["Ada", "Bob"])
        stack.callback(os.close, links.lock_fd)
        limits = ServerLimits(2, VisitLimits(PATIENCE_S, PATIENCE_S))
        classroom = Classroom(
            links,
            "127.0.0.1",
            lambda one: (stand_in(), Place(one.folder, {})),
            limits,
            reports.append,
        )
        port = await stack.enter_async_context(listening(classroom, "127.0.0.1", 0))
        client = await stack.enter_async_context(ClientSession())
        tokens = {"tutor": links.tutor} | {
            student.name: student.token for student in links.students
        }
        target = Target(client, port, folder, tokens)
        await target.begin()
        await ATTACKS[name](target)
        await target.works()
    if reports:
        raise FaultError(f"the server's terminal gets {reports}")


def check_classroom_attack(name: str) -> None:
    """Attack a class, and see that the one who works is not disturbed."""
    asyncio.run(asyncio.wait_for(_attack(name), PATIENCE_S))
