"""Buttons of the page that shows the app."""

from __future__ import annotations

import pytest

from tests.app.app_help import ENDLESS, LOGS, notices, open_lab, until
from tuisim.app.analyser.app import Analyser
from tuisim.app.dialogs.chooser import Chooser
from tuisim.app.snapshot import IN_RUN
from tuisim.terminal.app import ActionAsked


@pytest.mark.slow
async def test_a_button_of_the_web_page_works_while_the_user_types_in_the_editor() -> None:
    async with open_lab(ENDLESS) as (pilot, app):
        await pilot.press("d")
        await until(pilot, lambda: app.is_typed_into)
        app.post_message(ActionAsked("run"))
        await until(pilot, lambda: app.run_controller.state in IN_RUN)
        app.post_message(ActionAsked("stop"))
        await until(pilot, lambda: app.run_controller.state not in IN_RUN)


@pytest.mark.slow
async def test_a_button_of_the_web_page_does_nothing_while_a_dialog_is_open() -> None:
    async with open_lab(ENDLESS) as (pilot, app):
        await pilot.press("b")
        await until(pilot, lambda: len(app.screen_stack) == 2)
        app.post_message(ActionAsked("run"))
        await until(pilot, lambda: "A dialog is open: escape closes it" in notices(app))
        assert app.run_controller.state not in IN_RUN


async def test_an_unknown_action_from_the_web_page_is_ignored() -> None:
    async with open_lab(ENDLESS) as (pilot, app):
        app.post_message(ActionAsked("__init__"))
        app.post_message(ActionAsked("panel-chart"))
        await until(pilot, lambda: app.panel_area.is_shown("chart"))


@pytest.mark.slow
async def test_a_click_on_the_empty_panel_of_lessons_offers_them() -> None:
    async with open_lab(ENDLESS, panels_on=frozenset({"lesson"})) as (pilot, app):
        await until(pilot, lambda: app.panel_area.is_shown("lesson"))
        await pilot.click(app.panel_area.lesson, offset=(5, 5))
        await until(pilot, lambda: isinstance(app.screen, Chooser))


@pytest.mark.slow
async def test_a_button_of_the_web_page_says_so_when_it_does_not_work_in_the_analyser() -> None:
    async with open_lab(LOGS) as (pilot, app):
        app.post_message(ActionAsked("run"))
        await until(
            pilot, lambda: app.find_situation().has_run and app.run_controller.state not in IN_RUN
        )
        app.post_message(ActionAsked("analyse"))
        await until(pilot, lambda: isinstance(app.screen, Analyser))
        app.post_message(ActionAsked("run"))
        await until(
            pilot, lambda: "That works only in the lab: leave this screen first" in notices(app)
        )
