"""The command palette finds an action by what people call it."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from tests.app.app_help import open_lab, until, until_shown
from tests.cases import for_rows
from tuisim.app.actions.keys import ACTIONS
from tuisim.app.analyser.actions.keys import ACTIONS as ANALYSER_ACTIONS
from tuisim.app.dialogs.palette import (
    Entry,
    Palette,
    ThemeChooser,
    find_entries,
)
from tuisim.app.guide.screen import GuideScreen

ENTRIES = [
    Entry(one.id, one.title, one.group, one.key_label, one.words) for one in ACTIONS.values()
]


@for_rows(
    "typed, first",
    [
        ("chart", "panel-chart"),
        ("graph", "panel-chart"),
        ("cell", "cells"),
        ("half", "cells"),
        ("path", "panel-world"),
        ("walls", "panel-obstacles"),
        ("speed", "panel-controls"),
        ("save", "save-program"),
        ("save the program", "save-program"),
        ("quit", "quit"),
        ("grey robot", "earlier"),
        ("ghost", "earlier"),
        ("grey bands", "mats"),
        ("stored runs", "runs"),
        ("runs", "runs"),
        ("charts", "panel-chart"),
        ("chrat", "panel-chart"),
        ("brekpoint", "break"),
        ("how do I export to excel", "export"),
        ("where is the chart?", "panel-chart"),
    ],
)
def test_words_that_people_use_find_an_action(typed: str, first: str) -> None:
    assert find_entries(ENTRIES, typed)[0].id == first


def test_the_last_line_of_the_palette_searches_the_guide_for_what_is_typed() -> None:
    actions = [action for action in ACTIONS.values() if action.id in ("palette", "help", "quit")]
    palette = Palette(actions, None)
    assert [entry.id for entry in palette.find_matches("turn 90 degrees")] == ["?turn 90 degrees"]
    assert [entry.id for entry in palette.find_matches("quit ")] == ["quit", "?quit"]
    assert "?" not in [entry.id[:1] for entry in palette.find_matches("")]


def test_the_palette_finds_nothing_for_an_unknown_word() -> None:
    assert not find_entries(ENTRIES, "xyzz")


def test_the_palette_of_the_analyser_finds_every_action_that_saves_a_picture() -> None:
    entries = [
        Entry(one.id, one.title, one.group, one.key_label, one.words)
        for one in ANALYSER_ACTIONS.values()
    ]
    assert [one.id for one in find_entries(entries, "picture")] == [
        "save-chart",
        "report",
        "screenshot",
    ]


@pytest.mark.slow
async def test_the_palette_keeps_its_place_while_the_list_becomes_shorter() -> None:
    async with open_lab("x = 1\n", size=(80, 24)) as (pilot, _):
        await pilot.press("ctrl+p")
        await until(pilot, lambda: bool(pilot.app.screen.query(".dialog")))
        await pilot.pause()
        frame = pilot.app.screen.query_one(".dialog")
        before = frame.region
        pilot.app.screen.query_one(Input).value = "graph"
        await pilot.pause()
        assert frame.region == before
        pilot.app.screen.query_one(Input).value = "xyzzy"
        await pilot.pause()
        assert frame.region == before
        await until_shown(pilot, "Search the guide for: xyzzy")


@pytest.mark.slow
async def test_words_of_no_command_are_a_question_to_the_guide() -> None:
    async with open_lab("x = 1\n", size=(80, 24)) as (pilot, _):
        await pilot.press("ctrl+p")
        await until(pilot, lambda: bool(pilot.app.screen.query(".dialog")))
        pilot.app.screen.query_one(Input).value = "what turns the robot by ninety degrees"
        await pilot.press("enter")
        await until(
            pilot,
            lambda: isinstance(pilot.app.screen, GuideScreen) and bool(pilot.app.screen.answers),
        )
        await until_shown(pilot, "To turn on the spot")


@pytest.mark.slow
async def test_enter_where_nothing_is_typed_or_found_does_nothing() -> None:
    async with open_lab("x = 1\n", size=(80, 24)) as (pilot, _):
        await pilot.press("f10")
        await until(pilot, lambda: isinstance(pilot.app.screen, ThemeChooser))
        await pilot.press(*"xyzzy", "enter")
        assert isinstance(pilot.app.screen, ThemeChooser)
