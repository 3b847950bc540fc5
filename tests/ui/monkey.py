"""Somebody who presses keys, clicks and resizes at random, faster than screens open and close.

What an app has to bear with is in `press_at_random`; how it is left whatever it shows, in `leave`.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from random import Random
from typing import Any

from textual import events
from textual.geometry import Size
from textual.keys import key_to_character
from textual.pilot import Pilot

from tests.running import PATIENCE_S
from tuisim.ui.analyser.screen import Analyser

NAMED = (
    *("enter", "escape", "tab", "shift+tab", "backspace", "delete", "home", "end", "pageup", "pagedown", "insert"),
    *("left", "right", "up", "down", "shift+left", "shift+right", "shift+up", "shift+down", "ctrl+left", "ctrl+right"),
    *("f1", "f3", "shift+f3", "f5", "ctrl+home", "ctrl+end", "ctrl+at", "ctrl+underscore"),
    *(f"ctrl+{letter}" for letter in "abcdefghijklmnoprstuvwxyz"),
)
"""Keys without a character of their own. `ctrl+q` is pressed for itself: it ends the app."""
PRINTED = [chr(code) for code in range(33, 127)] + ["ä", "€", "漢"]
OFTEN = ("enter", "escape", "ctrl+p", "ctrl+s", "tab", "space", "R", "o", "b", "h", "d", "l", "+", "question_mark")
SIZES = [(80, 24), (120, 40), (200, 60), (60, 18), (40, 12), (20, 5), (3, 2), (1, 1), (300, 8), (9, 100)]


def key_event(key: str) -> events.Key:
    """The event that a terminal sends for a key."""
    if key == "space":
        return events.Key("space", " ")
    if len(key) == 1:
        from textual.keys import _character_to_key

        return events.Key(_character_to_key(key), key)
    return events.Key(key, key_to_character(key))


def at_once(pilot: Pilot[Any], keys: Sequence[str]) -> None:
    """Press keys without waiting for what they do."""
    driver = pilot.app._driver
    assert driver is not None
    for key in keys:
        driver.process_message(key_event(key))


def _mouse(kind: type[events.MouseEvent], x: int, y: int, button: int) -> events.MouseEvent:
    return kind(
        widget=None, x=x, y=y, delta_x=0, delta_y=0, button=button, shift=False, meta=False, ctrl=False,
        screen_x=x, screen_y=y, style=None,
    )  # fmt: skip


def _point(pilot: Pilot[Any], rng: Random) -> str:
    """Click, drag or scroll somewhere."""
    driver = pilot.app._driver
    assert driver is not None
    width, height = pilot.app.size
    x, y = rng.randrange(max(width, 1)), rng.randrange(max(height, 1))
    way = rng.choice(("click", "click", "double", "drag", "scroll", "half"))
    button = rng.choice((1, 1, 1, 3))
    told = [way, x, y, button]
    if way == "scroll":
        driver.process_message(_mouse(rng.choice((events.MouseScrollUp, events.MouseScrollDown)), x, y, 0))
    else:
        driver.process_message(_mouse(events.MouseMove, x, y, 0))
        for _ in range(2 if way == "double" else 1):
            driver.process_message(_mouse(events.MouseDown, x, y, button))
            if way == "drag":
                x, y = rng.randrange(max(width, 1)), rng.randrange(max(height, 1))
                driver.process_message(_mouse(events.MouseMove, x, y, button))
                told += [x, y]
            if way != "half":
                driver.process_message(_mouse(events.MouseUp, x, y, button))
    return f"mouse {told}"


def _one(pilot: Pilot[Any], rng: Random) -> str:
    """Do one thing; return what was done."""
    what = rng.random()
    if what < 0.06:
        return _point(pilot, rng)
    if what < 0.09:
        size = Size(*rng.choice(SIZES))
        driver = pilot.app._driver
        assert driver is not None
        driver._size = size
        pilot.app.post_message(events.Resize(size, size))
        return f"resize {size}"
    if what < 0.10:
        text = rng.choice(("12", "a\nb\tc\n", "x" * 300, "/tmp", "Colour", "\x00\x1b[31m"))
        pilot.app.post_message(events.Paste(text))
        return f"paste {text!r}"
    if what < 0.102:
        keys = [rng.choice(("q", "ctrl+q"))]
    elif what < 0.3:
        keys = [rng.choice(OFTEN)] * rng.choice((1, 1, 2, 3))
    elif what < 0.5:
        keys = [rng.choice(NAMED)] * rng.choice((1, 1, 1, 2))
    else:
        keys = [key for key in rng.choices(PRINTED, k=rng.choice((1, 1, 1, 4))) if key != "q"]
    if "escape" in keys and isinstance(pilot.app.screen, Analyser) and rng.random() < 0.95:
        # It would leave the analyser before much has happened.
        keys = ["enter"]
    at_once(pilot, keys)
    return " ".join(keys)


def is_over(pilot: Pilot[Any]) -> bool:
    """Whether the app has ended, or has been told to."""
    return pilot.app._exit or not pilot.app.is_running


async def press_at_random(pilot: Pilot[Any], rng: Random, count: int, done: list[str]) -> None:
    """Do so many things, or fewer if one of them ends the app; `done` gets what was done."""
    for _ in range(count):
        if is_over(pilot):
            return
        done.append(_one(pilot, rng))
        wait = rng.random()
        if wait < 0.3:
            await asyncio.sleep(0)
        elif wait < 0.95:
            await pilot.pause()
        else:
            await pilot.pause(0.05)


async def leave(pilot: Pilot[Any]) -> None:
    """End the app as the help says: escape until all is closed, then `q`, and an answer to what it asks."""
    for key in ("escape", "escape", "escape", "escape", "q"):
        if not is_over(pilot):
            await pilot.press(key)
    give_up = time.monotonic() + PATIENCE_S
    while not is_over(pilot):
        assert time.monotonic() < give_up, f"it cannot be left: {pilot.app.screen_stack}"
        from tuisim.ui.screens.leave import LeaveQuestion
        from tuisim.ui.screens.question import Question

        if isinstance(pilot.app.screen, LeaveQuestion):
            await pilot.press("y")
        elif isinstance(pilot.app.screen, Question):
            await pilot.press("d")
        await pilot.pause(0.01)
