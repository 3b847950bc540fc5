"""The driver for a browser: chosen where a server says so, and safe against broken writes."""

from __future__ import annotations

import os

import pytest
from textual.driver import Driver

from tuisim.app.terminal.browser import WEB_DRIVER
from tuisim.app.terminal.browser_driver import BrowserDriver
from tuisim.app.terminal.terminal_app import TerminalApp, TerminalDriver

CHOSEN = {
    "a server": (WEB_DRIVER, BrowserDriver),
    "a terminal": (None, TerminalDriver),
    "another driver": ("elsewhere:Driver", TerminalDriver),
}


@pytest.mark.parametrize(("named", "chosen"), CHOSEN.values(), ids=CHOSEN)
def test_the_driver_suits_what_shows_the_app(
    named: str | None, chosen: type[Driver], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("TEXTUAL_DRIVER", raising=False)
    if named:
        monkeypatch.setenv("TEXTUAL_DRIVER", named)
    assert TerminalApp().driver_class is chosen


@pytest.fixture
def driver() -> BrowserDriver:
    """A driver that has not started."""
    made = BrowserDriver.__new__(BrowserDriver)
    made.fileno, made._server_is_gone = -1, False
    return made


def test_an_interrupted_write_is_continued(driver: BrowserDriver, monkeypatch: pytest.MonkeyPatch) -> None:
    written = b""

    def write(_: int, data: bytes) -> int:
        nonlocal written
        written += data[:3]
        return len(data[:3])

    monkeypatch.setattr(os, "write", write)
    assert (driver._write_all(b"a packet"), written) == (8, b"a packet")


def test_what_is_written_after_the_server_has_gone_is_dropped(driver: BrowserDriver) -> None:
    assert [driver._write_all(b"a packet"), driver._write_all(b"another")] == [8, 7]
