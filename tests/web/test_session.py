"""The real server with the real app, asked by a client that answers like the terminal of a page."""

from __future__ import annotations

import asyncio
import base64
import json
import os
import re
import signal
import subprocess
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from functools import partial
from pathlib import Path

import pyte
import pytest
from aiohttp import ClientSession, ClientWebSocketResponse, WSMsgType

from tests.cases import cases
from tests.conftest import ROOT
from tests.running import PATIENCE_S
from tests.web.test_server import is_there

pytestmark = pytest.mark.slow

DRIVES = "# %%sim_magic_preloaded -b Grey_bands\ntank_drive.on_for_seconds(20, 20, 2)\nprint('Light: 5')\n"
RUNS_ON = "# %%sim_magic_preloaded -b Loop\nprint('Light: 5')\nwhile True:\n    pass\n"
QUERY = b"\x1b[6n"
ANSWER = "\x1b[20;40R"


class Tab:
    """A page without a picture: what its terminal shows, and how its session has ended."""

    def __init__(self, socket: ClientWebSocketResponse, columns: int, rows: int) -> None:
        self._socket = socket
        self._screen = pyte.Screen(columns, rows)
        self._stream = pyte.ByteStream(self._screen)
        self._news = asyncio.Event()
        self.seen = b""
        self.session = ""
        """The session that the tab shows."""
        self.offered: list[str] = []
        """The keys of the files that can be downloaded."""
        self.reason: str | None = None

    async def read(self) -> None:
        """Show what the app sends, and answer it, until it ends."""
        while (message := await self._socket.receive()).type in (WSMsgType.BINARY, WSMsgType.TEXT):
            if message.type is WSMsgType.TEXT:
                kind, said = json.loads(message.data)
                if kind == "session":
                    self.session = said
                elif kind != "panels":
                    self.offered += [said]
                self._news.set()
                continue
            self.seen += message.data
            self._stream.feed(message.data)
            for _ in range(message.data.count(QUERY)):
                await self._socket.send_json(["stdin", ANSWER])
            self._news.set()
        self.reason = str(message.extra or "")
        self._news.set()

    @property
    def text(self) -> str:
        return "\n".join(self._screen.display)

    def color(self, column: int, row: int) -> str:
        """Return the colour of a character."""
        return str(self._screen.buffer[row][column].fg)

    async def say(self, *words: str) -> None:
        await self._socket.send_json(words)

    async def press(self, keys: str) -> None:
        await self.say("stdin", keys)

    async def resize(self, columns: int, rows: int) -> None:
        self._screen.resize(rows, columns)
        await self._socket.send_json(["resize", {"width": columns, "height": rows}])

    async def download(self, address: str, key: str) -> bytes:
        """Return the file that is offered under a key."""
        async with ClientSession() as client, client.get(f"{address}download/{key}") as answer:
            return await answer.read()

    async def until(self, condition: Callable[[], object]) -> None:
        """Wait until something has happened."""
        with suppress(TimeoutError):
            async with asyncio.timeout(PATIENCE_S):
                while not condition():
                    self._news.clear()
                    await self._news.wait()
        assert condition(), self.text


class Serving:
    """A server in a process of its own."""

    def __init__(self, process: Process, address: str) -> None:
        self.process = process
        self.address = address

    @asynccontextmanager
    async def tab(
        self, columns: int = 120, rows: int = 40, session: str = ""
    ) -> AsyncIterator[Tab]:
        """Open the app in a tab, and close the tab."""
        query = f"ws?width={columns}&height={rows}{f'&session={session}' if session else ''}"
        origin = self.address.rsplit("/", 2)[0]
        async with (
            ClientSession(headers={"Origin": origin}) as client,
            client.ws_connect(self.address + query) as socket,
            asyncio.TaskGroup() as tasks,
        ):
            tab = Tab(socket, columns, rows)
            reading = tasks.create_task(tab.read())
            yield tab
            reading.cancel()


Serve = Callable[..., Awaitable[Serving]]


@pytest.fixture
async def serve(tmp_path: Path) -> AsyncIterator[Serve]:
    """Start a server that opens a program."""
    async with AsyncExitStack() as stack:

        async def start(program: str, *words: str) -> Serving:
            (tmp_path / "prog.py").write_text(program)
            process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-m", "tuisim", "serve", "prog.py", "--port", "0", *words),
                cwd=tmp_path,
                env={**os.environ, "PYTHONPATH": str(ROOT), "TUISIM_HOME": str(tmp_path / "home")},
                stdout=PIPE,
            )
            stack.push_async_callback(_end, process)
            assert process.stdout is not None
            line = await asyncio.wait_for(process.stdout.readline(), PATIENCE_S)
            return Serving(process, line.decode().split()[1])

        yield start


async def _end(process: Process) -> None:
    with suppress(ProcessLookupError):
        process.send_signal(signal.SIGINT)
    await asyncio.wait_for(process.wait(), PATIENCE_S)


def children(pid: int) -> set[int]:
    """Return the processes that a process has started."""
    listed = subprocess.run(
        ["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False
    )
    return {int(word) for word in listed.stdout.split()}


def descendants(pid: int) -> set[int]:
    """Return all processes that a process has started, and that they have."""
    found = children(pid)
    return found.union(*map(descendants, found))


async def gone(processes: set[int]) -> None:
    """Wait until processes have ended."""
    async with asyncio.timeout(PATIENCE_S):
        while any(map(is_there, processes)):
            await asyncio.sleep(0.02)


async def test_what_is_copied_reaches_the_clipboard_of_the_browser(serve: Serve) -> None:
    async with (await serve(DRIVES)).tab() as tab:
        await tab.until(lambda: "idle" in tab.text)
        await tab.press("d")
        await tab.until(lambda: "esc done" in tab.text)
        await tab.press("\x01")
        await tab.press("\x03")
        await tab.until(lambda: b"\x1b]52;c;" + base64.b64encode(DRIVES.encode()) in tab.seen)


async def test_a_screenshot_taken_in_a_browser_can_be_downloaded(
    serve: Serve, tmp_path: Path
) -> None:
    server = await serve(DRIVES)
    async with server.tab() as tab:
        await tab.until(lambda: "idle" in tab.text)
        await tab.press("I")
        await tab.until(lambda: len(tab.offered) == 2)
        files = [await tab.download(server.address, key) for key in tab.offered]
        assert files == [
            (tmp_path / name).read_bytes() for name in ("tuisim-1.svg", "tuisim-1.png")
        ]


async def test_ctrl_z_in_a_browser_says_that_the_app_cannot_be_suspended(serve: Serve) -> None:
    async with (await serve(DRIVES)).tab() as tab:
        await tab.until(lambda: "idle" in tab.text)
        await tab.press("\x1a")
        await tab.until(lambda: "tuisim cannot be suspended in a browser" in tab.text)


async def test_a_closed_tab_ends_its_app_and_its_program_only(serve: Serve) -> None:
    server = await serve(RUNS_ON, "-R", "--keep", "0.001")
    async with server.tab() as kept:
        await kept.until(lambda: "running" in kept.text)
        others = children(server.process.pid)
        async with server.tab() as tab:
            await tab.until(lambda: "running" in tab.text)
            (app,) = children(server.process.pid) - others
            ended = {app} | descendants(app)
        assert len(ended) > 1
        await gone(ended)
        assert all(map(is_there, others))


async def test_a_run_of_a_web_session_goes_on_while_no_tab_is_open(serve: Serve) -> None:
    server = await serve(RUNS_ON, "-R")
    async with server.tab() as tab:
        await tab.until(lambda: "running" in tab.text and "Light: 5" in tab.text)
        before = clock_s(tab)
        processes = descendants(server.process.pid)
    for columns, rows in ((90, 28), (120, 40)):
        async with server.tab(columns, rows, tab.session) as again:
            await again.until(partial(goes_on, again, before))
            assert "Light: 5" in again.text
            # The mouse is reported as in the first tab.
            assert b"\x1b[?1003h" in again.seen
    assert all(map(is_there, processes))


def clock_s(tab: Tab) -> float:
    """Return the simulated time below the world; 0 if none is shown."""
    found = re.search(r"([\d.]+) s *│", tab.text)
    return float(found[1]) if found else 0.0


def goes_on(tab: Tab, after_s: float) -> bool:
    """Return whether a tab shows a run at a later time."""
    return "running" in tab.text and clock_s(tab) > after_s


async def test_a_killed_server_leaves_no_app_running(serve: Serve) -> None:
    server = await serve(RUNS_ON, "-R")
    async with server.tab() as tab:
        await tab.until(lambda: "running" in tab.text)
        started = descendants(server.process.pid)
    server.process.kill()
    await server.process.wait()
    await gone(started)


ENDS = {
    "ctrl+c": (signal.SIGINT, 0),
    "termination": (signal.SIGTERM, 143),
    "no chance": (signal.SIGKILL, -9),
}


@cases("number, code", ENDS)
async def test_the_end_of_the_server_ends_apps_and_programs(
    number: signal.Signals, code: int, serve: Serve
) -> None:
    server = await serve(RUNS_ON, "-R")
    async with server.tab() as tab:
        await tab.until(lambda: "running" in tab.text)
        started = descendants(server.process.pid)
        assert len(started) > 1
        server.process.send_signal(number)
        assert await server.process.wait() == code
        await gone(started)


async def test_a_web_page_focused_from_the_start_keeps_the_focus(serve: Serve) -> None:
    async with (await serve(DRIVES)).tab() as tab:
        await tab.say("focus")
        await tab.until(lambda: "idle" in tab.text)
        await tab.resize(90, 28)
        await tab.until(lambda: "quit" in tab._screen.display[27])
        await tab.until(lambda: tab.color(0, 0) == "5fafff")
