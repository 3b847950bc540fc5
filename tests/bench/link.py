"""A slow line: a TCP proxy that delays what it passes on, and passes on no more than so much a second."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine
from dataclasses import dataclass
from typing import Any, Self

_CHUNK = 1024
"""Bytes that are passed on together, so that a low rate comes out even."""
_HELD = 16_384
"""Bytes that a direction of the line holds at most before the sender has to wait."""


@dataclass(frozen=True, slots=True)
class Line:
    """What a line is like in each direction."""

    name: str
    bits_s: float = float("inf")
    round_trip_s: float = 0.0
    """Half of it is spent each way."""


class Link:
    """A line to a port of this machine.

    Args:
        line: What it is like.
        port: Where it leads.
    """

    def __init__(self, line: Line, port: int) -> None:
        self._line = line
        self._to_port = port
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="link", daemon=True)
        self.port = 0
        """Where it begins."""
        self.down_bytes = 0
        """Passed on to the client so far."""
        self.up_bytes = 0
        """Passed on to the server so far."""

    def __enter__(self) -> Self:
        self._thread.start()
        self._server = self._do(asyncio.start_server(self._connected, "127.0.0.1", 0, limit=_CHUNK))
        self.port = self._server.sockets[0].getsockname()[1]
        return self

    def __exit__(self, *error: object) -> None:
        self._do(self._close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def _do(self, work: Coroutine[Any, Any, Any]) -> Any:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result()

    async def _close(self) -> None:
        self._server.close()
        others = asyncio.all_tasks() - {asyncio.current_task()}
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)

    async def _connected(
        self, client: asyncio.StreamReader, to_client: asyncio.StreamWriter
    ) -> None:
        server, to_server = await asyncio.open_connection("127.0.0.1", self._to_port, limit=_CHUNK)
        try:
            async with asyncio.TaskGroup() as both:
                both.create_task(self._pass_on(client, to_server, "up_bytes"))
                both.create_task(self._pass_on(server, to_client, "down_bytes"))
        except* OSError:
            pass
        except* asyncio.CancelledError:
            # The line is taken away; the server of streams would tell of a handler that was cancelled.
            pass
        finally:
            to_client.close()
            to_server.close()

    async def _pass_on(
        self, source: asyncio.StreamReader, target: asyncio.StreamWriter, counter: str
    ) -> None:
        queue: asyncio.Queue[tuple[float, bytes]] = asyncio.Queue(_HELD // _CHUNK)
        async with asyncio.TaskGroup() as both:
            both.create_task(self._take(source, queue))
            both.create_task(self._give(queue, target, counter))

    async def _take(
        self, source: asyncio.StreamReader, queue: asyncio.Queue[tuple[float, bytes]]
    ) -> None:
        free_s = 0.0
        while data := await source.read(_CHUNK):
            # The line is busy with what came before.
            free_s = max(free_s, self._loop.time()) + 8 * len(data) / self._line.bits_s
            await queue.put((free_s + self._line.round_trip_s / 2, data))
        await queue.put((free_s + self._line.round_trip_s / 2, b""))

    async def _give(
        self, queue: asyncio.Queue[tuple[float, bytes]], target: asyncio.StreamWriter, counter: str
    ) -> None:
        while True:
            due_s, data = await queue.get()
            if (left_s := due_s - self._loop.time()) > 0:
                await asyncio.sleep(left_s)
            if not data:
                break
            target.write(data)
            setattr(self, counter, getattr(self, counter) + len(data))
            await target.drain()
        target.write_eof()
