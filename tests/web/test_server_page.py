"""The page in a browser: pictures in the pixels of the screen, and fingers."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest

from tests.running import PATIENCE_S
from tests.web.chromium import Chromium, Pixels, chromium, needs_chromium, pixels_of
from tests.web.test_session import DRIVES, Serve

pytestmark = [pytest.mark.slow, needs_chromium]

CANVAS = "document.querySelector('.pictures')"
WORLD_SHARE = 0.2
"""The world and the sensor arrays are a larger part of the page than this."""


async def pictures(page: Chromium) -> Pixels:
    """Return the canvas of the pictures; empty before there is one."""
    data = await page.js(f"{CANVAS} ? {CANVAS}.toDataURL() : ''")
    return pixels_of(data.partition(",")[2]) if data else np.zeros((1, 1, 4), np.uint8)


async def until_seen(page: Chromium, condition: Callable[[Pixels], object]) -> Pixels:
    """Wait until the pictures are as they should be and stand still; return them."""
    async with asyncio.timeout(PATIENCE_S):
        last = await pictures(page)
        while True:
            await asyncio.sleep(0.3)
            before, last = last, await pictures(page)
            if np.array_equal(before, last) and condition(last):
                return last


def is_whole(seen: Pixels) -> bool:
    return bool(seen.shape[0] > 1 and (seen[..., 3] == 255).mean() > WORLD_SHARE)


def robot_at(seen: Pixels) -> tuple[float, float]:
    """Return where the robot is in the pictures, as x and y in pixels of the screen; 0 if it has not been drawn."""
    red, green, blue = (seen[..., channel].astype(int) for channel in range(3))
    rows, cols = np.nonzero(
        (red < 40) & (green > 60) & (green < 130) & (blue > 180) & (seen[..., 3] == 255)
    )
    return (float(np.median(cols)), float(np.median(rows))) if len(cols) else (0.0, 0.0)


WITHOUT_WEBGL = """
const contextOf = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
  return kind.startsWith("webgl") ? null : contextOf.call(this, kind, ...more);
};
"""
TERMINAL_SHARE = f"document.querySelector('.xterm-screen').clientWidth / {CANVAS}.clientWidth"


@asynccontextmanager
async def opened(
    serve: Serve, folder: Path, size: tuple[int, int], scale: float, *, fingers: bool = False
) -> AsyncIterator[Chromium]:
    """Show an app in a browser; in the end, nothing was wrong with the page."""
    serving = await serve(DRIVES)
    async with chromium(folder / "browser", *size, scale, fingers=fingers) as page:
        # As in browsers on machines without a graphics card.
        await page.do("Page.addScriptToEvaluateOnNewDocument", source=WITHOUT_WEBGL)
        await page.do("Page.navigate", url=serving.address)
        await until_seen(page, is_whole)
        yield page
        assert page.complaints == []


@pytest.mark.parametrize("scale", [1, 1.25, 2, 3])
async def test_each_pixel_of_a_picture_is_one_pixel_of_the_browsers_screen(
    scale: float, serve: Serve, tmp_path: Path
) -> None:
    async with opened(serve, tmp_path, (1000, 700), scale) as page:
        drawn = await until_seen(page, is_whole)
        shown = await page.shown()
        drawn = drawn[: len(shown), : shown.shape[1]]
        is_drawn = drawn[..., 3] == 255
        assert np.array_equal(drawn[is_drawn], shown[: len(drawn), : drawn.shape[1]][is_drawn])
        # What has half the pixels, drawn twice as large, has pairs of equal rows.
        rows = drawn[is_drawn.any(axis=1)]
        assert (rows[1:] != rows[:-1]).any(axis=(1, 2)).mean() > 0.1
        assert not await page.js("document.getElementById('bar').offsetHeight")
        assert await page.js(TERMINAL_SHARE) == pytest.approx(1, abs=0.002)


NOTES_COLUMNS = """
window.columns = [];
const send = Socket.prototype.send;
Socket.prototype.send = function (said) {
  const [kind, size] = JSON.parse(said);
  if (kind === "resize") columns.push(size.width);
  send.call(this, said);
};
"""


async def test_fingers_drag_the_robot_press_buttons_and_change_the_size_of_the_text(
    serve: Serve, tmp_path: Path
) -> None:
    scale = 2
    async with opened(serve, tmp_path, (390, 844), scale, fingers=True) as page:
        before = robot_at(await until_seen(page, lambda seen: is_whole(seen) and robot_at(seen)[0]))
        x, y = before[0] / scale, before[1] / scale
        await page.finger("touchStart", (x, y))
        for step in range(1, 11):
            await page.finger("touchMove", (x + 15 * step, y + 3 * step))
        await page.finger("touchEnd")
        dragged = robot_at(
            await until_seen(
                page, lambda seen: is_whole(seen) and robot_at(seen)[0] > before[0] + 200
            )
        )
        assert dragged == pytest.approx((before[0] + 300, before[1] + 60), abs=3)
        tapped = "document.querySelector('[data-act=run]').click()"
        await page.js(tapped)
        driven = robot_at(
            await until_seen(
                page, lambda seen: is_whole(seen) and robot_at(seen)[0] > dragged[0] + 20
            )
        )
        assert driven[1] == pytest.approx(dragged[1], abs=3)
        await _change_the_size_of_the_text(page)


async def _change_the_size_of_the_text(page: Chromium) -> None:
    await page.js(NOTES_COLUMNS)
    await page.finger("touchStart", (200, 340), (200, 360))
    for step in range(1, 6):
        await page.finger("touchMove", (200, 340 - 10 * step), (200, 360 + 10 * step))
    await page.finger("touchEnd")
    # Never fewer than the app shows.
    await page.until("columns.at(-1) >= 40 && columns.at(-1) < 45")
    await page.js("document.querySelector('[data-text=\"-1\"]').click()")
    await page.until("columns.at(-1) >= 42")


LAYER = "document.querySelector('.xterm-text-layer')"


async def test_text_is_as_large_as_the_pictures_on_an_emulated_device(
    serve: Serve, tmp_path: Path
) -> None:
    async with opened(serve, tmp_path, (390, 844), 1, fingers=True) as page:
        for scale in (2, 3):
            size = {"width": 390, "height": 844, "deviceScaleFactor": scale, "mobile": True}
            await page.do("Emulation.setDeviceMetricsOverride", **size)
            await page.do("Page.reload")
            await page.until(f"{CANVAS} && {CANVAS}.width > {390 * scale - 20}")
            await until_seen(page, is_whole)
            for side in ("width", "height"):
                ratio = await page.js(f"{LAYER}.{side} / {CANVAS}.{side}")
                assert ratio == pytest.approx(1, abs=0.01), (scale, side)


NOTES_INPUT = """
window.typed = "";
const send = Socket.prototype.send;
Socket.prototype.send = function (said) {
  const [kind, text] = JSON.parse(said);
  if (kind === "stdin") typed += text;
  send.call(this, said);
};
"""


async def test_buttons_of_the_web_page_press_the_keys_that_go_back_and_forth(
    serve: Serve, tmp_path: Path
) -> None:
    async with opened(serve, tmp_path, (390, 844), 1, fingers=True) as page:
        await page.js("document.querySelector('[aria-controls=keys]').click()")
        await until_seen(page, is_whole)
        await page.js(NOTES_INPUT)
        for key in ("second", "tick", "end", "wrong"):
            await page.js(f"document.querySelector('[data-key={key}]').click()")
        # The terminal tells the app of its size, too.
        assert (await page.js("typed")).endswith("<,\x1b[F!")
        await page.js("document.getElementById('ctrl').click()")
        for letter in "pp":
            await page.do("Input.insertText", text=letter)
        await page.until("typed.endsWith('\\x10p')")
        # All buttons are in sight, and large enough for a finger.
        least = "Math.min(...[...document.querySelectorAll('#keys button')].map((button) => button.clientWidth))"
        assert await page.js(least) >= 44
        assert await page.js("document.getElementById('bar').scrollWidth") <= 390


WITHOUT_STORAGE = """
Object.defineProperty(window, "sessionStorage", {
  get() {
    throw new DOMException("Access is denied for this document.", "SecurityError");
  },
});
"""


async def test_the_web_page_works_where_the_browser_forbids_storage(
    serve: Serve, tmp_path: Path
) -> None:
    serving = await serve(DRIVES)
    async with chromium(tmp_path / "browser", 1000, 700, 1, fingers=False) as page:
        await page.do("Page.addScriptToEvaluateOnNewDocument", source=WITHOUT_STORAGE)
        await page.do("Page.navigate", url=serving.address)
        await until_seen(page, is_whole)
        assert (await page.copy_by_key()).startswith("Grey_bands, 0.00 s\n")
        assert page.complaints == []
