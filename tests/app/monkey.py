"""Somebody who presses keys, clicks and resizes at random, faster than screens open and close.

What an app has to bear with is in `press_at_random`; how it is left whatever it shows, in `leave`.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Sequence
from random import Random
from typing import Any

from textual import events
from textual.geometry import Size
from textual.keys import _character_to_key, key_to_character
from textual.pilot import Pilot

from tests.running import PATIENCE_S
from tuisim.app.analyser.app import Analyser
from tuisim.app.dialogs.question import LeaveQuestion, Question

NAMED = (
    *(
        "enter",
        "escape",
        "tab",
        "shift+tab",
        "backspace",
        "delete",
        "home",
        "end",
        "pageup",
        "pagedown",
        "insert",
    ),
    *(
        "left",
        "right",
        "up",
        "down",
        "shift+left",
        "shift+right",
        "shift+up",
        "shift+down",
        "ctrl+left",
        "ctrl+right",
    ),
    *("f1", "f3", "shift+f3", "f5", "ctrl+home", "ctrl+end", "ctrl+at", "ctrl+underscore"),
    *(f"ctrl+{letter}" for letter in "abcdefghijklmnoprstuvwxyz"),
)
"""Keys without a character of their own; `ctrl+q` is pressed less often."""
PRINTED = [chr(code) for code in range(33, 127) if chr(code) != "q"] + ["ä", "€", "漢"]
"""Without `q`, which is pressed less often: it ends the app."""
OFTEN = (
    "enter",
    "escape",
    "ctrl+p",
    "ctrl+s",
    "tab",
    "space",
    "R",
    "o",
    "b",
    "h",
    "d",
    "l",
    "+",
    "question_mark",
)
SIZES = [
    (80, 24),
    (120, 40),
    (200, 60),
    (60, 18),
    (40, 12),
    (20, 5),
    (3, 2),
    (1, 1),
    (300, 8),
    (9, 100),
]


def key_event(key: str) -> events.Key:
    """The event that a terminal sends for a key."""
    if key == "space":
        return events.Key("space", " ")
    if len(key) == 1:
        return events.Key(_character_to_key(key), key)
    return events.Key(key, key_to_character(key))


def at_once(pilot: Pilot[Any], keys: Sequence[str]) -> None:
    """Press keys without waiting for what they do."""
    driver = pilot.app._driver
    assert driver is not None
    for key in keys:
        driver.process_message(key_event(key))


def _mouse(pilot: Pilot[Any], kind: type[events.MouseEvent], x: int, y: int, button: int) -> str:
    driver = pilot.app._driver
    assert driver is not None
    driver.process_message(
        kind(None, x, y, 0, 0, button, False, False, False, screen_x=x, screen_y=y)
    )
    return f"{kind.__name__} {x} {y} {button}"


def _point(pilot: Pilot[Any], rng: Random) -> list[str]:
    """Click, drag or scroll somewhere, or press without ever letting go."""
    width, height = pilot.app.size
    x, y = rng.randrange(width), rng.randrange(height)
    done = [_mouse(pilot, events.MouseMove, x, y, 0)]
    way = rng.choice(("click", "click", "twice", "drag", "scroll", "half"))
    if way == "scroll":
        return [
            *done,
            _mouse(pilot, rng.choice((events.MouseScrollUp, events.MouseScrollDown)), x, y, 0),
        ]
    button = rng.choice((1, 1, 1, 3))
    for _ in range(2 if way == "twice" else 1):
        done.append(_mouse(pilot, events.MouseDown, x, y, button))
        if way == "drag":
            x, y = rng.randrange(width), rng.randrange(height)
            done.append(_mouse(pilot, events.MouseMove, x, y, button))
        if way != "half":
            done.append(_mouse(pilot, events.MouseUp, x, y, button))
    return done


def _resize(pilot: Pilot[Any], rng: Random) -> list[str]:
    size = Size(*rng.choice(SIZES))
    pilot.app.post_message(events.Resize(size, size))
    return [f"resize {size.width} {size.height}"]


def _paste(pilot: Pilot[Any], rng: Random) -> list[str]:
    text = rng.choice(("12", "a\nb\tc\n", "x" * 300, "/tmp", "Colour", "\x00\x1b[31m"))
    pilot.app.post_message(events.Paste(text))
    return [f"paste {text!r}"]


def _type(pilot: Pilot[Any], rng: Random) -> list[str]:
    kind = rng.choices(("quit", "often", "named", "printed"), (0.2, 20, 20, 50))[0]
    if kind == "quit":
        keys = [rng.choice(("q", "ctrl+q"))]
    elif kind == "often":
        keys = [rng.choice(OFTEN)] * rng.choice((1, 1, 2, 3))
    elif kind == "named":
        keys = [rng.choice(NAMED)] * rng.choice((1, 1, 1, 2))
    else:
        keys = rng.choices(PRINTED, k=rng.choice((1, 1, 1, 4)))
    if "escape" in keys and isinstance(pilot.app.screen, Analyser) and rng.random() < 0.95:
        # It would leave the analyser before much has happened.
        keys = ["enter"]
    at_once(pilot, keys)
    return keys


def is_over(pilot: Pilot[Any]) -> bool:
    """Whether the app has ended, or has been told to."""
    return pilot.app._exit or not pilot.app.is_running


async def press_at_random(pilot: Pilot[Any], rng: Random, count: int) -> AsyncIterator[str]:
    """Press so many keys and buttons, or fewer if one of them ends the app; yield each."""
    while count > 0 and not is_over(pilot):
        act = rng.choices((_type, _point, _resize, _paste), (90, 5, 3, 1))[0]
        for what in act(pilot, rng):
            count -= 1
            yield what
        wait = rng.random()
        if wait < 0.5:
            await asyncio.sleep(0)
        elif wait < 0.8:
            await asyncio.sleep(0.02)
        else:
            await pilot.pause()


async def leave(pilot: Pilot[Any]) -> None:
    """End the app as anybody can, whatever it shows: escape until nothing closes any more, `q`, and what that asks."""
    opened = len(pilot.app.screen_stack)
    # One for each dialog and what may still come up, one for a field, one for a text that is typed into.
    for key in (*["escape"] * (opened + 3), "q"):
        if not is_over(pilot):
            await pilot.press(key)
    give_up = time.monotonic() + PATIENCE_S
    while not is_over(pilot):
        assert time.monotonic() < give_up, f"it cannot be left: {pilot.app.screen_stack}"
        if isinstance(pilot.app.screen, LeaveQuestion):
            await pilot.press("y")
        elif isinstance(pilot.app.screen, Question):
            await pilot.press("d")
        await pilot.pause(0.01)
