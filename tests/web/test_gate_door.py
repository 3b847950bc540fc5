"""Connections without the link: they are closed, and never keep a visitor out."""

from __future__ import annotations

import asyncio
import errno
from contextlib import AsyncExitStack

import pytest
from aiohttp import ClientSession

from tests.conftest import ROOT
from tests.running import PATIENCE_S
from tests.web.stand_in import stand_in
from tests.web.test_server import TOKEN, Visited, visited
from tuisim.web import gate, uploads
from tuisim.web.gate import Door, Gate
from tuisim.web.server import Server, ServerLimits, run_server

assert visited


async def test_a_connection_without_a_request_is_closed_and_visitors_stay_connected(
    visited: Visited, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gate, "STRANGER_S", 0.05)
    visitor = await visited()
    socket, _ = await visitor.started()
    port = int(visitor.origin.rpartition(":")[2])
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    assert await asyncio.wait_for(reader.read(), PATIENCE_S) == b""
    writer.close()
    await socket.send_json(["ping", "1"])
    assert (await socket.receive(PATIENCE_S)).data == '["pong", "1"]'


async def test_of_many_connections_without_a_request_the_oldest_are_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(gate, "MAX_STRANGERS", 3)
    async with AsyncExitStack() as stack:
        server = Server(stand_in(), Gate("127.0.0.1", TOKEN), ServerLimits(1))
        port = await stack.enter_async_context(run_server(server, "127.0.0.1", 0))
        pairs = [await asyncio.open_connection("127.0.0.1", port) for _ in range(9)]
        for reader, _ in pairs[:6]:
            assert await asyncio.wait_for(reader.read(), PATIENCE_S) == b""
        client = await stack.enter_async_context(ClientSession())
        async with client.get(f"http://127.0.0.1:{port}/{TOKEN}/") as answer:
            assert answer.status == 200
        for _, writer in pairs:
            writer.close()


async def test_the_server_says_at_most_once_a_minute_that_it_is_full() -> None:
    now_s, reports = [0.0], list[str]()
    loop = asyncio.get_running_loop()
    hears = Door(reports.append, lambda: now_s[0])._hear
    for time_s in (0.0, 1.0, 59.0, 61.0):
        now_s[0] = time_s
        hears(loop, {"exception": OSError(errno.EMFILE, "Too many open files")})
    assert reports == ["The server cannot accept visitors: Too many open files"] * 2


def test_the_guides_page_on_security_names_the_servers_limits() -> None:
    page = (ROOT / "tuisim" / "guide" / "pages" / "security.md").read_text(encoding="utf-8")
    for text in (
        f"has not sent the address within {gate.STRANGER_S:g} s",
        f"more than {gate.MAX_STRANGERS} such connections",
        f"may have {uploads.MAX_FILE_BYTES >> 20} MB, and all files together {uploads.MAX_BYTES >> 30} GB",
    ):
        assert text in " ".join(page.split())
