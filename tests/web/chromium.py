"""A browser without a window, driven by the DevTools protocol."""

from __future__ import annotations

import asyncio
from base64 import b64decode
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from io import BytesIO
from pathlib import Path
from shutil import which
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from aiohttp import ClientSession, ClientWebSocketResponse
from PIL import Image

from tests.running import PATIENCE_S

needs_chromium = pytest.mark.skipif(which("chromium") is None, reason="needs a browser: chromium")

Pixels = npt.NDArray[np.uint8]


def pixels_of(data: str) -> Pixels:
    """Return the picture of a PNG in base64, shape (height, width, 4)."""
    return np.asarray(Image.open(BytesIO(b64decode(data))).convert("RGBA"))


class Chromium:
    """A page in the browser."""

    def __init__(self, socket: ClientWebSocketResponse) -> None:
        self._socket = socket
        self._last = 0
        self.complaints: list[str] = []
        """Errors of scripts, and what the content policy has refused."""

    async def do(self, method: str, **parameters: Any) -> Any:
        """Send a command; return its result."""
        self._last += 1
        await self._socket.send_json({"id": self._last, "method": method, "params": parameters})
        while True:
            said = await self._socket.receive_json(timeout=PATIENCE_S)
            if said.get("id") == self._last:
                assert "error" not in said, said
                return said["result"]
            entry = said.get("params", {}).get("entry", {})
            if said.get("method") == "Runtime.exceptionThrown" or entry.get("level") == "error":
                self.complaints.append(str(said["params"]))

    async def js(self, expression: str) -> Any:
        """Return the value of an expression of the page."""
        done = await self.do(
            "Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True
        )
        assert "exceptionDetails" not in done, done
        return done["result"].get("value")

    async def until(self, condition: str) -> None:
        """Wait until an expression of the page is true."""
        async with asyncio.timeout(PATIENCE_S):
            while not await self.js(condition):
                await asyncio.sleep(0.05)

    async def shown(self) -> Pixels:
        """Return what the page shows, pixel by pixel."""
        return pixels_of((await self.do("Page.captureScreenshot"))["data"])

    async def click(self, x: float, y: float) -> None:
        """Press and release the mouse."""
        for kind in ("mousePressed", "mouseReleased"):
            await self.do(
                "Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1
            )

    async def copy_by_key(self, focus: Callable[[], Awaitable[None]] | None = None) -> str:
        """Press ctrl+c until something is on the clipboard; return that.

        Args:
            focus: Gives the keys to what is copied from, before each press; None where nothing takes them away.
        """
        allowed = ["clipboardReadWrite", "clipboardSanitizedWrite"]
        await self.do("Browser.grantPermissions", permissions=allowed)
        key = {"modifiers": 2, "key": "c", "code": "KeyC", "windowsVirtualKeyCode": 67}
        copied = ""
        async with asyncio.timeout(PATIENCE_S):
            while not copied:
                if focus is not None:
                    await focus()
                for kind in ("rawKeyDown", "keyUp"):
                    await self.do("Input.dispatchKeyEvent", type=kind, **key)
                await asyncio.sleep(0.3)
                copied = await self.js("navigator.clipboard.readText()")
        return copied

    async def finger(self, kind: str, *places: tuple[float, float]) -> None:
        """Put fingers on the page (`touchStart`), move them, or take them away (`touchEnd`, without places)."""
        points = [{"x": x, "y": y, "id": at} for at, (x, y) in enumerate(places)]
        await self.do("Input.dispatchTouchEvent", type=kind, touchPoints=points)


@asynccontextmanager
async def chromium(
    folder: Path, width: int, height: int, scale: float, *, fingers: bool, is_private: bool = False
) -> AsyncIterator[Chromium]:
    """Open a browser.

    Args:
        folder: Where it keeps its files.
        width: Of the page, in pixels of its style sheet.
        height: Its height.
        scale: Pixels of the screen for one of those.
        fingers: Whether it is a device that is touched, and not one with a mouse.
        is_private: Whether its window is a private one, which lets no frame of another site keep anything.
    """
    process = await asyncio.create_subprocess_exec(
        *("chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"),
        *(
            *(["--incognito"] if is_private else []),
            f"--force-device-scale-factor={scale}",
            f"--user-data-dir={folder}",
            "--remote-debugging-port=0",
        ),
        "about:blank",
        stderr=asyncio.subprocess.DEVNULL,
    )
    try:
        port_file = folder / "DevToolsActivePort"
        async with asyncio.timeout(PATIENCE_S):
            while not (port_file.exists() and port_file.read_text()):
                await asyncio.sleep(0.05)
        port = port_file.read_text().split()[0]
        async with ClientSession() as client:
            async with client.get(f"http://127.0.0.1:{port}/json") as answer:
                url = next(
                    one["webSocketDebuggerUrl"]
                    for one in await answer.json()
                    if one["type"] == "page"
                )
            async with client.ws_connect(url, max_msg_size=0) as socket:
                page = Chromium(socket)
                for part in ("Page", "Runtime", "Log"):
                    await page.do(f"{part}.enable")
                size = {"width": width, "height": height, "deviceScaleFactor": 0, "mobile": fingers}
                await page.do("Emulation.setDeviceMetricsOverride", **size)
                await page.do("Emulation.setTouchEmulationEnabled", enabled=fingers)
                yield page
    finally:
        process.terminate()
        await process.wait()
