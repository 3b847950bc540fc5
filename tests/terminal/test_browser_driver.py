"""The driver for a browser: chosen where a server says so, and safe against broken writes."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from threading import Lock
from types import SimpleNamespace

import pytest
from textual import events
from textual.driver import Driver
from textual.drivers.web_driver import WebDriver
from textual.message import Message

from tests.cases import cases
from tuisim.app.terminal_app import TerminalApp
from tuisim.terminal import kitty
from tuisim.terminal.app import ActionAsked
from tuisim.terminal.browser_driver import BrowserDriver
from tuisim.terminal.driver import TerminalDriver
from tuisim.terminal.probe import WEB_DRIVER
from tuisim.terminal.queries import AnswerParser

CHOSEN = {
    "a server": (WEB_DRIVER, BrowserDriver),
    "a terminal": (None, TerminalDriver),
    "another driver": ("elsewhere:Driver", TerminalDriver),
}


@cases("named, chosen", CHOSEN)
def test_the_apps_driver_is_chosen_for_terminal_or_browser(
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
    made.fileno, made._one_at_a_time, made._server_is_gone = -1, Lock(), False
    return made


def test_the_browser_driver_continues_a_partial_write(
    driver: BrowserDriver, monkeypatch: pytest.MonkeyPatch
) -> None:
    written = b""

    def write(_: int, data: bytes) -> int:
        nonlocal written
        written += data[:3]
        return len(data[:3])

    monkeypatch.setattr(os, "write", write)
    assert (driver._write_all(b"a packet"), written) == (8, b"a packet")


def test_the_browser_driver_drops_output_after_the_server_has_gone(driver: BrowserDriver) -> None:
    assert [driver._write_all(b"a packet"), driver._write_all(b"another")] == [8, 7]


def test_packets_that_two_threads_send_to_the_page_are_not_mixed(driver: BrowserDriver) -> None:
    read, driver.fileno = os.pipe()
    # More than a pipe holds.
    size = 200_000
    with ThreadPoolExecutor(2) as threads, os.fdopen(read, "rb") as reader:
        for letter in (b"a", b"b"):
            threads.submit(driver._write_all, letter * size)
        seen = reader.read(2 * size)
    os.close(driver.fileno)
    assert seen in (b"a" * size + b"b" * size, b"b" * size + b"a" * size)


CODES = {
    "text": ("a [8m\x1b[1mé", "a [8m\x1b[1mé"),
    "a command of kitty": (f"a{kitty.delete(7)}b", "a\x1b]7766;Ga=d,d=I,q=2,i=7\x1b\\b"),
    "placeholders": (
        f"\x1b[38;5;7m{kitty.build_placeholder(0, 1)}{kitty.build_placeholder(1, 1)}a",
        f"\x1b[38;5;7m\x1b[8m{kitty.build_placeholder(0, 1)}{kitty.build_placeholder(1, 1)}\x1b[28ma",
    ),
}


@cases("codes, expected", CODES)
def test_the_browser_driver_passes_terminal_codes_on_to_the_page(
    codes: str, expected: str, driver: BrowserDriver, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[bytes] = []
    monkeypatch.setattr(driver, "_write", written.append, raising=False)
    driver.write(codes)
    assert [packet[5:].decode() for packet in written] == [expected]


def test_a_button_of_the_web_page_sends_its_action_to_the_app(driver: BrowserDriver) -> None:
    asked: list[object] = []
    driver._app = SimpleNamespace(post_message=asked.append)  # type: ignore[assignment]
    driver.on_meta("act", {"type": "act", "name": "run"})
    assert [message.name for message in asked if isinstance(message, ActionAsked)] == ["run"]


def test_the_page_tells_where_the_mouse_is_between_two_cells(
    driver: BrowserDriver, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[Message] = []
    monkeypatch.setattr(WebDriver, "process_message", lambda _, message: seen.append(message))
    for message in AnswerParser().feed("\x1b[48;40;100;800;1000t\x1b[<0;26;51M"):
        driver.process_message(message)
    assert [
        (type(one), one.pointer_x, one.pointer_y)
        for one in seen
        if isinstance(one, events.MouseEvent)
    ] == [(events.MouseDown, 2.5, 2.5)]
    assert not [one for one in seen if isinstance(one, events.Resize)]
