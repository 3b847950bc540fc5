"""A line to the browser that is lost: the page shows the same app again."""

from __future__ import annotations

import asyncio
from asyncio import StreamReader, StreamWriter
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path

import pytest

from tests.running import PATIENCE_S
from tests.web.chromium import Chromium, chromium, needs_chromium
from tests.web.test_session import RUNS_ON, Serve

pytestmark = [pytest.mark.slow, needs_chromium]

KEEPS_TERMINAL = (
    "addEventListener('DOMContentLoaded', () => terminalUsers.push((it) => (window.shown = it)))"
)
TEXT = """\
[...Array(shown.rows).keys()].map((row) => shown.buffer.active.getLine(row).translateToString()).join("\\n")"""
SHOWS = f"window.shown && !document.querySelector('.-closed') && {TEXT}.includes('running')"
CLOCK = f"Number(/([\\d.]+) s *│/.exec({TEXT})[1])"
LATER = "Date.now = ((now) => () => now() + 11000)(Date.now)"
"""More than the page waits for a word, and for an answer."""


class Line:
    """Passes on what browser and server send, until it is cut."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._pairs: list[tuple[StreamWriter, StreamWriter]] = []
        self._silent: set[StreamWriter] = set()

    async def take(self, reader: StreamReader, writer: StreamWriter) -> None:
        """Connect a browser with the server."""
        back, to = await asyncio.open_connection("127.0.0.1", self._port)
        self._pairs.append((writer, to))
        await asyncio.gather(self._pass_on(reader, to), self._pass_on(back, writer))

    async def _pass_on(self, reader: StreamReader, writer: StreamWriter) -> None:
        with suppress(ConnectionError):
            while data := await reader.read(65536):
                if writer not in self._silent:
                    writer.write(data)
                    await writer.drain()
        if writer not in self._silent:
            writer.close()

    def cut(self) -> None:
        """End all connections."""
        for writer in self._writers():
            writer.transport.abort()

    def mute(self) -> None:
        """Pass nothing on in the connections that there are; neither end is told."""
        self._silent.update(self._writers())

    def _writers(self) -> list[StreamWriter]:
        return [writer for pair in self._pairs for writer in pair]


@asynccontextmanager
async def shown(serve: Serve, folder: Path) -> AsyncIterator[tuple[Chromium, Line]]:
    """Show a program that runs on in a browser, by a line that can be cut."""
    address = (await serve(RUNS_ON, "-R")).address
    host, _, path = address.removeprefix("http://").partition("/")
    line = Line(int(host.rpartition(":")[2]))
    async with await asyncio.start_server(line.take, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        async with chromium(folder / "browser", 900, 600, 1, fingers=False) as page:
            await page.do("Page.addScriptToEvaluateOnNewDocument", source=KEEPS_TERMINAL)
            await page.do("Page.navigate", url=f"http://127.0.0.1:{port}/{path}")
            await page.until(SHOWS)
            yield page, line
        line.cut()


async def test_the_web_page_shows_the_same_app_after_its_connection_was_lost(
    serve: Serve, tmp_path: Path
) -> None:
    async with shown(serve, tmp_path) as (page, line):
        session = await page.js("window.before = sessionStorage.getItem('session')")
        for lose in (line.cut, line.cut, line.mute):
            back = f"{SHOWS} && {CLOCK} > {await page.js(CLOCK)} + 0.5"
            lose()
            async with asyncio.timeout(PATIENCE_S):
                while not await page.js(back):
                    # It asks who says nothing, and then it gives up.
                    await page.js(LATER)
                    await asyncio.sleep(0.5)
            # It is the same app, and the page was not loaded again.
            assert await page.js("[sessionStorage.getItem('session'), window.before]") == [
                session,
                session,
            ]
