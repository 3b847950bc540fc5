"""A browser that looks on and does not read is sent away, and holds nobody up."""

from __future__ import annotations

import asyncio
from typing import Any, cast

import pytest
from aiohttp import web

from tests.running import PATIENCE_S
from tuisim.web import watchers
from tuisim.web.watchers import Watchers


class Browser:
    """A socket that takes nothing until it is allowed to."""

    def __init__(self, *, reads: bool) -> None:
        self.may_go_on, self.is_closed = asyncio.Event(), asyncio.Event()
        self.got: list[Any] = []
        self.reason = b""
        if reads:
            self.may_go_on.set()

    async def send_str(self, data: object) -> None:
        await self.may_go_on.wait()
        self.got.append(data)

    send_bytes = send_str

    @property
    def closed(self) -> bool:
        return self.is_closed.is_set()

    async def close(self, *, code: int, message: bytes) -> None:
        self.reason = message
        self.is_closed.set()


def as_socket(browser: Browser) -> web.WebSocketResponse:
    return cast("web.WebSocketResponse", browser)


async def test_one_that_does_not_read_is_sent_away_and_others_are_shown_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(watchers, "_MOST_BEHIND_BYTES", 100)
    stalled, reads, every = Browser(reads=False), Browser(reads=True), Watchers()
    with every.one(as_socket(stalled), (80, 24)), every.one(as_socket(reads), (80, 24)):
        for number in range(20):
            every.show(b"%010d" % number)
            while len(reads.got) < number + 2:
                await asyncio.sleep(0)
        every.end("The end.")
        await asyncio.wait_for(reads.is_closed.wait(), PATIENCE_S)
        stalled.may_go_on.set()
        await asyncio.wait_for(stalled.is_closed.wait(), PATIENCE_S)
    assert reads.got == ['["size", [80, 24]]', *(b"%010d" % number for number in range(20))]
    assert reads.reason == b"The end."
    assert b"too slow" in stalled.reason
    assert len(stalled.got) < 10
    assert len(every) == 0
