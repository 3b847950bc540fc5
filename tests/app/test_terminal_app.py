"""Terminals that are too small: they say so, and nothing is laid out for them."""

from __future__ import annotations

import asyncio

import pytest
from textual import events
from textual.geometry import Size

from tests.app.app_help import LOGS, open_lab, screen_text, until
from tests.app.monkey import at_once
from tests.app.terminals import Terminal
from tuisim.app.guide.screen import GuideScreen
from tuisim.app.terminal_app import MINIMUM, build_message, is_too_small

SIZES = [
    Size(width, height)
    for width in range(1, MINIMUM.width + 1)
    for height in range(1, MINIMUM.height + 1)
]


def test_the_message_that_the_terminal_is_too_small_fits_every_size() -> None:
    for size in filter(is_too_small, SIZES):
        lines = build_message(size)
        assert len(lines) <= size.height and max(map(len, lines)) <= size.width, size


@pytest.mark.parametrize(
    "size, expected",
    [
        (Size(20, 5), "Too small: tuisim needs 40×12, this terminal has 20×5."),
        (
            Size(39, 40),
            "Too small: tuisim needs 40×12 or more, and this terminal has 39×40. Enlarge it, or press q to quit.",
        ),
        (Size(12, 3), "Too small: needs 40×12"),
        (Size(9, 1), "Too small"),
    ],
    ids=["20x5", "39x40", "12x3", "9x1"],
)
def test_the_message_that_the_terminal_is_too_small_says_as_much_as_fits(
    size: Size, expected: str
) -> None:
    assert " ".join(build_message(size)) == expected


@pytest.mark.quick_cases("20x5")
@pytest.mark.parametrize("size", [(20, 5), (1, 1), (300, 8)], ids=["20x5", "1x1", "300x8"])
async def test_a_terminal_that_shrinks_and_grows_again_shows_what_it_showed(
    size: tuple[int, int],
) -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        await until(pilot, lambda: all(words in screen_text(app) for words in ("White", "Gyro")))
        before = screen_text(app)
        focused = app.focused
        await pilot.resize_terminal(*size)
        await until(pilot, lambda: app.too_small == size)
        assert not is_too_small(app.size)
        await pilot.resize_terminal(80, 24)
        await until(pilot, lambda: screen_text(app) == before)
        assert (app.too_small, app.focused) == (None, focused)


async def test_in_a_terminal_that_is_too_small_clicks_do_nothing() -> None:
    async with open_lab(LOGS, size=(20, 5)) as (pilot, app):
        # The words of the keys are in the last row that is laid out.
        for x in range(20):
            for kind in (events.MouseDown, events.MouseUp):
                app.post_message(
                    kind(None, x, 17, 0, 0, 1, False, False, False, screen_x=x, screen_y=17)
                )
        await pilot.pause()
        assert (len(app.screen_stack), app.run_controller.run) == (1, None)


@pytest.mark.slow
async def test_a_click_on_what_is_not_drawn_yet_does_no_harm() -> None:
    click = events.MouseDown(None, 5, 4, 0, 0, 1, False, False, False, screen_x=5, screen_y=4)
    async with open_lab(size=(20, 5)) as (pilot, app):
        at_once(pilot, ["question_mark"])
        await until(pilot, lambda: isinstance(app.screen, GuideScreen))
        app.post_message(events.Resize(Size(120, 40), Size(120, 40)))
        for _ in range(150):
            await app.on_event(click)
            await asyncio.sleep(0)
        assert not app.too_small


@pytest.mark.tmux
@pytest.mark.slow
def test_a_too_small_terminal_says_so_and_shows_the_app_once_it_grows(terminal: Terminal) -> None:
    terminal.start(["log_greys"], 20, 5)
    shown = terminal.until(lambda text: "Too small" in text)
    assert "this terminal has 20×5." in " ".join(shown.split())
    terminal.resize(80, 24)
    terminal.until(lambda text: "W World" in text and "R run" in text.splitlines()[-1])
    terminal.keys("b")
    terminal.until(lambda text: "─ Mats" in text)
    terminal.resize(39, 12)
    terminal.until(lambda text: "Too small" in text and "Mats" not in text)
    terminal.resize(80, 24)
    terminal.until(lambda text: "─ Mats" in text)
    terminal.keys("Escape")
    terminal.until(lambda text: "─ Mats" not in text)
    terminal.keys("q")
    terminal.until(lambda text: "EXIT 0" in text)
