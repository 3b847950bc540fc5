"""Panels, help and the end of the app, by keys."""

from __future__ import annotations

import re
from functools import partial

import pytest

from tests.app.app_help import LOGS, lab, notices, open_lab, screen_text, settings, until
from tuisim.app.panels import PANELS, TerminalSize


@pytest.mark.slow
async def test_every_panels_key_shows_and_hides_it() -> None:
    async with open_lab(LOGS, size=(200, 60)) as (pilot, app):

        def has_focus(name: str) -> bool:
            return app.panel_area.find_focused_panel() == name

        for panel in PANELS.values():
            at_first = TerminalSize.LARGE in panel.sizes
            assert app.panel_area.is_shown(panel.id) is at_first, panel.id
            for shown in (not at_first, at_first):
                if app.panel_area.can_take_focus(panel.id):
                    await pilot.press(panel.key)
                    await until(pilot, partial(has_focus, panel.id), panel.id)
                await pilot.press(panel.key)
                assert app.panel_area.is_shown(panel.id) is shown, panel.id
                await pilot.pause()
                assert (
                    bool(re.search(f"[─━] {panel.key} {panel.title}", screen_text(app))) is shown
                ), panel.id


@pytest.mark.slow
@pytest.mark.parametrize(
    ("panel", "key"), [("chart", "c"), ("noise", "z"), ("instrumentation", "i"), ("arrays", "A")]
)
async def test_the_key_of_a_panel_that_is_shown_focuses_it_first(panel: str, key: str) -> None:
    async with open_lab(size=(200, 60)) as (pilot, app):
        assert app.panel_area.is_shown(panel) and app.panel_area.find_focused_panel() == "world"
        await pilot.press(key)
        await until(pilot, lambda: app.panel_area.find_focused_panel() == panel)
        await pilot.press(key)
        await until(pilot, lambda: app.panel_area.find_focused_panel() == "world")
        assert not app.panel_area.is_shown(panel)
        assert notices(app) == [f"{PANELS[panel].title} is hidden: {key} shows it again"]


@pytest.mark.slow
async def test_a_panel_opened_by_key_without_room_replaces_another_panel() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        await pilot.press("X")
        await until(pilot, lambda: app.panel_area.find_focused_panel() == "positioning")
        await pilot.press("H")
        assert all(
            app.panel_area.is_shown(panel)
            for panel in ("instrumentation", "output", "positioning", "controls")
        )
        await pilot.press("c")
        assert app.panel_area.is_shown("chart")
        assert not app.panel_area.is_shown("instrumentation")
        assert "Chart instead of Instrumentation (i), Output (O), Positioning (X)" in notices(app)
        await pilot.press("c")
        assert app.panel_area.is_shown("instrumentation")


@pytest.mark.slow
async def test_a_panel_that_is_switched_off_stays_off_when_the_terminal_grows() -> None:
    off = settings(
        LOGS, panels_off=frozenset({"world"}), panels_on=frozenset({"arrays", "no such panel"})
    )
    async with open_lab(off, size=(80, 24)) as (pilot, app):
        assert app.panel_area.is_shown("arrays")
        await pilot.resize_terminal(200, 60)
        await until(pilot, lambda: app.panel_area.is_shown("chart"))
        assert not app.panel_area.is_shown("world")


async def test_quit_without_a_run_asks_nothing() -> None:
    async with open_lab(size=(80, 24)) as (pilot, _):
        await pilot.press("q")
        assert not lab(pilot).is_running or lab(pilot)._exit


@pytest.mark.slow
async def test_no_dialog_opens_while_the_app_is_ending() -> None:
    async with open_lab(LOGS) as (_, app):
        app.exit()
        # What was typed quickly after q, and what was to be done soon after the start.
        for action in ("open", "runs", "panel-settings", "breaks", "analyse"):
            app.action_act(action)
        app._begin()
        assert len(app.screen_stack) == 1
