"""A server in a thread of this process, which ends with it."""

from __future__ import annotations

import asyncio
import atexit
from collections.abc import Coroutine
from threading import Thread
from typing import Any, TypeVar

from tuisim.web.server import Server, listening

_Result = TypeVar("_Result")


class BackgroundServer:
    """Answers requests on a port of its own, on this machine only.

    Args:
        server: Answers them.
    """

    def __init__(self, server: Server) -> None:
        self.server = server
        self._loop = asyncio.new_event_loop()
        self._thread = Thread(target=self._loop.run_forever, name="tuisim-server", daemon=True)
        self._thread.start()
        self.port: int = self.call(self._listen())
        # A daemon thread would leave the apps to find out that this process has ended.
        atexit.register(self.close)

    async def _listen(self) -> int:
        self._listening = listening(self.server, "127.0.0.1", 0)
        return await self._listening.__aenter__()

    def call(self, work: Coroutine[Any, Any, _Result], timeout_s: float | None = None) -> _Result:
        """Do something in the server's thread and wait for it.

        Raises:
            TimeoutError: it takes longer.
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
