"""A terminal in memory for an app as it is: it counts what it is sent, and answers."""

from __future__ import annotations

import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any, cast

from rich.console import COLOR_SYSTEMS
from textual import events
from textual.app import App
from textual.drivers.headless_driver import HeadlessDriver
from textual.pilot import Pilot

from tests.running import PATIENCE_S

QUERY = "\x1b[6n"


class Wire(HeadlessDriver):
    """Takes what a terminal is sent."""

    def __init__(self, *words: Any, **more: Any) -> None:
        super().__init__(*words, **more)
        self.sent: list[str] = []

    @property
    def is_headless(self) -> bool:
        return False

    def write(self, data: str) -> None:
        self.sent.append(data)
        if data == QUERY:
            self.send_message(events.CursorPosition(0, 0))

    @property
    def kilobytes(self) -> float:
        return sum(len(data.encode()) for data in self.sent) / 1e3


def wire_of(pilot: Pilot[Any]) -> Wire:
    return cast(Wire, pilot.app._driver)


@asynccontextmanager
async def on_wire(
    app: App[Any], colors: str = "256", *, notifications: bool = False
) -> AsyncIterator[Pilot[Any]]:
    """An app in such a terminal of 120×40, with notices or without."""
    app.driver_class = Wire
    app.console._color_system = COLOR_SYSTEMS[colors]
    async with app.run_test(headless=False, size=(120, 40), notifications=notifications) as pilot:
        yield pilot


async def until_quiet(pilot: Pilot[Any]) -> None:
    """Wait until nothing more is sent."""
    wire = wire_of(pilot)
    before = -1
    give_up = time.monotonic() + PATIENCE_S
    while len(wire.sent) != before:
        assert time.monotonic() < give_up, f"it never stops: {wire.sent[-3:]}"
        before = len(wire.sent)
        await pilot.pause(0.2)
        # On a busy machine what was to be sent meanwhile is due only now.
        await pilot.pause()
