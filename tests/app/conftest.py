"""What the tests of the app share: terminals, and notices that stay."""

from __future__ import annotations

import asyncio
import os
import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from textual import app as textual_app
from textual import pilot as textual_pilot
from textual._compositor import Compositor
from textual._context import active_app
from textual._wait import wait_for_idle as seem_idle
from textual._xterm_parser import XTermParser
from textual.css.stylesheet import Stylesheet
from textual.notifications import Notification
from textual.pilot import Pilot

from tests.app.terminals import Terminal
from tests.running import PATIENCE_S
from tuisim.app import background
from tuisim.settings import user_config


@pytest.fixture(scope="session", autouse=True)
def _keys_are_heard_before_a_test_goes_on() -> Iterator[None]:
    """Let `press` and `pause` wait until every message has been handled, also those that others have sent.

    Textual takes a process that uses little of its processor for one that has nothing left to do. On a busy machine it
    may only be waiting for its turn.
    """

    async def wait_for_idle(min_sleep: float = 0.0, max_sleep: float = 1.0) -> None:
        await seem_idle(min_sleep, max_sleep)
        await _settle()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(textual_app, "wait_for_idle", wait_for_idle)
        patch.setattr(textual_pilot, "wait_for_idle", wait_for_idle)
        yield


@pytest.fixture(autouse=True)
def _apps_are_drawn_only_where_it_matters(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Draw an app in memory where a test looks at its screen, and in slow tests also after each key and wait.

    To draw each change, which nobody sees, takes half of what most of the tests of the app cost.
    """
    draw = Compositor.render_update
    wait = Pilot._wait_for_screen
    is_slow = request.node.get_closest_marker("slow") is not None

    def render_update(compositor: Compositor, *words: Any, **options: Any) -> Any:
        # What has changed stays marked until it is drawn.
        return None if active_app.get().is_headless else draw(compositor, *words, **options)

    async def wait_for_screen(pilot: Pilot[Any], timeout: float = 30.0) -> bool:
        has_settled = await wait(pilot, timeout)
        if is_slow and pilot.app.is_headless and pilot.app.screen_stack:
            draw(pilot.app.screen._compositor, screen_stack=pilot.app._background_screens)
        return has_settled

    monkeypatch.setattr(Compositor, "render_update", render_update)
    monkeypatch.setattr(Pilot, "_wait_for_screen", wait_for_screen)


@pytest.fixture(scope="session", autouse=True)
def _styles_are_parsed_once() -> Iterator[None]:
    """Keep the rules that Textual has parsed for the apps that follow: all have the same ones."""
    parse = Stylesheet._parse_rules
    known: dict[object, Any] = {}

    def parse_rules(sheet: Stylesheet, *words: Any, **options: Any) -> Any:
        key = words, tuple(options.items()), tuple(sheet._variables.items())
        if key not in known:
            known[key] = parse(sheet, *words, **options)
        return known[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Stylesheet, "_parse_rules", parse_rules)
        yield


async def _settle() -> None:
    """Wait until nothing is ready to run in the event loop but this."""
    loop: Any = asyncio.get_running_loop()
    give_up = time.monotonic() + PATIENCE_S
    # What is ready stands in no order that this could rely on, so that it takes its turn until it is alone.
    while True:
        await asyncio.sleep(0)
        if not loop._ready:
            return
        assert time.monotonic() < give_up, "the event loop is never idle"


@pytest.fixture(autouse=True)
def _notices_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep notices until the app removes them, so that a test on a busy machine still finds them."""
    monkeypatch.setattr(Notification, "has_expired", False)
    monkeypatch.setattr(Notification, "time_left", 3600.0)


@pytest.fixture(autouse=True)
def _apps_are_released() -> Iterator[None]:
    """Forget the keys that Textual has parsed: each knows the app that it was sent to, with its mat and its run."""
    yield
    # Before 8.2.7 Textual keeps none.
    if (parse := getattr(XTermParser, "_parse_extended_key", None)) is not None:
        parse.cache_clear()


@pytest.fixture(autouse=True)
def home(
    tmp_path_factory: pytest.TempPathFactory, shared_home: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Path]:
    """A home with nothing but the mats of all: what an earlier test has run, chosen or not saved changes an app."""
    folder = tmp_path_factory.mktemp("home")
    (folder / "cache").symlink_to(shared_home / "cache")
    monkeypatch.setenv("TUISIM_HOME", str(folder))
    yield folder
    # They would go on in the next test: Jedi changes the limit of recursion for a time, hypothesis minds.
    for thread in background._threads:
        thread.join(PATIENCE_S)
    shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture(autouse=True)
def _own_settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Read `config.toml` where a test writes it."""
    monkeypatch.setattr(user_config, "config_folder", lambda: tmp_path)


@pytest.fixture
def open_terminal(tmp_path: Path) -> Iterator[Callable[[], Terminal]]:
    """`open_terminal()`: another terminal, closed at the end of the test."""
    opened: list[Terminal] = []

    def another() -> Terminal:
        opened.append(
            Terminal(f"tuisim-{os.getpid()}-{tmp_path.name[-20:]}-{len(opened)}", tmp_path)
        )
        return opened[-1]

    yield another
    for terminal in opened:
        terminal.end()


@pytest.fixture
def terminal(open_terminal: Callable[[], Terminal]) -> Terminal:
    """The one terminal of a test."""
    return open_terminal()
