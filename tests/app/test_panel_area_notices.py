"""Notices cover neither the mat nor the readings, nor the keys."""

from __future__ import annotations

from functools import partial
from typing import Any, cast

import pytest
from textual.geometry import Region
from textual.pilot import Pilot
from textual.widget import Widget

from tests.app.app_help import LOGS, ready, settings, until, until_state
from tuisim.app.app import LabApp
from tuisim.app.dialogs.dialog import Dialog
from tuisim.app.guide.screen import GuideScreen
from tuisim.app.notices import NoticeRow
from tuisim.app.snapshot import RunPhase


async def shown_row(pilot: Pilot[Any], app: LabApp, message: str) -> NoticeRow:
    """Return the row of a notice once it is drawn."""
    rows: list[NoticeRow] = []

    def is_drawn() -> bool:
        rows[:] = [row for row in app.screen.query(NoticeRow) if row.region]
        return [row.notice.message for row in rows] == [message]

    await until(pilot, is_drawn)
    return rows[0]


def leaves_text_free(app: LabApp, row: Region) -> bool:
    """Return whether a row covers no text of the panels on the screen."""
    panels = app.panel_area.on_screen()
    insides = (cast(Widget, panel).region.shrink((1, 1, 1, 1)) for panel in panels)
    return not any(map(row.overlaps, insides))


SHORT = "Nothing is running"
LONG = "words of an error that names a file and a key, and says what is allowed and what is not allowed in that place"


@pytest.mark.quick_cases("(65, 58)", "(80, 24)", "(100, 30)")
@pytest.mark.parametrize("size", [(65, 58), (80, 24), (100, 30), (120, 40)], ids=str)
async def test_a_notice_lies_on_borders_and_leaves_axis_and_keys_free(
    size: tuple[int, int],
) -> None:
    async with LabApp(settings(LOGS)).run_test(size=size, notifications=True) as pilot:
        app = await ready(pilot)
        app.panel_area.bring("chart")
        await until(pilot, lambda: bool(app.panel_area.panels["chart"].region))
        for message in (LONG, SHORT):
            app.say(message)
            row = (await shown_row(pilot, app, message)).region
            rows = 2 if len(message) > size[0] else 1
            assert (row.x, row.width, row.height) == (0, size[0], rows)
            assert not row.overlaps(app.key_footer.region)
            await until(pilot, partial(leaves_text_free, app, row))


@pytest.mark.slow
@pytest.mark.parametrize("key", ["g", "question_mark", "o"])
async def test_a_notice_covers_no_text_of_a_dialog(key: str) -> None:
    opened = settings(LOGS, autorun=True, speed=0.0)
    async with LabApp(opened).run_test(size=(80, 24), notifications=True) as pilot:
        app = await ready(pilot)
        await until_state(pilot, RunPhase.ENDED)
        await pilot.press(key)
        await until(pilot, lambda: isinstance(app.screen, Dialog))
        app.say(SHORT)
        row = await shown_row(pilot, app, SHORT)
        frame = app.screen.query_one(".dialog").region
        await until(pilot, lambda: not row.region.overlaps(frame.shrink((1, 1, 1, 1))))
        assert app.screen.region.contains_region(row.region)


async def test_a_notice_outlives_the_screen_that_it_is_on() -> None:
    async with LabApp(settings(LOGS)).run_test(size=(80, 24), notifications=True) as pilot:
        app = await ready(pilot)
        await pilot.press("question_mark")
        await until(pilot, lambda: isinstance(app.screen, GuideScreen))
        app.say("said in the guide")
        await shown_row(pilot, app, "said in the guide")
        await pilot.press("escape")
        await until(pilot, lambda: not isinstance(app.screen, GuideScreen))
        await shown_row(pilot, app, "said in the guide")
