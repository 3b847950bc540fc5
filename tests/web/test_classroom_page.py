"""The tutor's pages in a browser: the list, and an app that is looked on at."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.web.chromium import chromium, needs_chromium
from tests.web.test_classroom import Opened, opened
from tests.web.test_server import heard

__all__ = ["opened"]
pytestmark = [pytest.mark.slow, needs_chromium]

KEEPS_TERMINAL = (
    "addEventListener('DOMContentLoaded', () => terminalUsers.push((it) => (window.shown = it)))"
)
TEXT = "shown.buffer.active.getLine(0).translateToString(true)"


async def test_the_tutor_finds_a_student_and_looks_on(opened: Opened, tmp_path: Path) -> None:
    found = await opened()
    socket, _ = await found["Ada"].started()
    await socket.send_json(["stdin", "tell run <b>.py"])
    await heard(socket)
    async with chromium(tmp_path / "browser", 390, 844, 2, fingers=True) as page:
        await page.do("Page.navigate", url=found["tutor"].top)
        await page.until("document.getElementById('sum')?.innerText.includes('1 program running')")
        without = "[...document.querySelectorAll('tr.none th')].map((name) => name.innerText)"
        assert await page.js(without) == ["Bob", "Ümit Çelik"]
        assert "<b>.py" in await page.js("document.querySelector('tr.runs').innerText")
        assert await page.js("document.documentElement.scrollWidth") <= 390
        await page.do("Page.addScriptToEvaluateOnNewDocument", source=KEEPS_TERMINAL)
        await page.js("document.querySelector('tr.runs a').click()")
        await page.until(
            f"window.shown?.cols === 120 && shown.rows === 40 && {TEXT}.includes('show')"
        )
        assert (
            await page.js("document.querySelector('.xterm-screen').getBoundingClientRect().width")
            <= 390
        )
        await page.do("Input.insertText", text="typed")
        await page.js("shown.input('typed')")
        await socket.send_json(["resize", {"width": 60, "height": 20}])
        await page.until("shown.cols === 60 && shown.rows === 20")
        assert page.complaints == []
    await socket.send_json(["stdin", "the end"])
    said = [""]
    while said[-1] != "the end":
        said.append(await heard(socket))
    assert not any("typed" in one for one in said)
