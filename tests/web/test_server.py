"""The server, asked by a client in the place of a browser."""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping, Sequence
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any

import pytest
from aiohttp import (
    ClientPayloadError,
    ClientSession,
    ClientWebSocketResponse,
    WSCloseCode,
    WSMsgType,
    WSServerHandshakeError,
)
from textual_serve.app_service import AppService

from tests.cases import cases
from tests.running import PATIENCE_S
from tests.web.stand_in import stand_in
from tuisim.web import server, session
from tuisim.web.gate import Gate
from tuisim.web.server import _REFUSAL, Server, ServerLimits, run_server
from tuisim.web.visit import VisitLimits

TOKEN = "the-token"
"""The secret part of the address of every server here."""


class Visitor:
    """A client of one server."""

    def __init__(self, client: ClientSession, port: int) -> None:
        self.client = client
        self.origin = f"http://127.0.0.1:{port}"
        self.top = f"{self.origin}/{TOKEN}/"
        self._sockets: list[ClientWebSocketResponse] = []

    async def socket(self, query: str = "?width=120&height=40") -> ClientWebSocketResponse:
        """Connect with an app."""
        socket = await self.client.ws_connect(
            f"{self.top}ws{query}", headers={"Origin": self.origin}
        )
        self._sockets.append(socket)
        return socket

    async def leave(self) -> None:
        """Close all that is still open."""
        for socket in self._sockets:
            await socket.close()

    async def started(self) -> tuple[ClientWebSocketResponse, int]:
        """Return the socket and the process of an app that has started."""
        socket = await self.socket()
        return socket, int((await drawn(socket)).split()[1])

    async def sessions(self) -> dict[str, Any]:
        """Return what the list of sessions says."""
        async with self.client.get(f"{self.top}sessions") as answer:
            return dict(await answer.json())

    async def post(self, path: str, data: bytes = b"", **headers: str) -> int:
        """Ask for something to be done, as a page does; return the status."""
        sent = {"Origin": self.origin} | headers
        async with self.client.post(self.top + path, data=data, headers=sent) as answer:
            return answer.status


async def heard(socket: ClientWebSocketResponse) -> str:
    """Return the next that the app has drawn or the server has said, or the reason for the end."""
    message = await socket.receive(PATIENCE_S)
    if message.type is WSMsgType.BINARY:
        return str(message.data.decode())
    return str(message.extra if message.type is WSMsgType.CLOSE else message.data)


async def drawn(socket: ClientWebSocketResponse) -> str:
    """Return the next that the app has drawn; before that, a page is told which session it shows."""
    said = await heard(socket)
    return await heard(socket) if said.startswith('["session"') else said


def is_there(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


Visited = Callable[..., Awaitable[Visitor]]


@pytest.fixture
async def visited() -> AsyncIterator[Visited]:
    """Start a server with the stand-in for an app."""
    async with AsyncExitStack() as stack:

        async def start(
            command: Sequence[str] = (),
            visitors: int = 2,
            idle_s: float = PATIENCE_S,
            keep_s: float = PATIENCE_S,
            keep_unused_s: float = PATIENCE_S,
            report: Callable[[str], None] = lambda _: None,
        ) -> Visitor:
            limits = ServerLimits(visitors, VisitLimits(idle_s, keep_s, keep_unused_s))
            server = Server(command or stand_in(), Gate("127.0.0.1", TOKEN), limits, report)
            port = await stack.enter_async_context(run_server(server, "127.0.0.1", 0))
            visitor = Visitor(await stack.enter_async_context(ClientSession()), port)
            stack.push_async_callback(visitor.leave)
            return visitor

        yield start


PLACES = {
    "page": "",
    "list of sessions": "sessions",
    "script": "page/page.js",
    "static file": "static/js/textual.js",
    "download": "download/key",
}
STRANGERS: dict[str, tuple[str, Mapping[str, str]]] = {
    "without the token": ("/{place}", {}),
    "with another token": ("/the-tokem/{place}", {}),
    "from another site": ("/the-token/{place}", {"Origin": "http://evil.example"}),
    "under another name": ("/the-token/{place}", {"Host": "evil.example"}),
}


@pytest.mark.quick_cases("*-script")
@cases("place", PLACES)
@cases("path, headers", STRANGERS)
async def test_a_request_without_the_token_or_from_another_origin_gets_403(
    path: str, headers: Mapping[str, str], place: str, visited: Visited
) -> None:
    visitor = await visited()
    socket, _ = await visitor.started()
    await socket.send_json(["stdin", "offer"])
    await heard(socket)
    url = visitor.origin + path.format(place=place)
    async with visitor.client.get(url, headers=headers) as answer:
        assert (answer.status, await answer.text()) == (403, _REFUSAL)


@pytest.mark.parametrize(
    "path, headers",
    [*STRANGERS.values(), ("/the-token/{place}", {"Origin": ""})],
    ids=[*STRANGERS, "without a page"],
)
async def test_a_websocket_without_the_token_or_from_another_origin_starts_no_app(
    path: str, headers: Mapping[str, str], visited: Visited, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[AppService] = []
    monkeypatch.setattr(session.WebSession, "start", lambda self, *_: started.append(self))
    visitor = await visited()
    url = visitor.origin + path.format(place="ws")
    with pytest.raises(WSServerHandshakeError) as refused:
        await visitor.client.ws_connect(url, headers={"Origin": visitor.origin, **headers})
    assert (refused.value.status, started) == (403, [])


WRONG = {
    "no host": b"GET / HTTP/1.1\r\n\r\n",
    "an endless path": b"GET /" + b"a" * 20_000 + b" HTTP/1.1\r\n\r\n",
}


@cases("request_bytes", WRONG)
async def test_a_malformed_request_prints_nothing_in_the_servers_terminal(
    request_bytes: bytes, visited: Visited, caplog: pytest.LogCaptureFixture
) -> None:
    visitor = await visited()
    reader, writer = await asyncio.open_connection(
        "127.0.0.1", int(visitor.origin.rpartition(":")[2])
    )
    writer.write(request_bytes)
    assert b" 400 " in await reader.readline()
    writer.close()
    await writer.wait_closed()
    assert caplog.records == []


VISITS = {
    "the page": ("", "text/html"),
    "its script": ("page/page.js", "javascript"),
    "what draws pictures": ("page/pictures.js", "javascript"),
    "what unpacks them": ("page/inflate.js", "javascript"),
    "what fingers do": ("page/fingers.js", "javascript"),
    "its style": ("page/page.css", "text/css"),
    "the terminal": ("static/js/textual.js", "javascript"),
    "the terminal's style": ("static/css/xterm.css", "text/css"),
    "the font": ("static/fonts/RobotoMono-VariableFont_wght.ttf", ""),
    "the font of symbols": ("fonts/DejaVuSansMono.ttf", ""),
}


@cases("path, kind", VISITS)
async def test_each_page_of_the_server_has_its_content_type_and_security_policy(
    path: str, kind: str, visited: Visited
) -> None:
    visitor = await visited()
    async with visitor.client.get(visitor.top + path) as answer:
        assert answer.status == 200
        assert kind in answer.content_type
        assert "default-src 'self';" in answer.headers["Content-Security-Policy"]
        assert answer.headers["Referrer-Policy"] == "no-referrer"


async def test_the_address_may_lack_its_last_slash(visited: Visited) -> None:
    visitor = await visited()
    async with visitor.client.get(visitor.top.rstrip("/")) as answer:
        assert (answer.status, str(answer.url)) == (200, visitor.top)


async def test_a_file_that_an_app_offers_can_be_downloaded_only_once(visited: Visited) -> None:
    visitor = await visited()
    socket, _ = await visitor.started()
    await socket.send_json(["stdin", "offer"])
    assert await heard(socket) == '["deliver_file_start", "key"]'
    found = []
    for _ in range(2):
        async with visitor.client.get(visitor.top + "download/key") as answer:
            found.append(
                (answer.status, await answer.text(), answer.headers.get("Content-Disposition"))
            )
    assert found == [
        (200, "a file", "attachment; filename*=UTF-8''run.csv"),
        (404, "There is no such download.\n", None),
    ]


async def test_a_download_that_breaks_off_is_not_completed_as_a_file(
    visited: Visited, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "ANSWER_WITHIN_S", 0.05)
    visitor = await visited(stand_in("slow"))
    socket, _ = await visitor.started()
    await socket.send_json(["stdin", "offer"])
    await heard(socket)
    async with visitor.client.get(visitor.top + "download/key") as answer:
        with pytest.raises(ClientPayloadError):
            await answer.read()


def packet(kind: bytes, payload: bytes, size: int | None = None) -> str:
    """Return a packet of an app in hexadecimal, with the size that it says it has."""
    return (kind + (len(payload) if size is None else size).to_bytes(4, "big") + payload).hex()


PACKETS = {
    "an enormous one": packet(b"D", b"", 0xFFFFFFFF),
    "no JSON": packet(b"M", b"{"),
    "no object": packet(b"M", b"[]"),
    "deep JSON": packet(b"M", b"[" * 9_000),
    "no type": packet(b"M", b"{}"),
    "no path": packet(b"M", b'{"type": "deliver_file_start", "key": "k", "path": 5}'),
    "nothing packed": packet(b"P", b"x"),
}


@cases("sent", PACKETS)
async def test_a_malformed_packet_ends_only_its_own_app(sent: str, visited: Visited) -> None:
    visitor = await visited()
    socket, pid = await visitor.started()
    _, other = await visitor.started()
    await socket.send_json(["stdin", f"packet {sent}"])
    while (message := await socket.receive(PATIENCE_S)).type is not WSMsgType.CLOSE:
        pass
    await gone(pid)
    assert message.extra == "The app has ended."
    assert is_there(other)


MESSAGES: dict[str, tuple[str, str]] = {
    "keys": ('["stdin", "é"]', "é"),
    "half a pair": ('["stdin", "\\ud83da"]', "a"),
    "a size": (
        '["resize", {"width": 90, "height": 30}]',
        '{"type": "resize", "width": 90, "height": 30}',
    ),
    "an impossible size": ('["resize", {"width": -5, "height": 1e9}]', '{"type": "blur"}'),
    "an enormous size": (
        '["resize", {"width": 0, "height": 99999}]',
        '{"type": "resize", "width": 1, "height": 1000}',
    ),
    "focus": ('["focus"]', '{"type": "focus"}'),
    "no focus": ('["blur"]', '{"type": "blur"}'),
    "a button": ('["act", "run"]', '{"type": "act", "name": "run"}'),
    "a ping": ('["ping", "5"]', '["pong", "5"]'),
    "no JSON": ("[[", '{"type": "blur"}'),
    "deep JSON": ("[" * 100_000, '{"type": "blur"}'),
    "another message": ('["quit"]', '{"type": "blur"}'),
    "no list": ('{"stdin": 1}', '{"type": "blur"}'),
}
"""What a page sends before `blur`, and what comes back first."""


@cases("sent, back", MESSAGES)
async def test_messages_of_the_page_reach_the_app(sent: str, back: str, visited: Visited) -> None:
    socket, _ = await (await visited()).started()
    await socket.send_str(sent)
    await socket.send_str('["blur"]')
    assert await heard(socket) == back


SIZES = {
    "a size": ("?width=90&height=30", "90 x 30"),
    "none": ("", "80 x 24"),
    "no numbers": ("?width=a&height=", "80 x 24"),
}


@cases("query, size", SIZES)
async def test_the_web_app_starts_in_the_size_of_the_page(
    query: str, size: str, visited: Visited
) -> None:
    socket = await (await visited()).socket(query)
    assert (await drawn(socket)).endswith(f" of {size}")


async def test_the_app_does_not_take_the_servers_terminal_for_its_own(
    visited: Visited, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("TMUX", "/tmp/tmux,1,1")
    monkeypatch.setenv("TERM", "dumb")
    monkeypatch.setenv("LC_ALL", "C")
    monkeypatch.setenv("MINE", "kept")
    seen = tmp_path / "environment"
    socket = await (
        await visited(["sh", "-c", f"echo $TMUX $TERM $LC_ALL $LC_CTYPE $MINE > {seen}"])
    ).socket()
    await drawn(socket)
    assert seen.read_text() == "xterm-256color C.UTF-8 kept\n"


GONE = "tuisim: mine.py: there is no such program"
ENDS = {
    "the user quits": ("0 a note", "", []),
    "what to open is gone": (f"2 note: x\n{GONE}\n", GONE, [f"note: x\n{GONE}"]),
    "a long reason": ("2 tuisim: " + "é" * 300, "tuisim: " + "é" * 57, ["tuisim: " + "é" * 300]),
    "somebody ends it": ("143 ", "The app has ended.", []),
    "a failure": (
        "1 Traceback",
        "The app has failed; the server's terminal says why.",
        ["Traceback"],
    ),
}


@cases("how, reason, reported", ENDS)
async def test_visitor_and_server_get_the_reason_why_the_app_ended(
    how: str, reason: str, reported: list[str], visited: Visited
) -> None:
    reports: list[str] = []
    socket, _ = await (await visited(report=reports.append)).started()
    await socket.send_json(["stdin", f"end {how}"])
    assert (await heard(socket), reports) == (reason, reported)


async def test_a_visitor_is_told_that_the_app_cannot_be_started(visited: Visited) -> None:
    socket = await (await visited(["/no/such/program"])).socket()
    assert await drawn(socket) == "The app cannot be started: No such file or directory"


async def test_a_visitor_that_does_nothing_is_sent_away(visited: Visited) -> None:
    socket = await (await visited(idle_s=0.06)).socket()
    said = ""
    # What the app draws until then does not count.
    while not socket.closed:
        said = await heard(socket)
    assert said == "The session has ended after 0.001 minutes without input."


async def gone(pid: int) -> None:
    """Wait until a process has ended."""
    async with asyncio.timeout(PATIENCE_S):
        while is_there(pid):
            await asyncio.sleep(0.005)


STUBBORN = {"an app that ends": (), "an app that does not": ("stubborn",)}


@cases("words", STUBBORN)
async def test_an_app_that_no_tab_shows_ends_after_a_while(
    words: Sequence[str], visited: Visited, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(session, "END_WITHIN_S", 0.1 if words else PATIENCE_S)
    socket, pid = await (await visited(stand_in(*words), keep_s=0.01)).started()
    await socket.close()
    await gone(pid)


async def test_the_end_of_the_server_ends_all_apps() -> None:
    server = Server(stand_in(), Gate("127.0.0.1", TOKEN), ServerLimits(2))
    async with ClientSession() as client:
        async with run_server(server, "127.0.0.1", 0) as port:
            started = [await Visitor(client, port).started() for _ in range(2)]
        assert [await heard(socket) for socket, _ in started] == ["The server has stopped."] * 2
    assert [is_there(pid) for _, pid in started] == [False, False]


FULL = "This server allows 1 visitor at a time, and all places are taken."


async def test_a_visitor_beyond_the_servers_limit_is_told_so(visited: Visited) -> None:
    visitor = await visited(visitors=1)
    await visitor.started()
    assert (await visitor.sessions())["free"] == 0
    late = await visitor.socket()
    assert (await heard(late), late.close_code) == (FULL, WSCloseCode.TRY_AGAIN_LATER)
